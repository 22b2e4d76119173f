#include "tools/workflow/project.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wshadow"
#include <toml++/toml.h>
#pragma GCC diagnostic pop

#include "slam/core/error.hpp"
#include "tools/workflow/nearest_name.hpp"
#include "tools/workflow/project_keys.hpp"

namespace planum {
namespace {

/// "project.toml:7:3"
std::string place(const std::filesystem::path& file, const toml::source_region& source) {
  return fmt::format("{}:{}:{}", file.string(), source.begin.line, source.begin.column);
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf())) {
    const bool there = std::filesystem::exists(file);
    throw Error(fmt::format("{}: {}", file.string(),
                            there ? "cannot read the project file"
                                  : "no such project file; `planum init SCAN_DIR` writes one"));
  }
  return text.str();
}

toml::table parse(const std::string& text, const std::filesystem::path& file) {
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    throw Error(place(file, error.source()) + ": " + std::string(error.description()));
  }
}

/// Nothing for kinds of values that no key has (dates, lists, tables).
std::optional<ProjectValue> project_value(const toml::node& node) {
  if (const auto* value = node.as_boolean()) return value->get();
  if (const auto* value = node.as_integer()) return value->get();
  if (const auto* value = node.as_floating_point()) return value->get();
  if (const auto* value = node.as_string()) return value->get();
  return std::nullopt;
}

std::string unknown_section(const std::string& name) {
  std::vector<std::string> names;
  for (const Section& section : project_sections()) names.push_back(section.name);
  const auto near = nearest_name(name, names);
  return fmt::format("unknown table [{}]{}", name,
                     near ? fmt::format("; did you mean [{}]?", *near) : "");
}

bool is_section(const std::string& name) {
  const auto& all = project_sections();
  return std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
}

/// Entries of a table in the order of the file, so that the first mistake is the one reported.
std::vector<std::pair<toml::key, const toml::node*>> in_file_order(const toml::table& table) {
  std::vector<std::pair<toml::key, const toml::node*>> entries;
  for (const auto& [key, node] : table) entries.emplace_back(key, &node);
  const auto line = [](const auto& entry) {
    return std::pair(entry.first.source().begin.line, entry.first.source().begin.column);
  };
  std::stable_sort(entries.begin(), entries.end(),
                   [&](const auto& a, const auto& b) { return line(a) < line(b); });
  return entries;
}

void read_key(const std::string& section, const toml::key& name, const toml::node& node,
              Project& project) {
  const Key* key = find_key(section + "." + std::string(name.str()));
  if (!key) {
    throw Error(fmt::format("{}: unknown key '{}' in [{}]; {}", place(project.file, name.source()),
                            name.str(), section, suggestion(section, std::string(name.str()))));
  }
  try {
    const auto value = project_value(node);
    if (!value) throw Error(fmt::format("{} must be {}", key->full_name(), type_name(*key)));
    assign(*key, *value, project.settings);
  } catch (Error& error) {
    error.add_context(place(project.file, node.source()));
    throw;
  }
  project.origins[key->full_name()] =
      fmt::format("{}:{}", project.file.filename().string(), name.source().begin.line);
}

void check_version(const toml::key& name, const toml::node& node, const Project& project) {
  const auto* version = node.as_integer();
  if (!version || version->get() < 1) {
    throw Error(place(project.file, node.source()) + ": version must be a whole number from 1 on");
  }
  if (version->get() > project_version) {
    throw Error(
        fmt::format("{}: this file has version {}, this program knows versions up to {}; "
                    "use a newer planum",
                    place(project.file, name.source()), version->get(), project_version));
  }
}

void read_top_level(const toml::key& name, const toml::node& node, Project& project) {
  const std::string text(name.str());
  if (text == "version") return check_version(name, node, project);
  if (!is_section(text)) {
    if (node.is_table()) {
      throw Error(place(project.file, name.source()) + ": " + unknown_section(text));
    }
    std::string home;
    for (const Key& key : project_keys()) {
      if (key.name == text) home = fmt::format("; it belongs under [{}]", key.section);
    }
    throw Error(fmt::format("{}: unknown key '{}' outside of any table{}",
                            place(project.file, name.source()), text, home));
  }
  const auto* table = node.as_table();
  if (!table) {
    throw Error(fmt::format("{}: '{}' must be a table: [{}]", place(project.file, name.source()),
                            text, text));
  }
  for (const auto& [key, value] : in_file_order(*table)) read_key(text, key, *value, project);
}

/// The right side of --set: TOML, or for texts and choices just the text.
ProjectValue override_value(const Key& key, const std::string& text) {
  if (std::holds_alternative<std::string& (*)(Settings&)>(key.field) && !text.starts_with('"') &&
      !text.starts_with('\'')) {
    return text;
  }
  try {
    const toml::table table = toml::parse("value = " + text);
    if (const auto value = project_value(*table.get("value"))) return *value;
  } catch (const toml::parse_error&) {
  }
  return text;
}

void apply_override(const std::string& text, Project& project) {
  const auto equals = text.find('=');
  const std::string name = text.substr(0, equals);
  if (equals == std::string::npos) {
    throw Error(fmt::format("--set {}: expected key=value, e.g. --set mesh.voxel_m=0.1", text),
                ErrorKind::usage);
  }
  const Key* key = find_key(name);
  if (!key) {
    const auto dot = name.find('.');
    const std::string section = name.substr(0, dot);
    if (dot == std::string::npos) {
      throw Error(fmt::format("--set {}: a key is table.name, e.g. mesh.voxel_m", text),
                  ErrorKind::usage);
    }
    if (!is_section(section)) {
      throw Error(fmt::format("--set {}: {}", text, unknown_section(section)), ErrorKind::usage);
    }
    throw Error(fmt::format("--set {}: unknown key '{}' in [{}]; {}", text, name.substr(dot + 1),
                            section, suggestion(section, name.substr(dot + 1))),
                ErrorKind::usage);
  }
  try {
    assign(*key, override_value(*key, text.substr(equals + 1)), project.settings);
  } catch (const Error& error) {
    throw Error(fmt::format("--set {}: {}", text, error.what()), ErrorKind::usage);
  }
  project.origins[name] = "--set";
}

}  // namespace

Settings default_settings(const std::vector<std::string>& overrides) {
  Project project;
  for (const std::string& text : overrides) apply_override(text, project);
  return project.settings;
}

Project read_project(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Project project;
  project.file = std::filesystem::is_directory(file) ? file / "project.toml" : file;
  project.directory = std::filesystem::absolute(project.file).lexically_normal().parent_path();
  const toml::table table = parse(read_text(project.file), project.file);
  for (const auto& [name, node] : in_file_order(table)) read_top_level(name, *node, project);
  for (const std::string& text : overrides) apply_override(text, project);
  if (project.settings.scan_directory.empty()) {
    throw Error(fmt::format("{}: the key 'directory' in [scans] is missing: where are the scans?",
                            project.file.string()));
  }
  return project;
}

std::filesystem::path resolved(const Project& project, const std::string& path) {
  return (project.directory / path).lexically_normal();
}

std::filesystem::path output_directory(const Project& project) {
  return resolved(project, project.settings.output_directory);
}

}  // namespace planum
