#include <cstdlib>
#include <spawn.h>
#include <unistd.h>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"

extern char** environ;

namespace planum {
namespace {

struct ViewArguments {
  ProjectArguments project;
  bool no_open = false;
};

bool has_desktop() {
  return isatty(STDOUT_FILENO) == 1 && (std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY"));
}

/// Hands the file to the desktop; that there is no program for it is no error.
void open_on_desktop(const std::string& file) {
  std::string program = "xdg-open", argument = file;
  char* const arguments[] = {program.data(), argument.data(), nullptr};
  pid_t process = 0;
  posix_spawnp(&process, program.c_str(), nullptr, nullptr, arguments, environ);
}

void view_command(const ViewArguments& arguments) {
  const Project project = read_project(arguments.project);
  const auto picture = output_directory(project) / "topview.png";
  if (!std::filesystem::exists(picture)) {
    throw Error(fmt::format("{} is not there yet; `planum run {}` makes it", picture.string(),
                            project.file.string()));
  }
  fmt::print("{}\n", picture.string());
  if (!arguments.no_open && has_desktop()) open_on_desktop(picture.string());
}

}  // namespace

void add_view_command(CLI::App& app) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* command =
      app.add_subcommand("view", "print the path of the picture of the map, open it on a desktop");
  add_project_arguments(*command, arguments->project);
  command->add_flag("--no-open", arguments->no_open, "only print the path");
  command->callback([arguments] { view_command(*arguments); });
}

}  // namespace planum
