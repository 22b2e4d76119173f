#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/workflow/map_files.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {
namespace {

void work(StageContext& context) {
  Results& results = context.results;
  const std::vector<Eigen::Vector3d> origins = scan_origins(results.world.get());
  const MapFiles files = write_map_files(context.staging,
                                         {.cloud = results.cloud.get(),
                                          .origins = origins,
                                          .scan_numbers = results.world.get().numbers,
                                          .mesh = results.mesh.get(),
                                          .polygons = results.polygons.get(),
                                          .labelled = results.labelled.get()},
                                         context.project.settings);
  context.record.warnings.insert(context.record.warnings.end(), files.warnings.begin(),
                                 files.warnings.end());
  context.record.summary = fmt::format("{}", fmt::join(files.written, ", "));
}

}  // namespace

Stage maps_stage() {
  return {.name = "maps",
          .version = 7,
          .unit = "steps",
          .needs = {"cloud", "mesh", "polygons", "labels"},
          .parameters = {"maps"},
          .input_files = {},
          .work = work};
}

}  // namespace planum
