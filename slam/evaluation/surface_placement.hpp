#pragma once

#include <cstddef>

#include "slam/core/cloud.hpp"
#include "slam/core/pose.hpp"
#include "slam/core/triangle_mesh.hpp"
#include "slam/evaluation/surface_comparison.hpp"

namespace planum {

struct SurfacePlacementParams {
  double step = 0.5;                ///< m, of the grid of places that are tried
  double margin = 1.0;              ///< m, how far the cloud may reach out of the model's box
  std::size_t points = 400;         ///< of the cloud, that tell how well a place suits
  std::size_t fit_points = 20'000;  ///< of the cloud, that are laid onto the model at last
  std::size_t refined = 12;         ///< of the best places, so many are tried with fit_to_surface()
};

/// Lays a cloud of a building onto a model of it, both upright, without a guess: its walls are
/// turned to those of the model in each of four ways, the lowest points lie on the lowest of the
/// model, and of a grid of places the best ones are refined. For models whose walls mostly follow
/// two directions at right angles, and clouds that show more than one wall of them; of places that
/// suit as well the first is taken. Throws Error as fit_to_surface() does, and if the cloud has no
/// normals.
SurfaceFit place_on_surface(const Cloud& cloud, const TriangleMesh& mesh,
                            const SurfaceTree& surface, const SurfacePlacementParams& params = {});

}  // namespace planum
