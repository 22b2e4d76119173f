#include "tools/workflow/freshness.hpp"

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "tools/workflow/project_keys.hpp"

namespace planum {
namespace {

std::map<std::string, std::string> parameters_of(const Stage& stage, const Project& project) {
  std::map<std::string, std::string> parameters;
  for (const Key& key : project_keys()) {
    for (const std::string& name : stage.parameters) {
      if (name == key.section || name == key.full_name()) {
        parameters[key.full_name()] = value_text(key, project.settings);
      }
    }
  }
  return parameters;
}

/// One digest for everything a stage has made.
Digest result_digest(const Manifest& manifest) {
  Hasher hasher;
  for (const auto& [name, digest] : manifest.outputs) hasher.text(name).digest(digest);
  return hasher.result();
}

/// A path as a person would name it: relative to the project where that is shorter.
std::string shown_path(const std::filesystem::path& path, const Project& project) {
  const std::string relative = path.lexically_relative(project.directory).string();
  return relative.empty() || relative.starts_with("../..") ? path.string() : relative;
}

}  // namespace

Manifest wanted_manifest(const Stage& stage, const Project& project,
                         const std::map<std::string, Manifest>& before, FileDigests& digests) {
  Manifest wanted;
  wanted.version = stage.version;
  wanted.parameters = parameters_of(stage, project);
  for (const std::string& need : stage.needs) {
    const auto made = before.find(need);
    if (made != before.end()) wanted.inputs["the result of " + need] = result_digest(made->second);
  }
  if (stage.input_files) {
    for (const auto& path : stage.input_files(project)) {
      wanted.inputs[shown_path(path, project)] = digests.of(path);
    }
  }
  return wanted;
}

std::string why_stale(const std::optional<Manifest>& recorded, const Manifest& wanted,
                      const std::filesystem::path& output, FileDigests& digests) {
  if (!recorded) return "never run";
  const std::string difference = first_difference(*recorded, wanted);
  if (!difference.empty()) return difference;
  for (const auto& [name, digest] : recorded->outputs) {
    const Digest now = digests.of_if_there(output / name);
    if (now == Digest{}) return fmt::format("its output {} is gone", name);
    if (now != digest) return fmt::format("its output {} was changed", name);
  }
  for (const std::string& name : recorded->units) {
    if (!std::filesystem::exists(output / name)) return fmt::format("its output {} is gone", name);
  }
  return "";
}

std::vector<StageState> stage_states(const Project& project) {
  const CacheLayout layout{output_directory(project)};
  FileDigests digests(layout.digests());
  std::map<std::string, Manifest> before;
  std::map<std::string, bool> stale;
  std::vector<StageState> states;
  for (const Stage& stage : stages()) {
    const auto recorded = read_manifest(layout.manifest(stage.name));
    StageState state{stage.name, "", recorded ? recorded->summary : ""};
    const Manifest wanted = wanted_manifest(stage, project, before, digests);
    state.stale_because = why_stale(recorded, wanted, layout.output, digests);
    for (const std::string& need : stage.needs) {
      if (state.stale_because.empty() && stale[need]) state.stale_because = "follows " + need;
    }
    stale[stage.name] = !state.stale_because.empty();
    if (recorded) before[stage.name] = *recorded;
    states.push_back(std::move(state));
  }
  return states;
}

}  // namespace planum
