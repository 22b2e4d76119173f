#include "tools/workflow/stage.hpp"

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "tools/workflow/nearest_name.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {

const std::vector<Stage>& stages() {
  static const std::vector<Stage> all = {import_stage(), register_stage(), relax_stage(),
                                         cloud_stage(),  mesh_stage(),     polygons_stage(),
                                         labels_stage(), maps_stage(),     report_stage()};
  return all;
}

std::size_t stage_index(const std::string& name) {
  std::vector<std::string> names;
  for (const Stage& stage : stages()) {
    if (stage.name == name) return names.size();
    names.push_back(stage.name);
  }
  const auto near = nearest_name(name, names);
  throw Error(
      fmt::format("unknown stage '{}'{}; the stages are {}", name,
                  near ? fmt::format(", did you mean '{}'?", *near) : "", fmt::join(names, " ")),
      ErrorKind::usage);
}

}  // namespace planum
