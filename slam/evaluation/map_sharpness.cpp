#include "slam/evaluation/map_sharpness.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/kd_tree.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/plane.hpp"
#include "slam/core/pose.hpp"
#include "slam/evaluation/error_statistics.hpp"
#include "slam/evaluation/sampling.hpp"

namespace planum {
namespace {

void check(const MapSharpnessParams& params) {
  if (!(params.radius > 0))
    throw Error(fmt::format("evaluation: radius must be > 0 m, got {}", params.radius));
  if (!(params.least_deviation > 0))
    throw Error(
        fmt::format("evaluation: least_deviation must be > 0 m, got {}", params.least_deviation));
  if (params.min_neighbours < 3)
    throw Error(
        fmt::format("evaluation: min_neighbours must be >= 3, got {}", params.min_neighbours));
}

/// m^2, ascending variances along the principal axes of a neighbourhood.
Eigen::Vector3d variances(std::span<const Eigen::Vector3f> points,
                          const std::vector<Neighbour>& neighbours, const Eigen::Vector3f& origin) {
  PointMoments moments;
  for (const Neighbour& n : neighbours) moments.add((points[n.index] - origin).cast<double>());
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments.covariance(),
                                                        Eigen::EigenvaluesOnly)
      .eigenvalues();
}

/// ln det(2 pi e S) / 2 of a Gaussian with covariance S.
double entropy(const Eigen::Vector3d& variances) {
  return 0.5 * (3 * (std::log(2 * pi) + 1) + variances.array().log().sum());
}

}  // namespace

MapSharpness map_sharpness(std::span<const Eigen::Vector3f> points,
                           const MapSharpnessParams& params) {
  check(params);
  std::vector<Eigen::Vector3f> chosen;
  for (const std::size_t i : evenly_chosen(points.size(), params.max_points))
    chosen.push_back(points[i]);
  const KdTree tree(chosen);
  const std::vector<std::size_t> queries = evenly_chosen(chosen.size(), params.max_queries);
  std::vector<std::optional<Eigen::Vector3d>> of_query(queries.size());
  const double least = params.least_deviation * params.least_deviation;
  parallel_for(queries.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> neighbours;
    for (std::size_t k = begin; k < end; ++k) {
      const Eigen::Vector3f& query = chosen[queries[k]];
      tree.within(query, static_cast<float>(params.radius), neighbours);
      if (neighbours.size() >= params.min_neighbours)
        of_query[k] = variances(chosen, neighbours, query).cwiseMax(least);
    }
  });
  MapSharpness result;
  std::vector<double> thicknesses;
  for (const auto& found : of_query) {
    if (!found) continue;
    result.mean_entropy += entropy(*found);
    result.mean_plane_variance += (*found)[0];
    thicknesses.push_back(std::sqrt((*found)[0]));
  }
  result.measured = thicknesses.size();
  result.passed_over = queries.size() - result.measured;
  if (result.measured == 0) return result;
  result.mean_entropy /= static_cast<double>(result.measured);
  result.mean_plane_variance /= static_cast<double>(result.measured);
  std::sort(thicknesses.begin(), thicknesses.end());
  result.plane_thickness = quantile(thicknesses, 0.5);
  return result;
}

}  // namespace planum
