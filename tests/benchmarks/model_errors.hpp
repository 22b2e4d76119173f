#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "slam/core/parallel.hpp"
#include "slam/core/pose.hpp"
#include "slam/core/triangle_mesh.hpp"
#include "slam/evaluation/error_statistics.hpp"
#include "slam/evaluation/sampling.hpp"
#include "slam/evaluation/surface_tree.hpp"

namespace planum::testing {

/// How far places are from a surface, m.
struct SurfaceError {
  double mean = 0, rms = 0, percentile_95 = 0;
};

inline SurfaceError distances_of(const std::vector<Eigen::Vector3d>& points,
                                 const SurfaceTree& tree) {
  std::vector<double> distances(points.size());
  parallel_for(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) distances[i] = tree.nearest(points[i])->distance;
  });
  std::sort(distances.begin(), distances.end());
  const ErrorStatistics s = statistics(distances);
  return {s.mean, s.rmse, quantile(distances, 0.95)};
}

/// The building in the frame of the map, as far as the initial mesh shows it.
class ModelErrors {
 public:
  static constexpr std::size_t samples = 200'000;  ///< places on each surface
  static constexpr double shown_within = 0.05;     ///< m, of the initial mesh from what it shows

  ModelErrors(const TriangleMesh& model, const Pose& model_from_world, const TriangleMesh& initial)
      : tree_(moved(model, model_from_world.inverse())) {
    const SurfaceTree shown(initial);
    for (const Eigen::Vector3d& place :
         surface_samples(moved(model, model_from_world.inverse()), samples).points)
      if (shown.nearest(place, shown_within)) shown_.push_back(place);
  }

  /// Of places on a mesh from the building.
  SurfaceError from(const TriangleMesh& mesh) const {
    return distances_of(surface_samples(mesh, samples).points, tree_);
  }
  /// Of places on the building from a mesh.
  SurfaceError to(const TriangleMesh& mesh) const {
    return distances_of(shown_, SurfaceTree(mesh));
  }

 private:
  static TriangleMesh moved(TriangleMesh mesh, const Pose& b_from_a) {
    for (Eigen::Vector3f& vertex : mesh.vertices)
      vertex = (b_from_a * vertex.cast<double>()).cast<float>();
    return mesh;
  }

  SurfaceTree tree_;
  std::vector<Eigen::Vector3d> shown_;
};

}  // namespace planum::testing
