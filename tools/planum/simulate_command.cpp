#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/obj.hpp"
#include "slam/io/pose_list.hpp"
#include "slam/sensor/simulator.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/console.hpp"
#include "tools/planum/simulated_scans.hpp"

namespace planum {
namespace {

struct SimulateArguments {
  std::filesystem::path model, poses, output;
  SimulatorParams simulator;
  DriftParams drift;
  double min_tilt_deg = degrees(SimulatorParams().min_tilt);
  double max_tilt_deg = degrees(SimulatorParams().max_tilt);
  bool perfect = false;
  WorkArguments work;
};

void simulate_command(SimulateArguments arguments) {
  set_thread_count(arguments.work.threads);
  SimulatorParams& simulator = arguments.simulator;
  simulator.min_tilt = radians(arguments.min_tilt_deg);
  simulator.max_tilt = radians(arguments.max_tilt_deg);
  arguments.drift.seed = simulator.seed;
  if (arguments.perfect) {
    simulator.range_noise = simulator.drop_out = simulator.grazing_drop_out = 0;
    simulator.mixed_pixel = 0;
  }
  Console console(arguments.work.quiet);
  const LabelledMesh model = read_obj(arguments.model);
  const std::vector<Pose> poses = read_pose_list(arguments.poses);
  if (std::filesystem::exists(arguments.output) && !std::filesystem::is_empty(arguments.output)) {
    throw Error(fmt::format("{} is not empty; choose another directory", arguments.output.string()),
                ErrorKind::usage);
  }
  write_simulated_scans(arguments.output, model.mesh, poses, simulator,
                        console.start_bar("simulate", "scans"));
  write_simulated_trajectories(arguments.output, poses, arguments.drift);
  console.end_bar();
  fmt::print("{} scans, odometry.tum and truth.tum in {}\n", poses.size(),
             arguments.output.string());
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  const auto arguments = std::make_shared<SimulateArguments>();
  SimulatorParams& simulator = arguments->simulator;
  CLI::App* command = app.add_subcommand("simulate", "virtual tilted-laser scans of a model");
  command->add_option("BUILDING.obj", arguments->model, "the model, in metres, z up")->required();
  command->add_option("--poses", arguments->poses, "lines `x y z yaw pitch roll` (m, degrees)")
      ->type_name("FILE")
      ->required();
  command->add_option("--out", arguments->output, "directory for scans, odometry.tum, truth.tum")
      ->type_name("DIR")
      ->required();
  command->add_option("--beams", simulator.beams, "of a slice, over half a turn")
      ->capture_default_str();
  command->add_option("--slices", simulator.slices, "of a scan")->capture_default_str();
  command->add_option("--min-tilt-deg", arguments->min_tilt_deg, "of the first slice")
      ->capture_default_str();
  command->add_option("--max-tilt-deg", arguments->max_tilt_deg, "of the last slice")
      ->capture_default_str();
  command->add_option("--noise-m", simulator.range_noise, "standard deviation of ranges")
      ->capture_default_str();
  command->add_option("--seed", simulator.seed, "of all chance")->capture_default_str();
  command->add_flag("--perfect", arguments->perfect, "no noise, drop-outs or mixed pixels");
  add_work_arguments(*command, arguments->work);
  command->callback([arguments] { simulate_command(*arguments); });
}

}  // namespace planum
