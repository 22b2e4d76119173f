#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/workflow/cache_layout.hpp"
#include "tools/workflow/file_digests.hpp"
#include "tools/workflow/stage.hpp"

namespace planum {

/// What a stage is asked for: version, parameters and inputs, without results. `before` are the
/// manifests of the stages before it.
Manifest wanted_manifest(const Stage& stage, const Project& project,
                         const std::map<std::string, Manifest>& before, FileDigests& digests);

/// Why the stage must be done, in words; empty if what is there is what is wanted.
std::string why_stale(const std::optional<Manifest>& recorded, const Manifest& wanted,
                      const std::filesystem::path& output, FileDigests& digests);

/// A stage as `planum status` and `--dry-run` show it.
struct StageState {
  std::string stage;
  std::string stale_because;  ///< empty: fresh
  std::string summary;        ///< of what is there, if anything
};

/// Looks at every stage without doing or writing anything.
std::vector<StageState> stage_states(const Project& project);

}  // namespace planum
