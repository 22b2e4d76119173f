#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tools/workflow/settings.hpp"

namespace planum {

/// A value as it is written in a project file or after --set.
using ProjectValue = std::variant<bool, std::int64_t, double, std::string>;

/// Where in Settings the value of a key lives; its type is the type of the key.
using Field = std::variant<bool& (*)(Settings&), int& (*)(Settings&), std::size_t& (*)(Settings&),
                           float& (*)(Settings&), double& (*)(Settings&),
                           std::optional<double>& (*)(Settings&), std::string& (*)(Settings&)>;

/// The allowed numbers of a key, in the unit of its name.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// One key of the project file. Its default is what a default-constructed Settings holds. A name
/// that ends in `_deg` is kept in radians; all other numbers are kept as they are written.
struct Key {
  std::string section;  ///< "mesh"
  std::string name;     ///< "voxel_m"
  Field field;
  Range range = {};                  ///< of numbers
  std::vector<std::string> choices;  ///< of strings; empty: any text
  std::string help;                  ///< one line

  std::string full_name() const { return section + "." + name; }
};

/// One table of the project file.
struct Section {
  std::string name;
  std::string help;
};

/// All tables and all keys, in the order of the file.
const std::vector<Section>& project_sections();
const std::vector<Key>& project_keys();

/// The key "mesh.voxel_m", or nothing.
const Key* find_key(std::string_view full_name);

/// "a number", "a whole number", "true or false", "a text".
std::string type_name(const Key& key);

/// The unit that the end of a name stands for, in words ("metres"), or nothing.
std::optional<std::string> unit_name(std::string_view key_name);

/// The value of a key as it would be written in the file, e.g. `0.05` or `"auto"`; empty for an
/// optional value that is not set.
std::string value_text(const Key& key, const Settings& settings);

/// The allowed values in words, e.g. `0.01 to 1`, `"a" or "b"`; empty if any value is allowed.
std::string allowed_values(const Key& key);

/// Writes a value into its place; throws Error saying what is wrong with it (type, range, choice).
void assign(const Key& key, const ProjectValue& value, Settings& settings);

/// A text as TOML: in quotes, with what must be escaped.
std::string quoted_toml(std::string_view text);

/// For an unknown key: what was probably meant, e.g. `did you mean 'voxel_m'? It takes metres.`
std::string suggestion(const std::string& section, const std::string& name);

}  // namespace planum
