#include "tools/planum/arguments.hpp"

#include "tools/planum/cli11.hpp"

namespace planum {

void add_overrides(CLI::App& command, std::vector<std::string>& overrides,
                   const std::string& example) {
  command
      .add_option("--set", overrides,
                  "replaces a value of the project file, e.g. --set " + example + "; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_project_arguments(CLI::App& command, ProjectArguments& arguments) {
  command.add_option("PROJECT", arguments.file, "project file, or the directory of project.toml")
      ->capture_default_str();
  add_overrides(command, arguments.overrides, "mesh.voxel_m=0.1");
}

Project read_project(const ProjectArguments& arguments) {
  return read_project(arguments.file, arguments.overrides);
}

void add_work_arguments(CLI::App& command, WorkArguments& arguments) {
  command.add_option("--threads", arguments.threads, "0: as many as the machine has")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command.add_flag("-q,--quiet", arguments.quiet, "only warnings and errors on stderr");
}

}  // namespace planum
