#include "tools/planum/model_comparison.hpp"

#include <algorithm>
#include <cmath>

#include "slam/core/error.hpp"
#include "slam/core/kd_tree.hpp"
#include "slam/core/parallel.hpp"
#include "slam/evaluation/sampling.hpp"
#include "slam/evaluation/surface_placement.hpp"
#include "slam/sensor/ray_caster.hpp"

namespace planum {
namespace {

/// m, a ray that ends this short of a place has reached it.
constexpr double reached = 0.02;
/// Of the beams of a scan, so many stand for all.
constexpr std::size_t beams_per_scan = 60'000;

std::vector<Eigen::Vector3d> moved_points(const Cloud& cloud, std::size_t wanted,
                                          const Pose& model_from_map) {
  std::vector<Eigen::Vector3d> points;
  for (const std::size_t i : evenly_chosen(cloud.points.size(), wanted))
    points.push_back(model_from_map * cloud.points[i].cast<double>());
  return points;
}

/// Where a scan stood in the model, and the directions of its beams that came back.
struct Viewpoint {
  Eigen::Vector3d origin;
  KdTree directions;  ///< unit vectors
};

std::vector<Viewpoint> viewpoints(const MapSurfaces& map, const Pose& model_from_map) {
  std::vector<std::vector<std::size_t>> points(map.poses.size());
  for (std::size_t i = 0; i < map.cloud.scan.size(); ++i) points[map.cloud.scan[i]].push_back(i);
  std::vector<Viewpoint> result;
  for (std::size_t scan = 0; scan < points.size(); ++scan) {
    const Eigen::Vector3d origin = map.poses[scan].translation();
    std::vector<Eigen::Vector3f> directions;
    for (const std::size_t k : evenly_chosen(points[scan].size(), beams_per_scan)) {
      const Eigen::Vector3d beam = map.cloud.points[points[scan][k]].cast<double>() - origin;
      directions.push_back((model_from_map.linear() * beam).normalized().cast<float>());
    }
    if (!directions.empty()) result.push_back({model_from_map * origin, KdTree(directions)});
  }
  return result;
}

bool sees(const Viewpoint& view, const RayCaster& model, const Eigen::Vector3d& place,
          const Eigen::Vector3d& normal, const ModelComparisonParams& params) {
  const Eigen::Vector3d way = place - view.origin;
  const double distance = way.norm();
  if (distance < reached) return false;
  const Eigen::Vector3d direction = way / distance;
  if (std::abs(direction.dot(normal)) < std::cos(params.max_incidence)) return false;
  const double chord = 2 * std::sin(params.beam_angle / 2);
  if (!view.directions.nearest(direction.cast<float>(), static_cast<float>(chord))) return false;
  const auto hit = model.cast(view.origin, direction, distance);
  return !hit || hit->distance > distance - reached;
}

std::vector<Eigen::Vector3d> seen_places(const SurfaceSamples& samples, const SurfaceTree& surface,
                                         const TriangleMesh& model,
                                         const std::vector<Viewpoint>& views,
                                         const ModelComparisonParams& params) {
  const RayCaster caster(model);
  std::vector<std::uint8_t> seen(samples.points.size(), 0);
  parallel_for(seen.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Eigen::Vector3d normal = surface.normal(samples.triangles[k]);
      seen[k] = std::any_of(views.begin(), views.end(), [&](const Viewpoint& view) {
        return sees(view, caster, samples.points[k], normal, params);
      });
    }
  });
  std::vector<Eigen::Vector3d> result;
  for (std::size_t k = 0; k < seen.size(); ++k)
    if (seen[k]) result.push_back(samples.points[k]);
  return result;
}

SurfaceDistances distances_to_points(const std::vector<Eigen::Vector3d>& places, const Cloud& cloud,
                                     const Pose& model_from_map, double within) {
  const KdTree tree(cloud.points);
  const Pose map_from_model = model_from_map.inverse();
  std::vector<double> distances(places.size());
  parallel_for(places.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Eigen::Vector3f place = (map_from_model * places[k]).cast<float>();
      const auto nearest = tree.nearest(place, std::numeric_limits<float>::infinity());
      distances[k] = std::sqrt(static_cast<double>(nearest->squared_distance));
    }
  });
  return distance_figures(std::move(distances), within);
}

}  // namespace

ModelComparison compare_with_model(const MapSurfaces& map, const TriangleMesh& model,
                                   const std::optional<Pose>& model_from_map,
                                   const ModelComparisonParams& params) {
  if (map.cloud.points.empty()) throw Error("the map has no points to compare with the model");
  const SurfaceTree surface(model);
  ModelComparison result;
  if (model_from_map) {
    result.model_from_map = *model_from_map;
  } else {
    result.fit = place_on_surface(map.cloud, model, surface);
    result.model_from_map = result.fit->surface_from_points;
  }
  const Pose& to_model = result.model_from_map;
  result.cloud_to_model =
      surface_distances(moved_points(map.cloud, params.samples, to_model), surface, params.within);
  const SurfaceSamples samples = surface_samples(model, params.samples);
  const auto seen = seen_places(samples, surface, model, viewpoints(map, to_model), params);
  result.samples = samples.points.size();
  result.seen = seen.size();
  result.model_to_cloud = distances_to_points(seen, map.cloud, to_model, params.within);
  if (map.mesh.triangles.empty()) return result;
  TriangleMesh mesh = map.mesh;
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = (to_model * vertex.cast<double>()).cast<float>();
  result.map_to_model =
      surface_distances(surface_samples(mesh, params.samples).points, surface, params.within);
  result.model_to_map = surface_distances(seen, SurfaceTree(mesh), params.within);
  return result;
}

}  // namespace planum
