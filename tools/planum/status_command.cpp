#include <fmt/format.h>

#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/state_table.hpp"

namespace planum {

void add_status_command(CLI::App& app) {
  struct Arguments {
    ProjectArguments project;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("status", "which stages are fresh, which are stale and why");
  add_project_arguments(*command, arguments->project);
  command->add_flag("--json", arguments->json, "for programs");
  command->callback([arguments] {
    const auto states = stage_states(read_project(arguments->project));
    fmt::print("{}", arguments->json ? states_json(states) : states_text(states));
  });
}

}  // namespace planum
