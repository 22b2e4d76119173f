#pragma once

#include <string>
#include <vector>

#include "tools/workflow/freshness.hpp"

namespace planum {

/// One line a stage: fresh, or stale and why.
std::string states_text(const std::vector<StageState>& states);

/// The same as JSON: [{"stage": "mesh", "fresh": false, "reason": "..."}].
std::string states_json(const std::vector<StageState>& states);

}  // namespace planum
