#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/core/progress.hpp"
#include "slam/graph/pose_graph.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/registration/pairing.hpp"

namespace planum {

struct LuMiliosParams {
  Pairing pairing = Pairing::point_to_plane;
  double max_distance = 15;        ///< m, scans taken farther apart are not linked
  double min_overlap = 0.15;       ///< estimated share of common points that makes a link
  std::size_t links_per_scan = 8;  ///< each scan brings its best links, at most so many
  double first_gate = 0;  ///< m, how far apart the points of a pair may be; 0, or no last gate
                          ///< given: three last gates
  double last_gate = 0;   ///< m, the same at last; 0: ten times the noise of two scans
  double max_normal_angle = radians(45);  ///< rad, pairs whose surfaces face more apart are dropped
  std::size_t max_points = 2000;          ///< of each scan in each link, evenly chosen; 0: all
  std::size_t last_points = 20000;  ///< at last, when the poses hardly move any more, so many are
                                    ///< shared by the links of a scan; 0: all in each
  std::size_t min_pairs = 50;       ///< of a link; fewer say nothing
  int max_iterations = 30;          ///< at each gate
  double tolerance = 0.02;          ///< done when no pose moves more than this much of the noise
};

struct GraphResult {
  PoseGraph graph;             ///< with the new poses and the edges as they came
  std::vector<Edge> links{};   ///< every link of the last iteration, measured at the new poses
  double residual_before = 0;  ///< m, rms over the pairs of all links with the poses that came
  double residual_after = 0;   ///< m, the same with the new poses
  int iterations = 0;
  bool converged = false;
};

/// Moves all scans at once so that all that overlap fit best: 6D relaxation after Lu & Milios
/// (Autonomous Robots 1997; Borrmann et al., RAS 2008). Closes the accepted edges of the graph
/// first, then pairs points of all scans near each other, linearizes, solves, moves, and begins
/// again. Scans of a loop edge that was not accepted are not linked. Edges whose scans are not
/// linked, and what odometry knows, stay in the system. The first scan, and the first of whatever
/// hangs on nothing, stays fixed. Throws Error if the graph and the scans do not go together or a
/// parameter is out of range.
GraphResult relax_lu_milios(const PoseGraph& graph, std::span<const MatchingScan> scans,
                            const LuMiliosParams& params = {}, const Progress& progress = {});

}  // namespace planum
