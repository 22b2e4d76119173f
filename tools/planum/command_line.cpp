#include "tools/planum/command_line.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/workflow/nearest_name.hpp"

namespace planum {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::string overview(const CLI::App& app) {
  std::string text =
      "planum turns scans of a tilting 2D laser into a consistent point cloud and a labelled\n"
      "polygon map.\n"
      "\n"
      "usage: planum COMMAND [ARGUMENTS]\n"
      "\n";
  for (const CLI::App* command : app.get_subcommands({})) {
    text += fmt::format("  {:<11} {}\n", command->get_name(), command->get_description());
  }
  text +=
      "\n"
      "To see it work:       planum demo\n"
      "On your own scans:    planum init path/to/scans\n"
      "                      planum run project.toml\n"
      "More on a command:    planum run --help\n";
  return text;
}

/// An unknown command or option: what was probably meant.
std::string did_you_mean(const std::string& typed, const std::vector<std::string>& names) {
  const auto near = nearest_name(typed, names);
  return near ? fmt::format(", did you mean '{}'?", *near) : "";
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

const CLI::App& active_command(const CLI::App& app) {
  const auto active = app.get_subcommands();
  return active.empty() ? app : *active.front();
}

[[noreturn]] void throw_usage(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = active_command(app);
  const std::string name = command.get_name();
  std::string message = error.what();
  const auto extras = command.remaining();
  if (!extras.empty()) {
    message = extras.front().starts_with('-')
                  ? fmt::format("unknown option '{}'{}", extras.front(),
                                did_you_mean(extras.front(), option_names(command)))
                  : fmt::format("'{}' is one argument too many", extras.front());
  }
  throw Error(fmt::format("{}: {} (planum {} --help shows what there is)", name, message, name),
              ErrorKind::usage);
}

void add_commands(CLI::App& app) {
  add_demo_command(app);
  add_init_command(app);
  add_check_command(app);
  add_run_command(app);
  add_status_command(app);
  add_config_command(app);
  add_evaluate_command(app);
  add_view_command(app);
  add_register_command(app);
  add_optimize_command(app);
  add_polygonize_command(app);
  add_simulate_command(app);
  add_convert_command(app);
  for (CLI::App* command : app.get_subcommands({})) {
    command->get_formatter()->column_width(36);
  }
}

}  // namespace

void command_line(int argc, const char* const* argv) {
  CLI::App app("", "planum");
  app.set_version_flag("--version", "planum " PLANUM_VERSION);
  add_commands(app);
  const std::string first = argc > 1 ? argv[1] : "";
  if (first.empty() || first == "--help" || first == "-h" || first == "help") {
    fmt::print("{}", overview(app));
    return;
  }
  const auto names = command_names(app);
  if (!first.starts_with('-') && std::find(names.begin(), names.end(), first) == names.end()) {
    throw Error(fmt::format("unknown command '{}'{} (planum alone lists all commands)", first,
                            did_you_mean(first, names)),
                ErrorKind::usage);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    app.exit(success);
  } catch (const CLI::ParseError& error) {
    throw_usage(app, error);
  }
}

}  // namespace planum
