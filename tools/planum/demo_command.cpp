#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/evaluation/trajectory_error.hpp"
#include "slam/io/tum.hpp"
#include "slam/sensor/demo_building.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/comparison.hpp"
#include "tools/planum/demo_case.hpp"
#include "tools/planum/run_project.hpp"
#include "tools/workflow/results.hpp"

namespace planum {
namespace {

struct DemoArguments {
  std::filesystem::path directory = "planum-demo";
  WorkArguments work;
};

/// A directory of somebody else's is left alone.
void check_directory(const std::filesystem::path& directory) {
  if (std::filesystem::exists(directory / "project.toml") &&
      !std::filesystem::exists(directory / "dimensions.json")) {
    throw Error(fmt::format("{} holds another project; name another directory: planum demo DIR",
                            directory.string()),
                ErrorKind::usage);
  }
}

std::string error_line(const char* what, const TrajectoryError& error) {
  return fmt::format("  {:<24}{:.3f} m rmse, {:.3f} m at most, {:.2f} degrees on average\n", what,
                     error.ape_translation.rmse, error.ape_translation.max,
                     error.ape_rotation.mean);
}

void print_comparison(const Project& project, const Building& building) {
  const auto output = output_directory(project);
  const Trajectory truth = read_tum(resolved(project, project.settings.truth));
  const auto before = trajectory_error(read_tum(output / "odometry.tum"), truth);
  const auto after = trajectory_error(read_tum(output / "trajectory.tum"), truth);
  fmt::print("\ntrajectory error\n{}{}\n", error_line("odometry", before),
             error_line("map", after));
  // true_poses.txt is in the frame of the building, truth.tum in that of the first pose.
  const Pose building_from_world = demo_poses().front() * after.truth_from_estimate;
  Results results(CacheLayout{output}, project.settings.matching);
  fmt::print("{}\n", comparison_text(building, results.labelled.get().rooms, building_from_world));
}

void demo_command(const DemoArguments& arguments) {
  set_thread_count(arguments.work.threads);
  check_directory(arguments.directory);
  Console console(arguments.work.quiet);
  const Building building = demo_building();
  console.info(
      fmt::format("A furnished building of {} rooms, scanned from {} places with drifting "
                  "odometry, in {}",
                  building.rooms.size(), demo_poses().size(), arguments.directory.string()));
  write_demo_case(arguments.directory, building, console);
  const Project project = read_project(arguments.directory);
  const RunSummary summary = run_project(project, {}, console);
  print_comparison(project, building);
  fmt::print("{}", results_text(project));
  throw_shortcomings(summary);
}

}  // namespace

void add_demo_command(CLI::App& app) {
  const auto arguments = std::make_shared<DemoArguments>();
  CLI::App* command =
      app.add_subcommand("demo", "scan a built-in building, map it, compare the map with it");
  command->add_option("DIR", arguments->directory, "where everything goes")->capture_default_str();
  add_work_arguments(*command, arguments->work);
  command->callback([arguments] { demo_command(*arguments); });
}

}  // namespace planum
