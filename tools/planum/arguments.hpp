#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/workflow/project.hpp"

namespace CLI {
class App;
}

namespace planum {

/// What every command that works on a project takes.
struct ProjectArguments {
  std::filesystem::path file = "project.toml";
  std::vector<std::string> overrides;
};

/// PROJECT and --set.
void add_project_arguments(CLI::App& command, ProjectArguments& arguments);

/// --set for commands that have settings but no project; `example` is a key=value.
void add_overrides(CLI::App& command, std::vector<std::string>& overrides,
                   const std::string& example);

/// Reads what they name.
Project read_project(const ProjectArguments& arguments);

/// What every command that works for a while takes.
struct WorkArguments {
  int threads = 0;
  bool quiet = false;
};

/// --threads and --quiet.
void add_work_arguments(CLI::App& command, WorkArguments& arguments);

}  // namespace planum
