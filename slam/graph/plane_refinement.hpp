#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/core/progress.hpp"
#include "slam/registration/matching_scan.hpp"

namespace planum {

struct PlaneRefinementParams {
  double spacing = 0.1;            ///< m, surfaces are looked at so densely
  double patch_radius = 0.75;      ///< m; larger pieces of walls and floors are not flat
  double gate = 0;                 ///< m, surfels farther off a plane are not of it; 0: three times
                                   ///< the median noise of the scans
  double max_angle = radians(15);  ///< rad, between the normals of a plane and of its surfels
  /// rad; directions that the planes determine no better than planes tilted by so much would are
  /// left to the poses that came, each scan relative to those that it shares planes with.
  double weak_angle = radians(2);
  int max_rounds = 6;       ///< of finding planes
  int max_iterations = 10;  ///< of a round
  double tolerance = 0.02;  ///< done when no scan's points move more than this much of the noise
};

struct PlaneRefinement {
  std::vector<Pose> poses;       ///< world_from_scan; those that came if `improved` is false
  bool improved = false;         ///< planes are thinner than before, beyond chance
  std::string reason{};          ///< why not
  double thickness_before = 0;   ///< m, mean distance of held-out surfels from the planes of others
  double thickness_after = 0;    ///< m, the same with the poses that were found, taken or not
  std::size_t planes = 0;        ///< that at least two scans share, at last
  std::size_t observations = 0;  ///< of a plane by a scan
  int iterations = 0;
  bool converged = false;
  double moved_rms = 0;   ///< m, how far the scans' points went, relative to the first scans
  double moved_most = 0;  ///< m, rms over the points of the scan that moved most
};

/// Sharpens walls: moves all scans at once so that the plane patches which they share become as
/// thin as they can (plane adjustment: Liu & Zhang, BALM, RA-L 2021; Zhou et al., RA-L 2021). Poses
/// must be good to about the gate. Directions that planes leave open stay as they are, and so do
/// the first of whatever shares planes. Scans of different parts (`part_of_scan`; empty: all are
/// one) share no planes. If points that took no part do not find planes thinner than before, beyond
/// chance, the poses that came are returned. Throws Error if poses and scans do not go together, or
/// a parameter is out of range.
PlaneRefinement refine_planes(std::span<const Pose> world_from_scan,
                              std::span<const MatchingScan> scans,
                              std::span<const std::size_t> part_of_scan = {},
                              const PlaneRefinementParams& params = {},
                              const Progress& progress = {});

}  // namespace planum
