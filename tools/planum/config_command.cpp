#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/workflow/project_keys.hpp"

namespace planum {
namespace {

struct ConfigArguments {
  ProjectArguments project;
  bool origin = false;
  bool json = false;
};

std::string origin_of(const Key& key, const Project& project) {
  const auto given = project.origins.find(key.full_name());
  return given == project.origins.end() ? "default" : given->second;
}

void print_text(const Project& project, bool with_origin) {
  std::string section;
  for (const Key& key : project_keys()) {
    if (key.section != section) {
      fmt::print("{}[{}]\n", section.empty() ? "" : "\n", key.section);
      section = key.section;
    }
    const std::string value = value_text(key, project.settings);
    const std::string line = value.empty() ? fmt::format("# {} is not set", key.name)
                                           : fmt::format("{} = {}", key.name, value);
    if (with_origin) {
      fmt::print("{:<40}  # {}\n", line, origin_of(key, project));
    } else {
      fmt::print("{}\n", line);
    }
  }
}

void print_json(const Project& project) {
  auto json = nlohmann::ordered_json::object();
  for (const Key& key : project_keys()) {
    const std::string value = value_text(key, project.settings);
    json[key.full_name()] = {
        {"value", value.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json::parse(value)},
        {"origin", origin_of(key, project)}};
  }
  fmt::print("{}\n", json.dump(1));
}

}  // namespace

void add_config_command(CLI::App& app) {
  const auto arguments = std::make_shared<ConfigArguments>();
  CLI::App* command = app.add_subcommand("config", "every value of a project as it is used");
  add_project_arguments(*command, arguments->project);
  command->add_flag("--origin", arguments->origin, "say where each value comes from");
  command->add_flag("--json", arguments->json, "for programs, with origins");
  command->callback([arguments] {
    const Project project = read_project(arguments->project);
    if (arguments->json) {
      print_json(project);
    } else {
      print_text(project, arguments->origin);
    }
  });
}

}  // namespace planum
