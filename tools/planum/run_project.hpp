#pragma once

#include "tools/planum/console.hpp"
#include "tools/workflow/run.hpp"

namespace planum {

/// Runs a project and says on the console what is being done.
RunSummary run_project(const Project& project, const RunOptions& options, Console& console);

/// What came out and where it is, in a few lines.
std::string results_text(const Project& project);

/// Throws Error(no_result) if the result is less than was asked for.
void throw_shortcomings(const RunSummary& summary);

}  // namespace planum
