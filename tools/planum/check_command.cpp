#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/tum.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/console.hpp"
#include "tools/workflow/project_scans.hpp"

namespace planum {
namespace {

struct CheckArguments {
  ProjectArguments project;
  WorkArguments work;
};

/// What is wrong with each scan; empty where it can be used.
std::vector<std::string> problems_of_scans(const ScanDirectory& directory, const Project& project,
                                           const Progress& progress) {
  std::vector<std::string> problems(directory.scans.size());
  const auto check_scan = [&](std::size_t i, std::size_t) {
    try {
      read_scan(directory.scans[i], directory.format, project.settings);
    } catch (const Error& error) {
      problems[i] = error.what();
    }
  };
  parallel_for(problems.size(), 1, check_scan, progress);
  std::erase(problems, "");
  return problems;
}

void check_command(const CheckArguments& arguments) {
  set_thread_count(arguments.work.threads);
  Console console(arguments.work.quiet);
  const Project project = read_project(arguments.project);
  const ScanDirectory directory = scan_files(project);
  const ScanPoses poses = scan_poses(project, directory);
  if (!project.settings.truth.empty()) read_tum(resolved(project, project.settings.truth));
  const auto problems = problems_of_scans(directory, project, console.start_bar("scans", "scans"));
  console.end_bar();
  for (const std::string& problem : problems) fmt::print("{}\n", problem);
  if (!problems.empty()) {
    throw Error(
        fmt::format("{} of {} scans cannot be used", problems.size(), directory.scans.size()));
  }
  fmt::print("{} is fine: {} {} scans, poses: {}\n", project.file.string(), directory.scans.size(),
             name(directory.format), poses.source);
}

}  // namespace

void add_check_command(CLI::App& app) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command =
      app.add_subcommand("check", "read the project file and all scans, change nothing");
  add_project_arguments(*command, arguments->project);
  add_work_arguments(*command, arguments->work);
  command->callback([arguments] { check_command(*arguments); });
}

}  // namespace planum
