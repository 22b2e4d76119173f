#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/input_file.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/run_project.hpp"
#include "tools/planum/state_table.hpp"

namespace planum {
namespace {

struct RunArguments {
  ProjectArguments project;
  WorkArguments work;
  RunOptions options;
  bool dry_run = false;
  bool json = false;
};

void run_command(const RunArguments& arguments) {
  set_thread_count(arguments.work.threads);
  const Project project = read_project(arguments.project);
  if (arguments.dry_run) {
    const auto states = dry_run(project, arguments.options);
    fmt::print("{}", arguments.json ? states_json(states) : states_text(states));
    return;
  }
  Console console(arguments.work.quiet);
  const RunSummary summary = run_project(project, arguments.options, console);
  if (arguments.json) {
    fmt::print("{}", read_file(output_directory(project) / "report.json"));
  } else if (!arguments.work.quiet) {
    fmt::print("{}", results_text(project));
  }
  throw_shortcomings(summary);
}

}  // namespace

void add_run_command(CLI::App& app) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "bring every stage of a project up to date");
  add_project_arguments(*command, arguments->project);
  command->add_option("--from", arguments->options.from, "first stage to look at")
      ->type_name("STAGE")
      ->capture_default_str();
  command->add_option("--until", arguments->options.until, "last stage to look at")
      ->type_name("STAGE")
      ->capture_default_str();
  command->add_flag("--force", arguments->options.force,
                    "redo these stages even if they are fresh");
  command->add_flag("-n,--dry-run", arguments->dry_run, "only say what is stale and why");
  command->add_flag("--json", arguments->json, "print report.json (with --dry-run: the stages)");
  add_work_arguments(*command, arguments->work);
  command->footer(
      "Stages: import register relax cloud mesh polygons labels maps report.\n"
      "A run that was interrupted goes on where it was when it is started again.");
  command->callback([arguments] { run_command(*arguments); });
}

}  // namespace planum
