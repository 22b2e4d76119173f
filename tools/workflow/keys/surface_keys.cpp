#include <optional>

#include "tools/workflow/keys/keys.hpp"

namespace planum {
namespace {

using Optional = std::optional<double>;

}  // namespace

std::vector<Key> surface_keys() {
  return {
      {"cloud",
       "normal_cell_m",
       FIELD(double, normals.cell),
       {0.001, 10},
       {},
       "planes are fitted to the points in 3 x 3 x 3 cells of this edge"},
      {"cloud",
       "normal_levels",
       FIELD(int, normals.levels),
       {1, 10},
       {},
       "where points are few, cells double so many times less one"},
      {"cloud",
       "free_space_scans",
       FIELD(int, free_space.min_scans),
       {0, 1000},
       {},
       "points that so many scans look through, and twice as many as saw them, are no surface; "
       "0: all are"},
      {"mesh",
       "voxel_m",
       FIELD(double, surface.voxel),
       {0.001, 10},
       {},
       "edge of the grid's cells"},
      {"mesh",
       "smoothing_voxels",
       FIELD(double, surface.radius),
       {0, 10},
       {},
       "tangent planes are averaged this far along the surface"},
      {"polygons",
       "max_angle_deg",
       FIELD(Optional, polygons.max_angle),
       {1, 89},
       {},
       "between a plane and its triangles"},
      {"polygons",
       "max_distance_m",
       FIELD(Optional, polygons.max_distance),
       {0.0001, 10},
       {},
       "of triangles from their plane; not set: follows mesh.voxel_m"},
      {"polygons",
       "min_area_m2",
       FIELD(Optional, polygons.min_area),
       {0, 1000},
       {},
       "smaller planes stay triangles; not set: follows mesh.voxel_m"},
      {"polygons",
       "max_error_m",
       FIELD(Optional, polygons.max_error),
       {0, 10},
       {},
       "of simplified borders; not set: follows mesh.voxel_m"},
      {"polygons",
       "max_shadow_m2",
       FIELD(double, shadows.max_area),
       {0, 1000},
       {},
       "laser shadows in planes are filled, and marked as inferred, up to this size; 0: none"},
  };
}

}  // namespace planum
