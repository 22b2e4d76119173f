#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "slam/core/progress.hpp"
#include "tools/workflow/manifest.hpp"
#include "tools/workflow/project.hpp"
#include "tools/workflow/unit_cache.hpp"

namespace planum {

class Results;

/// What a stage works with while it runs.
struct StageContext {
  const Project& project;
  Results& results;               ///< of the stages before; the stage sets its own
  std::filesystem::path staging;  ///< files written here appear in the output directory at the end
  std::filesystem::path result;   ///< where in `staging` a result that only we read belongs
  UnitCache& units;               ///< finished parts of an interrupted run
  Progress progress;
  Manifest& record;  ///< the stage adds summary, warnings, shortcomings
  const std::map<std::string, Manifest>& finished;  ///< the stages before, by name
  const std::vector<std::string>& redone;           ///< names of those that were done in this run
};

/// One box of the pipeline: a function of its inputs, its parameters and nothing else.
struct Stage {
  std::string name;
  int version = 1;                 ///< grows when the code gives other results from the same inputs
  std::string unit;                ///< what its progress counts: "scans"
  std::vector<std::string> needs;  ///< earlier stages whose results it reads
  std::vector<std::string> parameters;  ///< tables ("mesh") and keys ("mesh.voxel_m") it reads
  std::function<std::vector<std::filesystem::path>(const Project&)> input_files;  ///< from outside
  std::function<void(StageContext&)> work;
};

/// import register relax cloud mesh polygons labels maps report
const std::vector<Stage>& stages();

/// The position of a stage in stages(); throws Error(usage) naming the nearest one.
std::size_t stage_index(const std::string& name);

}  // namespace planum
