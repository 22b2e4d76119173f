#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/cloud.hpp"
#include "slam/core/kd_tree.hpp"
#include "slam/core/pose.hpp"

namespace planum {

struct MatchingScanParams {
  double voxel = 0.05;          ///< m, edge of the voxels that keep one point each; 0: keep all
  double coarse_voxel = 0.25;   ///< m, the same for the first, coarse steps of a match
  std::size_t neighbours = 12;  ///< points of a local plane
  std::size_t most_neighbours = 48;  ///< so many where fewer show no plane (a lone scan line)
};

/// The surface around a point: a plane fitted to its neighbours.
struct LocalPlane {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();    ///< m, on the plane
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit, towards the scanner; zero: no plane
  float thickness = 0;      ///< m, rms distance of the neighbours from the plane
  float reach = 0;          ///< m, radius of the patch that the neighbours cover
  float tilt_variance = 0;  ///< rad^2, of the normal about one axis, from thickness and reach

  bool known() const { return !normal.isZero(); }
};

/// A scan made ready for matching: few points, their surfaces, a search tree.
struct MatchingScan {
  std::vector<Eigen::Vector3f> points;  ///< m, scanner frame; real points of the scan,
                                        ///< ordered so that neighbours are near in memory
  std::vector<LocalPlane> planes;       ///< as long as points
  std::vector<std::uint32_t> shuffled;  ///< all positions; any first ones are an even choice
  std::vector<std::uint32_t> coarse;    ///< of them the positions of one point a coarse voxel
  KdTree tree;                          ///< of points
  double noise = 0;                     ///< m, median thickness of the local planes
  double spacing = 0;                   ///< m, median distance to the nearest other point
  double radius = 0;                    ///< m, rms distance of the points from the scanner
  double patch_points = 1;              ///< points that share a local plane, and so its noise

  /// A point put onto its plane, where that is known: most of its noise is gone, and what the
  /// choice of one point a voxel prefers.
  Eigen::Vector3f smoothed(std::size_t i) const {
    const LocalPlane& plane = planes[i];
    return points[i] - plane.normal.dot(points[i] - plane.mean) * plane.normal;
  }

  /// Positions of at most `most` points, ascending, chosen by where they are: nearly the same scan,
  /// with some points more, fewer or moved a little, gives nearly the same choice. 0: all.
  std::vector<std::uint32_t> selection(std::size_t most) const;

  /// The same of the coarse ones.
  std::vector<std::uint32_t> coarse_selection(std::size_t most) const;
};

/// Reduces a scan (scanner frame, scanner at the origin) and fits planes to the neighbourhoods.
/// Throws Error if a parameter is out of range or a point is not finite. An empty scan is fine.
MatchingScan matching_scan(const Cloud& cloud, const MatchingScanParams& params = {});

/// A scan and where it lies in a common frame.
struct PlacedScan {
  const MatchingScan* scan = nullptr;
  Pose frame_from_scan = Pose::Identity();
};

/// All points of some scans with their surfaces, in the common frame; noise, spacing and points of
/// a plane are the medians of theirs.
MatchingScan merged(std::span<const PlacedScan> scans);

}  // namespace planum
