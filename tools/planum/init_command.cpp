#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/scan_directory.hpp"
#include "slam/io/scan_poses.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/workflow/project_keys.hpp"

namespace planum {
namespace {

struct InitArguments {
  std::filesystem::path scans;
  std::filesystem::path output = "project.toml";
  std::string format = "auto";
  bool force = false;
};

/// How a project file names a path: relative to itself where both are near each other.
std::string path_from(const std::filesystem::path& project_file,
                      const std::filesystem::path& path) {
  const auto from =
      std::filesystem::weakly_canonical(std::filesystem::absolute(project_file)).parent_path();
  const auto to = std::filesystem::weakly_canonical(path);
  const std::string relative = to.lexically_relative(from).string();
  return relative.starts_with("../../../") ? to.string() : relative;
}

/// A trajectory that by its name is the truth and not a measurement.
std::optional<std::filesystem::path> truth_beside(const ScanDirectory& directory) {
  for (const auto& path : directory.trajectories) {
    const std::string name = path.stem().string();
    if (name == "truth" || name == "groundtruth" || name == "ground_truth") return path;
  }
  return std::nullopt;
}

void init_command(const InitArguments& arguments) {
  if (std::filesystem::exists(arguments.output) && !arguments.force) {
    throw Error(fmt::format("{} is there already; --force replaces it, -o chooses another name",
                            arguments.output.string()),
                ErrorKind::usage);
  }
  const ScanDirectory directory = list_scans(arguments.scans, arguments.format);
  const ScanPoses poses = read_scan_poses(directory);
  std::map<std::string, std::string> values = {
      {"scans.directory", quoted_toml(path_from(arguments.output, arguments.scans))},
      {"scans.format", quoted_toml(name(directory.format))}};
  const auto truth = truth_beside(directory);
  if (truth) values["evaluation.truth"] = quoted_toml(path_from(arguments.output, *truth));
  write_file_atomically(arguments.output, project_template(values));

  const auto& scans = directory.scans;
  fmt::print("scans   {} in format {}, {} to {}\n", scans.size(), name(directory.format),
             scans.front().file.filename().string(), scans.back().file.filename().string());
  fmt::print("poses   {}\n", poses.source == "none"
                                 ? "none found: scan matching starts from where the last scan was"
                                 : std::filesystem::path(poses.source).filename().string());
  if (truth) fmt::print("truth   {}: every run reports its error\n", truth->filename().string());
  fmt::print("\nWrote {}, with every key explained. Next:\n\n  planum run {}\n",
             arguments.output.string(), arguments.output.string());
}

}  // namespace

void add_init_command(CLI::App& app) {
  const auto arguments = std::make_shared<InitArguments>();
  CLI::App* command =
      app.add_subcommand("init", "look at a directory of scans and write a project file for it");
  command->add_option("SCAN_DIR", arguments->scans, "directory of scans")->required();
  command->add_option("-o,--output", arguments->output, "project file to write")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_option("--format", arguments->format, "of the scans: auto, uos, slices, ply or xyz")
      ->type_name("FORMAT")
      ->capture_default_str();
  command->add_flag("--force", arguments->force, "replace a project file that is there already");
  command->callback([arguments] { init_command(*arguments); });
}

}  // namespace planum
