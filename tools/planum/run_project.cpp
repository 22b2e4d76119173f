#include "tools/planum/run_project.hpp"

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "tools/planum/progress_text.hpp"

namespace planum {
namespace {

void say(Console& console, const std::string& stage, const std::string& when,
         const std::string& what) {
  console.info(fmt::format("{:<9} {:>9}  {}", stage, when, what));
}

/// Reasons that tell a person nothing new are left out.
bool worth_saying(const std::string& reason) {
  return reason != "never run" && reason != "--force" && !reason.starts_with("the result of ");
}

RunListener listener_for(Console& console) {
  RunListener listener;
  listener.started = [&](const Stage& stage, const std::string& reason) {
    if (worth_saying(reason)) say(console, stage.name, "", reason);
  };
  listener.progress = [&](const Stage& stage) { return console.start_bar(stage.name, stage.unit); };
  listener.finished = [&](const Stage& stage, const Manifest& manifest) {
    console.end_bar();
    say(console, stage.name, duration_text(manifest.seconds), manifest.summary);
    for (const std::string& warning : manifest.warnings) console.warn(warning);
  };
  listener.fresh = [&](const Stage& stage, const Manifest& manifest) {
    say(console, stage.name, "fresh", manifest.summary);
  };
  listener.used_stale = [&](const Stage& stage, const std::string& reason) {
    console.warn(fmt::format("{} is not up to date and used as it is ({})", stage.name, reason));
  };
  return listener;
}

}  // namespace

RunSummary run_project(const Project& project, const RunOptions& options, Console& console) {
  try {
    return run(project, options, listener_for(console));
  } catch (...) {
    console.end_bar();
    throw;
  }
}

std::string results_text(const Project& project) {
  const std::filesystem::path output = output_directory(project);
  const std::pair<const char*, const char*> files[] = {
      {"topview.png", "the plan: rooms, doors, the path before and after"},
      {"floorplan.svg, .dxf", "the plan to scale, for paper and CAD"},
      {"map.glb", "the polygon map with textures, for viewers"},
      {"map.obj, map.ply", "the same as triangles, by label"},
      {"polygons.json", "the polygon map with labels, rooms and openings, for programs"},
      {"occupancy.yaml, keepout.yaml", "what is in a robot's way, for map_server"},
      {"map.bt, navmesh.bin, world/", "for OctoMap, Detour, Gazebo"},
      {"cloud.ply, mesh.ply", "what it was made from"},
      {"trajectory.tum", "where the scans were taken"},
      {"report.json", "all figures"}};
  std::string text = fmt::format("{}/\n", output.string());
  for (const auto& [names, meaning] : files) {
    const std::string first = std::string(names).substr(0, std::string_view(names).find(','));
    if (std::filesystem::exists(output / first)) {
      text += fmt::format("  {:<30}{}\n", names, meaning);
    }
  }
  return text;
}

void throw_shortcomings(const RunSummary& summary) {
  if (summary.shortcomings.empty()) return;
  throw Error(fmt::format("{}", fmt::join(summary.shortcomings, "; ")), ErrorKind::no_result);
}

}  // namespace planum
