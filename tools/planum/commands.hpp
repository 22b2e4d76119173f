#pragma once

namespace CLI {
class App;
}

/// The subcommands, one file each.
namespace planum {

void add_check_command(CLI::App& app);
void add_config_command(CLI::App& app);
void add_convert_command(CLI::App& app);
void add_demo_command(CLI::App& app);
void add_evaluate_command(CLI::App& app);
void add_init_command(CLI::App& app);
void add_optimize_command(CLI::App& app);
void add_polygonize_command(CLI::App& app);
void add_register_command(CLI::App& app);
void add_run_command(CLI::App& app);
void add_simulate_command(CLI::App& app);
void add_status_command(CLI::App& app);
void add_view_command(CLI::App& app);

}  // namespace planum
