#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "slam/core/pose.hpp"

namespace planum {

/// Points with attributes; each attribute is empty or as long as `points`.
struct Cloud {
  std::vector<Eigen::Vector3f> points;   ///< m
  std::vector<Eigen::Vector3f> normals;  ///< unit, towards the scanner; zero where unknown
  std::vector<float> intensity;          ///< as the sensor gives it
  std::vector<std::uint32_t>
      scan;  ///< which scan a merged point came from (its position in the list of scans)
};

/// One 3D scan and where it was taken.
struct Scan {
  std::string id;  ///< as in the file name, e.g. "scan007"
  int number = 0;  ///< e.g. 7; the first column of trajectory files
  Pose world_from_scan = Pose::Identity();
  Cloud cloud;  ///< in the scanner's frame
};

/// The points and normals of a cloud in another frame.
Cloud transformed(const Cloud& cloud, const Pose& b_from_a);

/// All scans in the world frame as one cloud; `scan` says which point came from where.
/// Attributes that not every non-empty scan has are dropped.
Cloud merged(const std::vector<Scan>& scans);

}  // namespace planum
