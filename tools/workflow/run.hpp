#pragma once

#include <functional>
#include <string>
#include <vector>

#include "slam/core/progress.hpp"
#include "tools/workflow/freshness.hpp"
#include "tools/workflow/manifest.hpp"
#include "tools/workflow/project.hpp"
#include "tools/workflow/stage.hpp"

namespace planum {

/// Which stages a run brings up to date. Stages before `from` are used as they are.
struct RunOptions {
  std::string from = "import";
  std::string until = "report";
  bool force = false;  ///< redo them even if they are fresh, with all their parts
};

/// What a run tells whoever started it; every function may be missing.
struct RunListener {
  std::function<void(const Stage&, const std::string& reason)> started;
  std::function<Progress(const Stage&)> progress;
  std::function<void(const Stage&, const Manifest&)> finished;
  std::function<void(const Stage&, const Manifest&)> fresh;                 ///< nothing to do
  std::function<void(const Stage&, const std::string& reason)> used_stale;  ///< before `from`
};

/// What came of a run.
struct RunSummary {
  std::vector<std::string> redone;        ///< names of the stages that were done
  std::vector<std::string> shortcomings;  ///< why the result is less than was asked for
};

/// Brings the stages of a project up to date, in order. Throws Error with the stage as context; all
/// results that were there before are then still there.
RunSummary run(const Project& project, const RunOptions& options = {},
               const RunListener& listener = {});

/// What a run would do, for the stages it would look at; does and writes nothing.
std::vector<StageState> dry_run(const Project& project, const RunOptions& options = {});

}  // namespace planum
