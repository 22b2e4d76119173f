#include "tools/workflow/manifest.hpp"

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"

namespace planum {
namespace {

nlohmann::json to_json(const std::map<std::string, Digest>& files) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [name, digest] : files) json[name] = to_string(digest);
  return json;
}

std::map<std::string, Digest> files_from(const nlohmann::json& json) {
  std::map<std::string, Digest> files;
  for (const auto& [name, digest] : json.items()) {
    files[name] = digest_from_string(digest.get<std::string>());
  }
  return files;
}

/// A long list of changed files is cut: "scan003.3d changed (and 4 more)".
std::string changed_files(const std::map<std::string, Digest>& before,
                          const std::map<std::string, Digest>& now) {
  std::vector<std::string> changes;
  for (const auto& [name, digest] : now) {
    const auto old = before.find(name);
    if (old == before.end()) {
      changes.push_back(name + " is new");
    } else if (old->second != digest) {
      changes.push_back(name + (digest == Digest{} ? " is gone" : " changed"));
    }
  }
  for (const auto& [name, digest] : before) {
    if (!now.contains(name)) changes.push_back(name + " is gone");
  }
  if (changes.empty()) return "";
  const std::size_t more = changes.size() - 1;
  return changes.front() + (more ? fmt::format(" (and {} more)", more) : "");
}

}  // namespace

std::optional<Manifest> read_manifest(const std::filesystem::path& path) {
  std::ifstream stream(path);
  if (!stream) return std::nullopt;
  try {
    const nlohmann::json json = nlohmann::json::parse(stream);
    return Manifest{json.at("version"),
                    json.at("parameters").get<std::map<std::string, std::string>>(),
                    files_from(json.at("inputs")),
                    files_from(json.at("outputs")),
                    json.at("units").get<std::vector<std::string>>(),
                    json.at("seconds"),
                    json.at("peak_memory_mb"),
                    json.at("summary"),
                    json.at("warnings").get<std::vector<std::string>>(),
                    json.at("shortcomings").get<std::vector<std::string>>()};
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void write_manifest(const std::filesystem::path& path, const Manifest& manifest) {
  const nlohmann::json json = {{"version", manifest.version},
                               {"parameters", manifest.parameters},
                               {"inputs", to_json(manifest.inputs)},
                               {"outputs", to_json(manifest.outputs)},
                               {"units", manifest.units},
                               {"seconds", manifest.seconds},
                               {"peak_memory_mb", manifest.peak_memory_mb},
                               {"summary", manifest.summary},
                               {"warnings", manifest.warnings},
                               {"shortcomings", manifest.shortcomings}};
  write_file_atomically(path, json.dump(1) + "\n");
}

std::string first_difference(const Manifest& recorded, const Manifest& current) {
  if (recorded.version != current.version) {
    return fmt::format("planum does this differently now (version {} -> {})", recorded.version,
                       current.version);
  }
  for (const auto& [name, value] : current.parameters) {
    const auto old = recorded.parameters.find(name);
    if (old == recorded.parameters.end()) return fmt::format("parameter {} is new", name);
    if (old->second != value) {
      const auto shown = [](const std::string& text) { return text.empty() ? "(unset)" : text; };
      return fmt::format("parameter {} changed {} -> {}", name, shown(old->second), shown(value));
    }
  }
  for (const auto& [name, value] : recorded.parameters) {
    if (!current.parameters.contains(name)) return fmt::format("parameter {} is gone", name);
  }
  return changed_files(recorded.inputs, current.inputs);
}

}  // namespace planum
