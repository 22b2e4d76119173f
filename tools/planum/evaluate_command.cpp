#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/evaluation/trajectory_error.hpp"
#include "slam/io/tum.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"

namespace planum {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct EvaluateArguments {
  ProjectArguments project;
  fs::path truth;
  TrajectoryErrorParams params;
  bool json = false;
};

/// An evaluated trajectory and what it is called.
struct Evaluated {
  std::string name;
  TrajectoryError error;
};

const char* name(TrajectoryAlignment alignment) {
  switch (alignment) {
    case TrajectoryAlignment::none:
      return "not aligned";
    case TrajectoryAlignment::first_pose:
      return "aligned by the first pose";
    case TrajectoryAlignment::positions:
      return "aligned by positions (Umeyama)";
    case TrajectoryAlignment::joint:
      return "aligned by positions and orientations";
  }
  return "";
}

std::string row(const char* what, const ErrorStatistics& s) {
  return fmt::format("  {:<16}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.4f}\n", what, s.rmse,
                     s.mean, s.median, s.std, s.min, s.max);
}

void print_text(const std::vector<Evaluated>& all) {
  for (const auto& [what, error] : all) {
    fmt::print("{}: {} poses, {}\n", what, error.matches.size(), name(error.alignment));
    fmt::print("  {:<16}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "", "rmse", "mean", "median", "std",
               "min", "max");
    fmt::print("{}{}", row("APE m", error.ape_translation), row("APE degrees", error.ape_rotation));
    if (error.rpe_translation.count > 0) {
      fmt::print("{}{}", row("RPE m", error.rpe_translation),
                 row("RPE degrees", error.rpe_rotation));
    }
    fmt::print("\n");
  }
}

Json statistics_json(const ErrorStatistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
          {"min", s.min},   {"max", s.max},   {"sse", s.sse},       {"count", s.count}};
}

void print_json(const std::vector<Evaluated>& all) {
  Json json = Json::object();
  for (const auto& [what, error] : all) {
    json[what] = {{"poses", error.matches.size()},
                  {"ape_translation_m", statistics_json(error.ape_translation)},
                  {"ape_rotation_deg", statistics_json(error.ape_rotation)},
                  {"rpe_translation_m", statistics_json(error.rpe_translation)},
                  {"rpe_rotation_deg", statistics_json(error.rpe_rotation)}};
  }
  fmt::print("{}\n", json.dump(1));
}

std::vector<Evaluated> evaluated_files(const EvaluateArguments& arguments) {
  if (arguments.truth.empty()) {
    throw Error(
        fmt::format("{} is compared with what? Add --truth FILE", arguments.project.file.string()),
        ErrorKind::usage);
  }
  return {{"trajectory", trajectory_error(read_tum(arguments.project.file),
                                          read_tum(arguments.truth), arguments.params)}};
}

std::vector<Evaluated> evaluated_project(const EvaluateArguments& arguments) {
  const Project project = read_project(arguments.project);
  const fs::path file =
      arguments.truth.empty() ? resolved(project, project.settings.truth) : arguments.truth;
  if (arguments.truth.empty() && project.settings.truth.empty()) {
    throw Error(fmt::format("{} names no truth: add --truth FILE, or truth = \"FILE\" under "
                            "[evaluation]",
                            project.file.string()),
                ErrorKind::usage);
  }
  const fs::path output = output_directory(project);
  if (!fs::exists(output / "trajectory.tum")) {
    throw Error(fmt::format("{} is not there yet; `planum run {}` makes it",
                            (output / "trajectory.tum").string(), project.file.string()));
  }
  const Trajectory truth = read_tum(file);
  return {
      {"odometry", trajectory_error(read_tum(output / "odometry.tum"), truth, arguments.params)},
      {"map", trajectory_error(read_tum(output / "trajectory.tum"), truth, arguments.params)}};
}

void evaluate_command(const EvaluateArguments& arguments) {
  const bool is_trajectory = arguments.project.file.extension() == ".tum";
  const auto all = is_trajectory ? evaluated_files(arguments) : evaluated_project(arguments);
  if (arguments.json) {
    print_json(all);
  } else {
    print_text(all);
  }
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand("evaluate", "error of the trajectory against the truth");
  add_project_arguments(*command, arguments->project);
  command
      ->add_option("--truth", arguments->truth,
                   "a .tum file; without it the one that the project names")
      ->type_name("FILE");
  command->add_option("--delta", arguments->params.delta, "poses between the two of an RPE")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--all-pairs", arguments->params.all_pairs,
                    "an RPE for every pose, not only every delta-th");
  command->add_flag("--json", arguments->json, "for programs");
  command->footer(
      "PROJECT may also be a .tum file: planum evaluate ESTIMATE.tum --truth TRUTH.tum\n"
      "APE: absolute, RPE: relative pose error, as evo defines them.");
  command->callback([arguments] { evaluate_command(*arguments); });
}

}  // namespace planum
