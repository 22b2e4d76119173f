#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"
#include "tools/workflow/nearest_name.hpp"
#include "tools/workflow/project_keys.hpp"

namespace planum {
namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

bool in_degrees(const Key& key) { return key.name.ends_with("_deg"); }

std::string number_text(double value) { return fmt::format("{:.10g}", value); }

/// A float such as 0.05f is written 0.05, not 0.0500000007.
template <class Number>
std::string real_text(const Key& key, Number value) {
  if (in_degrees(key)) return fmt::format("{:.6g}", degrees(static_cast<double>(value)));
  return fmt::format("{}", value);
}

std::string type_of(const ProjectValue& value) {
  constexpr const char* names[] = {"true or false", "a whole number", "a number", "a text"};
  return names[value.index()];
}

std::string text_of(const ProjectValue& value) {
  return std::visit(Overloaded{[](bool v) { return std::string(v ? "true" : "false"); },
                               [](std::int64_t v) { return std::to_string(v); },
                               [](double v) { return number_text(v); },
                               [](const std::string& v) { return quoted_toml(v); }},
                    value);
}

[[noreturn]] void throw_wrong_type(const Key& key, const ProjectValue& value) {
  throw Error(fmt::format("{} must be {}, not {} ({})", key.full_name(), type_name(key),
                          type_of(value), text_of(value)));
}

double checked_number(const Key& key, const ProjectValue& value) {
  double number = 0;
  if (const auto* real = std::get_if<double>(&value)) {
    number = *real;
  } else if (const auto* whole = std::get_if<std::int64_t>(&value)) {
    number = static_cast<double>(*whole);
  } else {
    throw_wrong_type(key, value);
  }
  if (!(number >= key.range.min && number <= key.range.max)) {
    throw Error(fmt::format("{} = {} is out of range, allowed: {}", key.full_name(), text_of(value),
                            allowed_values(key)));
  }
  return number;
}

double checked_real(const Key& key, const ProjectValue& value) {
  const double number = checked_number(key, value);
  return in_degrees(key) ? radians(number) : number;
}

std::int64_t checked_whole(const Key& key, const ProjectValue& value) {
  if (!std::holds_alternative<std::int64_t>(value)) throw_wrong_type(key, value);
  return static_cast<std::int64_t>(checked_number(key, value));
}

const std::string& checked_string(const Key& key, const ProjectValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  if (!text) throw_wrong_type(key, value);
  const bool allowed = key.choices.empty() || std::find(key.choices.begin(), key.choices.end(),
                                                        *text) != key.choices.end();
  if (!allowed) {
    const auto near = nearest_name(*text, key.choices);
    throw Error(fmt::format("{} = \"{}\" is unknown, allowed: {}{}", key.full_name(), *text,
                            allowed_values(key),
                            near ? fmt::format("; did you mean \"{}\"?", *near) : ""));
  }
  return *text;
}

/// "voxel" of "voxel_m", for the units that people write.
std::string_view without_unit(std::string_view name) {
  const auto bar = name.rfind('_');
  if (bar == std::string_view::npos) return name;
  static const std::vector<std::string_view> units = {"m",  "cm",  "mm", "deg", "rad", "s",
                                                      "ms", "pct", "m2", "km",  "in",  "ft"};
  const bool is_unit = std::find(units.begin(), units.end(), name.substr(bar + 1)) != units.end();
  return is_unit ? name.substr(0, bar) : name;
}

}  // namespace

std::string type_name(const Key& key) {
  return std::visit(Overloaded{[](bool& (*)(Settings&)) { return "true or false"; },
                               [](int& (*)(Settings&)) { return "a whole number"; },
                               [](std::size_t& (*)(Settings&)) { return "a whole number"; },
                               [](std::string& (*)(Settings&)) { return "a text in quotes"; },
                               [](auto) { return "a number"; }},
                    key.field);
}

std::optional<std::string> unit_name(std::string_view key_name) {
  static const std::vector<std::pair<std::string_view, std::string>> units = {
      {"_m", "metres"}, {"_deg", "degrees"}, {"_s", "seconds"}, {"_m2", "square metres"}};
  for (const auto& [ending, unit] : units) {
    if (key_name.ends_with(ending)) return unit;
  }
  return std::nullopt;
}

std::string quoted_toml(std::string_view text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  return quoted + '"';
}

std::string value_text(const Key& key, const Settings& settings) {
  Settings copy = settings;
  return std::visit(
      [&](auto field) -> std::string {
        const auto& value = field(copy);
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, bool>) {
          return value ? "true" : "false";
        } else if constexpr (std::is_same_v<Value, std::string>) {
          return quoted_toml(value);
        } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
          return value ? real_text(key, *value) : "";
        } else if constexpr (std::is_floating_point_v<Value>) {
          return real_text(key, value);
        } else {
          return std::to_string(value);
        }
      },
      key.field);
}

std::string allowed_values(const Key& key) {
  if (!key.choices.empty()) {
    std::string all;
    for (std::size_t i = 0; i < key.choices.size(); ++i) {
      const char* join = i == 0 ? "" : i + 1 == key.choices.size() ? " or " : ", ";
      all += fmt::format("{}\"{}\"", join, key.choices[i]);
    }
    return all;
  }
  const bool from = std::isfinite(key.range.min), to = std::isfinite(key.range.max);
  if (from && to) return number_text(key.range.min) + " to " + number_text(key.range.max);
  if (from) return number_text(key.range.min) + " or more";
  if (to) return number_text(key.range.max) + " or less";
  return "";
}

void assign(const Key& key, const ProjectValue& value, Settings& settings) {
  std::visit(
      [&](auto field) {
        auto& place = field(settings);
        using Value = std::decay_t<decltype(place)>;
        if constexpr (std::is_same_v<Value, bool>) {
          if (!std::holds_alternative<bool>(value)) throw_wrong_type(key, value);
          place = std::get<bool>(value);
        } else if constexpr (std::is_same_v<Value, std::string>) {
          place = checked_string(key, value);
        } else if constexpr (std::is_integral_v<Value>) {
          place = static_cast<Value>(checked_whole(key, value));
        } else if constexpr (std::is_same_v<Value, float>) {
          place = static_cast<float>(checked_real(key, value));
        } else {
          place = checked_real(key, value);
        }
      },
      key.field);
}

std::string suggestion(const std::string& section, const std::string& name) {
  std::vector<std::string> here;
  const Key* elsewhere = nullptr;
  for (const Key& key : project_keys()) {
    if (key.section == section) here.push_back(key.name);
    if (key.section != section && key.name == name) elsewhere = &key;
  }
  const auto same_stem = std::find_if(here.begin(), here.end(), [&](const std::string& known) {
    return without_unit(known) == without_unit(name);
  });
  if (same_stem != here.end()) {
    const auto unit = unit_name(*same_stem);
    return fmt::format("did you mean '{}'?{}", *same_stem,
                       unit ? " It takes " + *unit + "." : std::string());
  }
  if (elsewhere) {
    return fmt::format("there is a key of that name in [{}]", elsewhere->section);
  }
  if (const auto near = nearest_name(name, here)) return fmt::format("did you mean '{}'?", *near);
  if (here.empty()) return fmt::format("[{}] has no keys", section);
  std::string all;
  for (const std::string& known : here) all += (all.empty() ? "" : ", ") + known;
  return fmt::format("known keys are {}", all);
}

const Key* find_key(std::string_view full_name) {
  for (const Key& key : project_keys()) {
    if (key.full_name() == full_name) return &key;
  }
  return nullptr;
}

}  // namespace planum
