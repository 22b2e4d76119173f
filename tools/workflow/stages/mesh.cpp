#include <fmt/format.h>

#include "meshing/surface.hpp"
#include "slam/io/ply.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {
namespace {

void work(StageContext& context) {
  TriangleMesh mesh =
      reconstruct(context.results.cloud.get(), context.project.settings.surface, context.progress);
  write_ply(context.staging / "mesh.ply", mesh);
  context.record.summary =
      fmt::format("{} triangles, {} vertices", mesh.triangles.size(), mesh.vertices.size());
  context.results.mesh.set(std::move(mesh));
}

}  // namespace

Stage mesh_stage() {
  return {.name = "mesh",
          .version = 3,
          .unit = "steps",
          .needs = {"cloud"},
          .parameters = {"mesh"},
          .input_files = {},
          .work = work};
}

}  // namespace planum
