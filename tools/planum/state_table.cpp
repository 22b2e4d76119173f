#include "tools/planum/state_table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace planum {

std::string states_text(const std::vector<StageState>& states) {
  std::string text;
  for (const StageState& state : states) {
    const bool fresh = state.stale_because.empty();
    text += fmt::format("{:<9} {}  {}\n", state.stage, fresh ? "fresh" : "stale",
                        fresh ? state.summary : state.stale_because);
  }
  return text;
}

std::string states_json(const std::vector<StageState>& states) {
  auto json = nlohmann::ordered_json::array();
  for (const StageState& state : states) {
    json.push_back({{"stage", state.stage},
                    {"fresh", state.stale_because.empty()},
                    {"reason", state.stale_because}});
  }
  return json.dump(1) + "\n";
}

}  // namespace planum
