#include <algorithm>

#include <fmt/format.h>

#include "tools/workflow/project.hpp"
#include "tools/workflow/project_keys.hpp"

namespace planum {
namespace {

constexpr int value_column = 36;

/// `voxel_m = 0.05            # edge of a cell of the grid; 0.01 to 1`
std::string key_line(const Key& key, const std::string& value, bool given) {
  const std::string setting =
      fmt::format("{}{} = {}", given ? "" : "#", key.name, value.empty() ? "..." : value);
  const std::string allowed = allowed_values(key);
  return fmt::format("{:<{}}  # {}{}\n", setting, value_column, key.help,
                     allowed.empty() ? "" : "; " + allowed);
}

bool has_keys(const Section& section) {
  const auto& keys = project_keys();
  return std::any_of(keys.begin(), keys.end(),
                     [&](const Key& key) { return key.section == section.name; });
}

}  // namespace

std::string project_template(const std::map<std::string, std::string>& values) {
  std::string text =
      "# A planum project. `planum run` on this file makes the map, `planum check` only looks.\n"
      "# A key behind # shows its default (... is: not set); remove the # to change it.\n"
      "# Paths start at this file.\n"
      "\n";
  text += fmt::format("version = {}\n", project_version);
  const Settings defaults;
  for (const Section& section : project_sections()) {
    if (!has_keys(section)) continue;
    text += fmt::format("\n[{}]{:{}}  # {}\n", section.name, "",
                        value_column - static_cast<int>(section.name.size()) - 2, section.help);
    for (const Key& key : project_keys()) {
      if (key.section != section.name) continue;
      const auto given = values.find(key.full_name());
      const std::string fallback = value_text(key, defaults);
      text += given == values.end() ? key_line(key, fallback, false)
                                    : key_line(key, given->second, true);
    }
  }
  return text;
}

}  // namespace planum
