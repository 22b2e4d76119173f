#include <algorithm>

#include <fmt/format.h>

#include "slam/core/parallel.hpp"
#include "slam/io/tum.hpp"
#include "tools/report/run_report.hpp"
#include "tools/report/top_view.hpp"
#include "tools/workflow/figures.hpp"
#include "tools/workflow/map_evaluation.hpp"
#include "tools/workflow/stages/stages.hpp"
#include "tools/workflow/trajectory_figures.hpp"

namespace planum {
namespace {

std::vector<std::filesystem::path> input_files(const Project& project) {
  if (project.settings.truth.empty()) return {};
  return {resolved(project, project.settings.truth)};
}

std::vector<StageCost> costs(const StageContext& context) {
  std::vector<StageCost> costs;
  for (const Stage& stage : stages()) {
    const auto made = context.finished.find(stage.name);
    if (made == context.finished.end()) continue;
    const bool redone =
        std::find(context.redone.begin(), context.redone.end(), stage.name) != context.redone.end();
    costs.push_back({stage.name, made->second.seconds, !redone, made->second.peak_memory_mb});
  }
  return costs;
}

TrajectoryFigures compared(const Trajectory& trajectory, const Trajectory& truth) {
  return trajectory_figures(trajectory_error(trajectory, truth), segment_error(trajectory, truth));
}

void evaluate_trajectory(StageContext& context, RunReport& report) {
  if (context.project.settings.truth.empty()) return;
  const Trajectory truth = read_tum(resolved(context.project, context.project.settings.truth));
  const Imported& imported = context.results.imported.get();
  const World& world = context.results.world.get();
  report.evaluation = compared(mapped_trajectory(imported, world), truth);
  report.odometry_evaluation = compared(odometry_trajectory(imported, world), truth);
  context.record.summary +=
      fmt::format(", trajectory error {:.3f} m rmse (odometry {:.3f} m)",
                  report.evaluation->ate_rmse, report.odometry_evaluation->ate_rmse);
}

void evaluate(StageContext& context, RunReport& report) {
  Results& results = context.results;
  evaluate_trajectory(context, report);
  report.map_evaluation =
      map_figures(evaluate_map(results.world.get(), results.cloud.get(), results.registered.get(),
                               results.relaxed.get().graph, quick_map_evaluation()));
}

void draw(StageContext& context) {
  Results& results = context.results;
  const World& world = results.world.get();
  TopView view{.cloud = results.cloud.get(),
               .before = world.odometry,
               .after = world.poses,
               .names = {},
               .loops = {},
               .rooms = &results.labelled.get().rooms};
  for (const Scan& scan : results.imported.get().scans) {
    view.names.push_back(std::to_string(scan.number));
  }
  for (const Edge& edge : results.relaxed.get().graph.edges) {
    if (edge.kind == EdgeKind::loop && edge.accepted) view.loops.emplace_back(edge.from, edge.to);
  }
  write_top_view(context.staging / "topview.png", view);
}

void work(StageContext& context) {
  Results& results = context.results;
  const TriangleMesh& mesh = results.mesh.get();
  RunReport report;
  report.version = PLANUM_VERSION;
  report.threads = thread_count();
  report.stages = costs(context);
  report.scans = scan_figures(results.imported.get());
  report.registration =
      registration_figures(results.imported.get(), results.registered.get(), results.relaxed.get());
  report.levelled = rotation_angle(results.world.get().world_from_input);
  report.mesh = {mesh.vertices.size(), mesh.triangles.size()};
  report.polygons = polygon_figures(results.polygons.get(), mesh);
  report.map = &results.polygons.get();
  report.labels = &results.labelled.get().labels;
  report.rooms = &results.labelled.get().rooms;
  report.objects = results.labelled.get().objects;
  context.record.summary = "report.json, topview.png";
  evaluate(context, report);
  draw(context);
  write_report_json(context.staging / "report.json", report);
}

}  // namespace

Stage report_stage() {
  return {.name = "report",
          .version = 3,
          .unit = "steps",
          .needs = {"import", "register", "relax", "cloud", "mesh", "polygons", "labels"},
          .parameters = {"evaluation"},
          .input_files = input_files,
          .work = work};
}

}  // namespace planum
