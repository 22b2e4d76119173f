#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/obj.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/pose_list.hpp"
#include "slam/io/tum.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/console.hpp"
#include "tools/planum/evaluation_output.hpp"
#include "tools/planum/relations_file.hpp"
#include "tools/workflow/map_evaluation.hpp"

namespace planum {
namespace {

namespace fs = std::filesystem;

struct EvaluateArguments {
  ProjectArguments project;
  fs::path truth, relations, model, model_poses;
  double relation_distance = 5;  ///< m
  TrajectoryErrorParams params;
  bool json = false;
  WorkArguments work;
};

/// What trajectories are compared with.
struct Truth {
  std::optional<Trajectory> trajectory;
  std::vector<Relation> relations;
  std::string relations_are;  ///< for people
};

Truth read_truth(const EvaluateArguments& arguments, const fs::path& file) {
  Truth truth;
  if (!file.empty()) truth.trajectory = read_tum(file);
  if (!arguments.relations.empty()) {
    truth.relations = read_relations(arguments.relations);
    truth.relations_are = "of " + arguments.relations.string();
  } else if (truth.trajectory) {
    truth.relations =
        relations_of(*truth.trajectory, {.max_distance = arguments.relation_distance});
    truth.relations_are =
        arguments.relation_distance > 0
            ? fmt::format("of poses within {:g} m of each other", arguments.relation_distance)
            : "of poses in a row";
  }
  return truth;
}

EvaluatedTrajectory evaluated(const std::string& name, const Trajectory& trajectory,
                              const Truth& truth, const TrajectoryErrorParams& params) {
  EvaluatedTrajectory result{.name = name, .error = {}, .segments = {}, .relations = {}};
  if (truth.trajectory) {
    result.error = trajectory_error(trajectory, *truth.trajectory, params);
    result.segments = segment_error(trajectory, *truth.trajectory);
  }
  if (!truth.relations.empty())
    result.relations = {truth.relations_are, relation_error(trajectory, truth.relations)};
  return result;
}

Evaluation evaluated_file(const EvaluateArguments& arguments) {
  if (arguments.truth.empty() && arguments.relations.empty())
    throw Error(fmt::format("{} is compared with what? Add --truth FILE or --relations FILE",
                            arguments.project.file.string()),
                ErrorKind::usage);
  if (!arguments.model.empty())
    throw Error("--model compares the map of a project, not a trajectory", ErrorKind::usage);
  const Truth truth = read_truth(arguments, arguments.truth);
  return {.trajectories = {evaluated("trajectory", read_tum(arguments.project.file), truth,
                                     arguments.params)},
          .map = {},
          .model = {}};
}

/// Where the scans truly were in the frame of the model.
Trajectory read_model_poses(const fs::path& file) {
  if (file.extension() == ".tum") return read_tum(file);
  Trajectory poses;
  for (const Pose& pose : read_pose_list(file))
    poses.push_back({static_cast<double>(poses.size()), pose});
  return poses;
}

ModelComparison compared_with_model(const EvaluateArguments& arguments, const fs::path& output,
                                    Results& results, Console& console) {
  const LabelledMesh model = read_obj(arguments.model);
  MapSurfaces map{.mesh = {}, .cloud = results.cloud.get(), .poses = results.world.get().poses};
  if (fs::exists(output / "map.ply")) map.mesh = read_ply_mesh(output / "map.ply");
  std::optional<Pose> model_from_map;
  if (!arguments.model_poses.empty())
    model_from_map = trajectory_error(read_tum(output / "trajectory.tum"),
                                      read_model_poses(arguments.model_poses))
                         .truth_from_estimate;
  const ModelComparison comparison = compare_with_model(map, model.mesh, model_from_map);
  if (comparison.cloud_to_model.median > 0.1)
    console.warn(fmt::format(
        "half of the points are more than {:.2f} m from the model: the frames "
        "do not agree{}",
        comparison.cloud_to_model.median, model_from_map ? "" : "; give --model-poses"));
  return comparison;
}

Evaluation evaluated_project(const EvaluateArguments& arguments) {
  Console console(arguments.work.quiet);
  const Project project = read_project(arguments.project);
  const fs::path output = output_directory(project);
  if (!fs::exists(output / "trajectory.tum"))
    throw Error(fmt::format("{} is not there yet; `planum run {}` makes it",
                            (output / "trajectory.tum").string(), project.file.string()));
  fs::path file = arguments.truth;
  if (file.empty() && !project.settings.truth.empty())
    file = resolved(project, project.settings.truth);
  const Truth truth = read_truth(arguments, file);
  Evaluation result;
  if (truth.trajectory || !truth.relations.empty())
    for (const auto& [name, tum] :
         {std::pair("odometry", "odometry.tum"), std::pair("map", "trajectory.tum")})
      result.trajectories.push_back(
          evaluated(name, read_tum(output / tum), truth, arguments.params));
  const CacheLayout layout{output};
  if (!fs::exists(layout.result("relax"))) {
    console.warn(
        "the work directory is gone, so that loops and the map cannot be evaluated; "
        "`planum run` makes it anew");
    return result;
  }
  Results results(layout, project.settings.matching);
  result.map =
      evaluate_map(results.world.get(), results.cloud.get(), results.registered.get(),
                   results.relaxed.get().graph, {}, console.start_bar("evaluate", "parts"));
  console.end_bar();
  if (!arguments.model.empty())
    result.model = compared_with_model(arguments, output, results, console);
  return result;
}

void evaluate_command(const EvaluateArguments& arguments) {
  set_thread_count(arguments.work.threads);
  const bool is_trajectory = arguments.project.file.extension() == ".tum";
  const Evaluation evaluation =
      is_trajectory ? evaluated_file(arguments) : evaluated_project(arguments);
  fmt::print("{}", arguments.json ? evaluation_json(evaluation) : evaluation_text(evaluation));
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand(
      "evaluate", "how good a map is: trajectory, loops, double walls, beside a model");
  add_project_arguments(*command, arguments->project);
  const auto file = [&](const char* name, fs::path& path, const char* what) {
    command->add_option(name, path, what)->type_name("FILE");
  };
  file("--truth", arguments->truth, "a .tum file; without it the one that the project names");
  file("--relations", arguments->relations,
       "true relations: a .g2o file, or lines `from to x y z roll pitch yaw`");
  command
      ->add_option("--relation-distance", arguments->relation_distance,
                   "m, without --relations: between poses of the truth; 0: poses in a row")
      ->type_name("M")
      ->capture_default_str();
  file("--model", arguments->model, "a .obj file: the building, in metres, z up");
  file("--model-poses", arguments->model_poses,
       "where the scans were in the model: a .tum file, or lines `x y z yaw pitch roll`; without "
       "it the points are laid onto the model");
  command->add_option("--delta", arguments->params.delta, "poses between the two of an RPE")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--all-pairs", arguments->params.all_pairs,
                    "an RPE for every pose, not only every delta-th");
  command->add_flag("--json", arguments->json, "for programs");
  add_work_arguments(*command, arguments->work);
  command->footer(
      "PROJECT may also be a .tum file: planum evaluate ESTIMATE.tum --truth TRUTH.tum\n"
      "APE: absolute, RPE: relative pose error, as evo defines them; docs/evaluation.md has all.");
  command->callback([arguments] { evaluate_command(*arguments); });
}

}  // namespace planum
