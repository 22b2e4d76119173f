#include <algorithm>

#include <fmt/format.h>

#include "slam/graph/graph_optimization.hpp"
#include "slam/graph/loops.hpp"
#include "slam/graph/plane_refinement.hpp"
#include "slam/graph/pose_graph.hpp"
#include "slam/graph/relax_lu_milios.hpp"
#include "tools/workflow/pair_matching.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {
namespace {

/// Scans that hang together, the largest group first.
std::vector<std::vector<std::size_t>> groups_of(const PoseGraph& graph) {
  auto groups = components(graph).members();
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return groups;
}

void add_loops(PoseGraph& graph, StageContext& context) {
  const Settings& settings = context.project.settings;
  PairMatching matching(context.results, settings, context.units, context.progress);
  const std::vector<Edge> loops =
      find_loops(context.results.matching_scans(context.progress), graph, matching.gated_matcher(),
                 settings.loops, context.progress);
  graph.edges.insert(graph.edges.end(), loops.begin(), loops.end());
}

/// The pose graph alone: loops that contradict the rest are left out.
Relaxed optimized(PoseGraph graph, StageContext& context) {
  const OptimizedGraph result = optimize(graph, {.covariances = false}, context.progress);
  graph.poses = result.poses;
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    Edge& edge = graph.edges[k];
    if (!edge.accepted || result.quality.counts[k]) continue;
    edge.accepted = false;
    edge.reason = "the pose graph contradicts it";
  }
  return {.graph = std::move(graph),
          .iterations = result.quality.iterations,
          .converged = result.quality.converged,
          .components = {}};
}

Relaxed relaxed(const PoseGraph& graph, StageContext& context) {
  const Settings& settings = context.project.settings;
  LuMiliosParams params = settings.relaxation;
  params.pairing = pairing_of(settings);
  GraphResult result = relax_lu_milios(graph, context.results.matching_scans(context.progress),
                                       params, context.progress);
  return {std::move(result.graph), result.residual_before, result.residual_after,
          result.iterations,       result.converged,       {}};
}

/// Sharpens walls; what it did, for the record.
std::string refine(Relaxed& relaxed, StageContext& context) {
  PlaneRefinement result =
      refine_planes(relaxed.graph.poses, context.results.matching_scans(context.progress),
                    components(relaxed.graph).of_pose, {}, context.progress);
  relaxed.graph.poses = std::move(result.poses);
  if (!result.improved) return "; not refined: " + result.reason;
  return fmt::format("; {} planes {:.2f} -> {:.2f} mm", result.planes,
                     1000 * result.thickness_before, 1000 * result.thickness_after);
}

/// Names the scans that are not part of the map.
void report_groups(const Relaxed& relaxed, const Imported& imported, Manifest& record) {
  std::string lost;
  for (std::size_t i = 1; i < relaxed.components.size(); ++i) {
    for (const std::size_t scan : relaxed.components[i]) {
      lost += (lost.empty() ? "" : ", ") + imported.scans[scan].id;
    }
  }
  if (lost.empty()) return;
  record.shortcomings.push_back(
      fmt::format("{} could not be connected to the other scans; the map shows the other {}", lost,
                  relaxed.components.front().size()));
}

std::string summary(const Relaxed& relaxed) {
  std::size_t accepted = 0, rejected = 0;
  for (const Edge& edge : relaxed.graph.edges) {
    if (edge.kind == EdgeKind::loop) ++(edge.accepted ? accepted : rejected);
  }
  const std::string loops = fmt::format("{} loops closed, {} rejected", accepted, rejected);
  const std::string end = relaxed.converged ? "" : ", not converged";
  if (relaxed.residual_after == 0) return loops + end;  // no links were measured
  return fmt::format("{}; rms {:.1f} -> {:.1f} mm{}", loops, 1000 * relaxed.residual_before,
                     1000 * relaxed.residual_after, end);
}

void work(StageContext& context) {
  const Settings& settings = context.project.settings;
  const Imported& imported = context.results.imported.get();
  Relaxed result;
  result.graph = pose_graph(context.results.registered.get());
  if (settings.relaxation_method == "none" || settings.registration_method == "none") {
    context.record.summary = "the poses stay as they are";
  } else {
    if (settings.close_loops) add_loops(result.graph, context);
    const std::string& method = settings.relaxation_method;
    if (method != "lu-milios") result = optimized(std::move(result.graph), context);
    if (method != "pose-graph") result = relaxed(result.graph, context);
    context.record.summary = summary(result);
    if (settings.refine_planes) context.record.summary += refine(result, context);
    if (!result.converged) {
      context.record.warnings.push_back(
          fmt::format("the relaxation did not converge in {} iterations", result.iterations));
    }
  }
  result.components = groups_of(result.graph);
  report_groups(result, imported, context.record);
  write_result(context.result, result);
  context.results.relaxed.set(std::move(result));
}

}  // namespace

Stage relax_stage() {
  return {.name = "relax",
          .version = 5,
          .unit = "steps",
          .needs = {"import", "register"},
          .parameters = {"registration", "loops", "relaxation"},
          .input_files = {},
          .work = work};
}

}  // namespace planum
