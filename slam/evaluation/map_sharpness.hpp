#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

namespace planum {

struct MapSharpnessParams {
  double radius = 0.3;              ///< m, of the neighbourhood of a point
  std::size_t min_neighbours = 10;  ///< the point itself included; others are passed over
  std::size_t max_points = 0;       ///< of the cloud, evenly chosen; 0: all
  std::size_t max_queries = 0;      ///< points whose neighbourhood is looked at; 0: all
  double least_deviation = 1e-4;    ///< m, no neighbourhood counts as thinner
};

/// How crisp a registered cloud is, without a truth: scans that do not fit blur what they both see.
struct MapSharpness {
  double mean_entropy = 0;         ///< nats; lower is crisper
  double mean_plane_variance = 0;  ///< m^2
  double plane_thickness = 0;      ///< m, median of the standard deviations across the planes
  std::size_t measured = 0;        ///< neighbourhoods; all else is zero if there are none
  std::size_t passed_over = 0;     ///< points with too few neighbours
};

/// Mean map entropy (Droeschel, Stueckler, Behnke, ICRA 2014) and mean plane variance (Razlaw,
/// Droeschel, Holz, Behnke, ECMR 2015) over the neighbourhoods of points. Only figures of the same
/// place, radius and kind of scans compare. The same for any number of threads. Throws Error if a
/// point is not finite or a parameter is out of range.
MapSharpness map_sharpness(std::span<const Eigen::Vector3f> points,
                           const MapSharpnessParams& params = {});

}  // namespace planum
