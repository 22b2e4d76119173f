#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slam/core/cloud.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/core/triangle_mesh.hpp"
#include "slam/evaluation/surface_comparison.hpp"

namespace planum {

/// A map in its world.
struct MapSurfaces {
  TriangleMesh mesh;        ///< the polygon map; may be empty
  Cloud cloud;              ///< `scan` counts the poses
  std::vector<Pose> poses;  ///< world_from_scan
};

struct ModelComparisonParams {
  std::size_t samples = 100'000;     ///< places on each surface that are looked at
  double within = 0.02;              ///< m, of the shares
  double beam_angle = radians(1.5);  ///< rad, a place is looked at if a beam passes this near to it
  double max_incidence = radians(80);  ///< rad, surfaces that are seen more obliquely are not seen
};

struct ModelComparison {
  Pose model_from_map = Pose::Identity();
  std::optional<SurfaceFit> fit;  ///< if the map was laid onto the model by its points
  std::optional<SurfaceDistances> map_to_model;  ///< accuracy of the polygon map
  SurfaceDistances cloud_to_model;               ///< accuracy of the points
  std::size_t samples = 0, seen = 0;  ///< places of the model; those that some scan has seen
  std::optional<SurfaceDistances> model_to_map;  ///< completeness: of the seen places
  SurfaceDistances model_to_cloud;               ///< the same, to the nearest point
};

/// Compares a map with the model of the building. Where `model_from_map` is not given, the map is
/// laid onto the model by its points (place_on_surface). A place of the model has
/// been seen if a scan has a free line of sight to it in the model, not too oblique, and a beam of
/// it that came back passes by. Throws Error if there are no points, or they are nowhere near the
/// model.
ModelComparison compare_with_model(const MapSurfaces& map, const TriangleMesh& model,
                                   const std::optional<Pose>& model_from_map,
                                   const ModelComparisonParams& params = {});

}  // namespace planum
