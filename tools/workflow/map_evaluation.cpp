#include "tools/workflow/map_evaluation.hpp"

#include <algorithm>
#include <limits>

#include "slam/evaluation/sampling.hpp"

namespace planum {
namespace {

/// Scans on either side of a loop's two, if they are far enough apart.
constexpr std::size_t scans_beside = 2;

/// Points of each scan where the map has them.
std::vector<Cloud> clouds_of_scans(const Cloud& cloud, std::size_t scans, std::size_t wanted) {
  std::vector<std::vector<std::size_t>> points(scans);
  for (std::size_t i = 0; i < cloud.scan.size(); ++i) points[cloud.scan[i]].push_back(i);
  std::vector<Cloud> result;
  for (const std::vector<std::size_t>& own : points) {
    std::vector<std::size_t> chosen;
    for (const std::size_t k : evenly_chosen(own.size(), wanted)) chosen.push_back(own[k]);
    result.push_back(chosen_points(cloud, chosen));
  }
  return result;
}

/// Scans begin to end (not included), each moved.
Cloud group_of(const std::vector<Cloud>& scans, const std::vector<Pose>& motions, std::size_t begin,
               std::size_t end) {
  Cloud group;
  for (std::size_t i = begin; i < end; ++i) {
    const Cloud moved = transformed(scans[i], motions[i]);
    group.points.insert(group.points.end(), moved.points.begin(), moved.points.end());
    group.normals.insert(group.normals.end(), moved.normals.begin(), moved.normals.end());
  }
  return group;
}

/// Accepted loops, those first that have the most scans between them.
std::vector<const Edge*> longest_loops(const PoseGraph& graph, std::size_t most) {
  std::vector<const Edge*> loops;
  for (const Edge& edge : graph.edges)
    if (edge.kind == EdgeKind::loop && edge.accepted) loops.push_back(&edge);
  const auto span = [](const Edge& e) { return std::max(e.from, e.to) - std::min(e.from, e.to); };
  std::stable_sort(loops.begin(), loops.end(),
                   [&](const Edge* a, const Edge* b) { return span(*a) > span(*b); });
  if (most > 0 && loops.size() > most) loops.resize(most);
  return loops;
}

/// The gaps of the scans about both ends of the loops.
std::vector<DoubleWallPatch> gaps_of(const std::vector<const Edge*>& loops,
                                     const std::vector<Cloud>& scans,
                                     const std::vector<Pose>& motions,
                                     const DoubleWallParams& params) {
  std::vector<DoubleWallPatch> patches;
  for (const Edge* loop : loops) {
    const auto [first, last] = std::minmax(loop->from, loop->to);
    const std::size_t beside = std::min(scans_beside, (last - first - 1) / 2);
    const auto group = [&](std::size_t scan) {
      return group_of(scans, motions, scan - std::min(scan, beside),
                      std::min(scan + beside + 1, scans.size()));
    };
    const auto found = double_walls(group(first), group(last), params);
    patches.insert(patches.end(), found.begin(), found.end());
  }
  return patches;
}

void add_walls(const World& world, const Cloud& cloud, const SequenceMatch& registered,
               const PoseGraph& graph, const MapEvaluationParams& params, MapEvaluation& result) {
  const auto loops = longest_loops(graph, params.loops_with_walls);
  result.loops_with_walls = loops.size();
  if (loops.empty()) return;
  const auto scans = clouds_of_scans(cloud, world.poses.size(), params.points_per_scan);
  const std::vector<Pose> stay(scans.size(), Pose::Identity());
  std::vector<Pose> back;  // before_from_after
  for (std::size_t i = 0; i < scans.size(); ++i)
    back.push_back(world.world_from_input * registered.poses[i] * world.poses[i].inverse());
  DoubleWallParams walls = params.walls;
  if (params.patches > 0)
    walls.max_patches = std::max(params.patches / loops.size(), std::size_t{1});
  result.walls_before = double_wall_gap(gaps_of(loops, scans, back, walls));
  result.walls_after = double_wall_gap(gaps_of(loops, scans, stay, walls));
}

void add_loops(const World& world, const SequenceMatch& registered, const PoseGraph& graph,
               const MapEvaluationParams& params, MapEvaluation& result) {
  const HeldOutLoops held_out = held_out_loops(graph, params.held_out);
  result.held_out_solved = held_out.solved;
  result.held_out_converged = held_out.converged;
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    const Edge& edge = graph.edges[k];
    if (edge.kind != EdgeKind::loop) continue;
    const EdgeNoise& noise = params.held_out.noise;
    result.loops.push_back({.from = world.numbers[edge.from],
                            .to = world.numbers[edge.to],
                            .accepted = edge.accepted,
                            .reason = edge.reason,
                            .odometry = edge_residual(edge, world.odometry, noise),
                            .before = edge_residual(edge, registered.poses, noise),
                            .after = edge_residual(edge, world.poses, noise),
                            .held_out = held_out.residuals[k]});
  }
}

}  // namespace

MapEvaluationParams quick_map_evaluation() {
  return {.sharpness = {.radius = 0.3, .max_points = 60'000, .max_queries = 600},
          .walls = {},
          .patches = 300,
          .loops_with_walls = 3,
          .points_per_scan = 8000,
          .held_out = {}};
}

MapEvaluation evaluate_map(const World& world, const Cloud& cloud, const SequenceMatch& registered,
                           const PoseGraph& graph, const MapEvaluationParams& params,
                           const Progress& progress) {
  MapEvaluation result;
  result.sharpness = map_sharpness(cloud.points, params.sharpness);
  progress.report(1, 3);
  add_loops(world, registered, graph, params, result);
  progress.report(2, 3);
  add_walls(world, cloud, registered, graph, params, result);
  progress.report(3, 3);
  return result;
}

MapFigures map_figures(const MapEvaluation& evaluation) {
  MapFigures figures;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const bool measured = evaluation.sharpness.measured > 0;
  figures.entropy = measured ? evaluation.sharpness.mean_entropy : unknown;
  figures.plane_thickness = measured ? evaluation.sharpness.plane_thickness : unknown;
  const auto gap = [](const DoubleWallGap& walls) -> std::optional<GapFigures> {
    if (walls.patches == 0) return std::nullopt;
    return GapFigures{walls.median, walls.percentile_90};
  };
  figures.walls_before = gap(evaluation.walls_before);
  figures.walls = gap(evaluation.walls_after);
  for (const LoopEvaluation& loop : evaluation.loops) {
    LoopFigures loop_figures{
        .from = loop.from,
        .to = loop.to,
        .accepted = loop.accepted,
        .reason = loop.reason,
        .before = {loop.before.translation, loop.before.rotation, loop.before.deviations},
        .after = {loop.after.translation, loop.after.rotation, loop.after.deviations},
        .held_out = {}};
    if (loop.held_out)
      loop_figures.held_out = {loop.held_out->translation, loop.held_out->rotation,
                               loop.held_out->deviations};
    figures.loops.push_back(loop_figures);
  }
  return figures;
}

}  // namespace planum
