#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "slam/core/pose.hpp"
#include "slam/registration/matching_scan.hpp"

namespace planum {

/// A scan seen from above: where its walls are and which way they face, and where it is free.
struct ScanPlan {
  static constexpr double cell = 0.2;    ///< m, edge of the cells
  static constexpr int half_width = 80;  ///< cells from the scanner to each side
  static constexpr int width = 2 * half_width + 1;
  static constexpr int facings = 8;      ///< of walls, each an eighth of a turn
  static constexpr int azimuths = 180;   ///< bins of the directions that walls face
  static constexpr int levels = 240;     ///< bins of heights, 5 cm each, the scanner in the middle
  static constexpr double level = 0.05;  ///< m

  /// A column of points that face the same way.
  struct Wall {
    Eigen::Vector2f position;   ///< m, levelled frame
    float azimuth = 0;          ///< rad, of its normal
    std::int16_t weight = 1;    ///< grows with its height
    bool at_eye_level = false;  ///< some of it as high as the scanner
  };

  Eigen::Matrix3d level_from_scan = Eigen::Matrix3d::Identity();
  std::vector<Wall> walls;
  std::array<float, azimuths> facing_shares = {};              ///< of the walls' weights, smoothed
  std::array<std::array<float, levels>, 2> level_shares = {};  ///< surfaces that face up; down
  std::array<std::vector<std::int8_t>, facings> near_wall;     ///< rows of cells, see scan_plan.cpp
  std::vector<std::int8_t> free;  ///< negative where rays at eye level passed
};

/// The turn that makes floors and ceilings level, if the scanner's z is upward within 20 degrees;
/// none where too little is level.
Eigen::Matrix3d level_from_scan(const MatchingScan& scan);

/// Level as far as floor and ceiling say, if the scanner's z is upward within 20 degrees.
ScanPlan scan_plan(const MatchingScan& scan);

/// A place where the walls of one plan lie on those of another.
struct PlanMatch {
  Pose target_from_source = Pose::Identity();  ///< of the scans
  double score = 0;  ///< share of the source's walls on the target's, less those in its free space
};

struct PlanMatchParams {
  double max_distance = 10;   ///< m, between the two scanners, along each axis
  double least_facing = 0.5;  ///< directions are tried that suit facings so well, of the best
  std::size_t max_directions = 24;
  std::size_t max_walls = 400;   ///< of the source
  std::size_t max_matches = 24;  ///< best first
};

/// Looks at all shifts (to a cell) in the directions in which walls face alike (correlative
/// matching: Olson, ICRA 2009); local maxima only. The height is the one that suits floor and
/// ceiling best. Throws Error if a parameter is out of range.
std::vector<PlanMatch> matches_of_plans(const ScanPlan& source, const ScanPlan& target,
                                        const PlanMatchParams& params = {});

}  // namespace planum
