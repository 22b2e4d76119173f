#include "tests/slam/graph/synthetic_graph.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace planum::testing {
namespace {

/// A place on a closed Lissajous curve of about 170 m that crosses itself; laps count from 0.
template <class Manifold>
typename Manifold::PoseType place_on_curve(double lap) {
  const double u = 2 * pi * lap;
  const Eigen::Vector3d at(12 * std::sin(3 * u), 9 * std::sin(2 * u), 0.8 * std::sin(5 * u));
  const double heading = std::atan2(18 * std::cos(2 * u), 36 * std::cos(3 * u));
  if constexpr (Manifold::space == 3)
    return pose_from_xyz_ypr(at, heading, 0.1 * std::sin(7 * u), 0.08 * std::cos(3 * u));
  else
    return flattened(pose_from_xyz_ypr(at, heading, 0, 0));
}

/// 2 cm and 0.3 degrees, with correlations.
template <class Manifold>
typename Manifold::Matrix edge_covariance() {
  typename Manifold::Matrix root = Manifold::Matrix::Zero();
  constexpr int n = Manifold::dimension;
  for (int i = 0; i < n; ++i) {
    root(i, i) = i < Manifold::space ? 0.02 : radians(0.3);
    for (int j = 0; j < i; ++j) root(i, j) = 0.1 * root(i, i);
  }
  return root * root.transpose();
}

}  // namespace

template <class Manifold>
SyntheticGraph<Manifold> synthetic_graph(std::size_t count, std::size_t loops, double false_share,
                                         unsigned seed) {
  std::mt19937 random(seed);
  SyntheticGraph<Manifold> result;
  const auto covariance = edge_covariance<Manifold>();
  const typename Manifold::Matrix root = covariance.llt().matrixL();
  const auto measured = [&](const auto& from, const auto& to) {
    return Manifold::moved(Manifold::product(Manifold::inverse(from), to),
                           root * normal_vector<Manifold::dimension>(random));
  };
  const auto add = [&](std::size_t from, std::size_t to, const auto& step, EdgeKind kind,
                       bool is_false) {
    result.graph.edges.push_back({.from = from,
                                  .to = to,
                                  .from_from_to = step,
                                  .information = covariance.inverse(),
                                  .kind = kind});
    result.false_loop.push_back(is_false);
  };
  for (std::size_t i = 0; i < count; ++i)
    result.truth.push_back(
        place_on_curve<Manifold>(2.0 * static_cast<double>(i) / static_cast<double>(count)));
  result.graph.poses = {result.truth[0]};
  for (std::size_t i = 1; i < count; ++i) {
    const auto step = measured(result.truth[i - 1], result.truth[i]);
    add(i - 1, i, step, EdgeKind::odometry, false);
    result.graph.poses.push_back(Manifold::product(result.graph.poses[i - 1], step));
  }
  std::uniform_int_distribution<std::size_t> any(0, count - 1);
  std::uniform_real_distribution<double> share(0, 1);
  for (std::size_t k = 0; k < loops; ++k) {
    const bool is_false = share(random) < false_share;
    std::size_t from = 0, to = 0;
    for (bool found = false; !found;) {
      from = any(random);
      to = any(random);
      const double distance =
          (Manifold::position(result.truth[from]) - Manifold::position(result.truth[to])).norm();
      found = from + 10 <= to && (is_false ? distance > 4 : distance < 3);
    }
    // A false loop believes that the two places are one.
    add(from, to,
        is_false ? measured(result.truth[from], result.truth[from])
                 : measured(result.truth[from], result.truth[to]),
        EdgeKind::loop, is_false);
  }
  return result;
}

template <class Manifold>
double position_rms(const std::vector<typename Manifold::PoseType>& a,
                    const std::vector<typename Manifold::PoseType>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (Manifold::position(a[i]) - Manifold::position(b[i])).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

template SyntheticGraph<SpatialManifold> synthetic_graph(std::size_t, std::size_t, double,
                                                         unsigned);
template SyntheticGraph<PlanarManifold> synthetic_graph(std::size_t, std::size_t, double, unsigned);
template double position_rms<SpatialManifold>(const std::vector<Pose>&, const std::vector<Pose>&);
template double position_rms<PlanarManifold>(const std::vector<PlanarPose>&,
                                             const std::vector<PlanarPose>&);

}  // namespace planum::testing
