#include "slam/evaluation/surface_comparison.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/robust.hpp"
#include "slam/core/symmetric_eigen.hpp"
#include "slam/evaluation/error_statistics.hpp"

namespace planum {
namespace {

constexpr std::size_t block_size = 256;

void check(std::span<const Eigen::Vector3d> points) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite()) throw Error(fmt::format("evaluation: point {} is not finite", i));
}

void check(const Pose& guess, const SurfaceFitParams& params) {
  if (!guess.matrix().allFinite()) throw Error("evaluation: the guess is not finite");
  if (!(params.last_gate > 0) || !(params.first_gate >= params.last_gate))
    throw Error(fmt::format("evaluation: last_gate must be between 0 m and first_gate, got {}",
                            params.last_gate));
  if (params.max_iterations < 1)
    throw Error(
        fmt::format("evaluation: max_iterations must be > 0, got {}", params.max_iterations));
}

struct Equations {
  Matrix6d a = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  double squares = 0;  ///< of the distances
  std::size_t count = 0;

  Equations& operator+=(const Equations& other) {
    a += other.a;
    b += other.b;
    squares += other.squares;
    count += other.count;
    return *this;
  }
};

/// The motion exp(x) about `centre` moves p by t + r x (p - centre); its distance to the tangent
/// plane changes by n.t + ((p - centre) x n).r.
void add(const Eigen::Vector3d& p, const SurfacePoint& nearest, const Eigen::Vector3d& n,
         double gate, const Eigen::Vector3d& centre, Equations& equations) {
  const double weight = biweight(nearest.distance, gate);
  const double residual = n.dot(p - nearest.point);
  Vector6d row;
  row << n, (p - centre).cross(n);
  equations.a.noalias() += weight * row * row.transpose();
  equations.b.noalias() -= weight * residual * row;
  equations.squares += nearest.distance * nearest.distance;
  ++equations.count;
}

Equations equations_of(std::span<const Eigen::Vector3d> points, const SurfaceTree& surface,
                       const Pose& pose, const Eigen::Vector3d& centre, double gate) {
  std::vector<Equations> of_block((points.size() + block_size - 1) / block_size);
  parallel_for(points.size(), block_size, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d p = pose * points[i];
      const auto nearest = surface.nearest(p, gate);
      if (!nearest) continue;
      // On an edge the direction to the point is the normal; on a face the two are one.
      const Eigen::Vector3d n = nearest->distance > 1e-9
                                    ? Eigen::Vector3d((p - nearest->point) / nearest->distance)
                                    : surface.normal(nearest->triangle);
      add(p, *nearest, n, gate, centre, of_block[begin / block_size]);
    }
  });
  Equations sum;
  for (const Equations& block : of_block) sum += block;
  return sum;
}

/// Zero along directions that the equations hardly determine.
Vector6d solution(const Equations& equations) {
  const SymmetricEigen<6> eigen = symmetric_eigen(equations.a);
  const double least = 1e-6 * eigen.values[5];
  Vector6d x = Vector6d::Zero();
  for (Eigen::Index k = 0; k < 6; ++k)
    if (eigen.values[k] > least)
      x += eigen.vectors.col(k) * (eigen.vectors.col(k).dot(equations.b) / eigen.values[k]);
  return x;
}

}  // namespace

SurfaceDistances distance_figures(std::vector<double> distances, double within) {
  std::sort(distances.begin(), distances.end());
  const ErrorStatistics s = statistics(distances);
  SurfaceDistances result{.count = s.count,
                          .mean = s.mean,
                          .rms = s.rmse,
                          .median = s.median,
                          .percentile_90 = quantile(distances, 0.9),
                          .max = s.max,
                          .within = within};
  const auto beyond = std::upper_bound(distances.begin(), distances.end(), within);
  if (s.count > 0)
    result.share_within =
        static_cast<double>(beyond - distances.begin()) / static_cast<double>(s.count);
  return result;
}

SurfaceDistances surface_distances(std::span<const Eigen::Vector3d> points,
                                   const SurfaceTree& surface, double within) {
  if (!(within >= 0)) throw Error(fmt::format("evaluation: within must be >= 0 m, got {}", within));
  check(points);
  std::vector<double> distances(points.size());
  parallel_for(points.size(), block_size, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) distances[i] = surface.nearest(points[i])->distance;
  });
  return distance_figures(std::move(distances), within);
}

SurfaceFit fit_to_surface(std::span<const Eigen::Vector3d> points, const SurfaceTree& surface,
                          const Pose& guess, const SurfaceFitParams& params) {
  check(guess, params);
  check(points);
  SurfaceFit fit{.surface_from_points = guess};
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) middle += p / static_cast<double>(points.size());
  for (double gate = params.first_gate;; gate = std::max(params.last_gate, gate / 2)) {
    fit.converged = false;
    for (int iteration = 0; iteration < params.max_iterations && !fit.converged; ++iteration) {
      const Eigen::Vector3d centre = fit.surface_from_points * middle;
      const Equations equations =
          equations_of(points, surface, fit.surface_from_points, centre, gate);
      if (equations.count < 6)
        throw Error(
            fmt::format("evaluation: only {} of {} points are within {:.2f} m of the "
                        "surface",
                        equations.count, points.size(), gate));
      const Vector6d step = solution(equations);
      fit.surface_from_points =
          orthonormalized(Eigen::Translation3d(centre) * exp_se3(step) *
                          Eigen::Translation3d(-centre) * fit.surface_from_points);
      fit.count = equations.count;
      fit.rms = std::sqrt(equations.squares / static_cast<double>(equations.count));
      fit.converged = step.cwiseAbs().maxCoeff() < params.tolerance;
    }
    if (gate <= params.last_gate) return fit;
  }
}

}  // namespace planum
