#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/workflow/digest.hpp"

namespace planum {

/// What a stage was made from and what it made: the record by which it is fresh or stale.
struct Manifest {
  int version = 0;                                ///< of the stage's code
  std::map<std::string, std::string> parameters;  ///< full key -> value as in the project file
  std::map<std::string, Digest> inputs;           ///< files, as they are named to people
  std::map<std::string, Digest> outputs;          ///< files, relative to the output directory
  std::vector<std::string> units;                 ///< files that must exist, relative likewise
  double seconds = 0;                             ///< that the work took
  double peak_memory_mb = 0;
  std::string summary;  ///< one line for people
  std::vector<std::string> warnings;
  std::vector<std::string> shortcomings;  ///< why the result is less than was asked for
};

/// Nothing if there is none or if it cannot be understood (then the stage is done again).
std::optional<Manifest> read_manifest(const std::filesystem::path& path);

void write_manifest(const std::filesystem::path& path, const Manifest& manifest);

/// Why a result with the manifest `recorded` is not what `current` asks for (versions, parameters,
/// inputs; outputs are not compared): "parameter mesh.voxel_m changed 0.05 -> 0.1". Empty: nothing.
std::string first_difference(const Manifest& recorded, const Manifest& current);

}  // namespace planum
