#include "slam/graph/chordal_initialization.hpp"

#include <algorithm>

#include <Eigen/Dense>

#include "slam/core/parallel.hpp"
#include "slam/graph/best_positions.hpp"
#include "slam/graph/linear_graph_system.hpp"

namespace planum {
namespace {

template <int D>
Eigen::Matrix<double, D, D> nearest_rotation(const Eigen::Matrix<double, D, D>& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix<double, D, D>> svd(
      matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix<double, D, 1> signs = Eigen::Matrix<double, D, 1>::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs[D - 1] = -1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

/// Mean information about the rotation of each edge, times its weight; at least a little, so that
/// edges without information still connect.
template <class Manifold>
std::vector<double> rotation_weights(const typename Manifold::GraphType& graph,
                                     std::span<const double> weights) {
  constexpr int D = Manifold::space, turns = Manifold::dimension - D;
  std::vector<double> result;
  result.reserve(graph.edges.size());
  for (const auto& edge : graph.edges)
    result.push_back(edge.information.diagonal().template tail<turns>().mean());
  const double largest = result.empty() ? 0 : *std::max_element(result.begin(), result.end());
  const double least = largest > 0 ? 1e-6 * largest : 1.0;
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = weights[i] * std::max(result[i], least);
  return result;
}

/// The relaxed rotations, transposed: R_to^T = R_measured^T R_from^T is linear in them.
template <class Manifold>
std::optional<Eigen::MatrixXd> relaxed_rotations(const typename Manifold::GraphType& graph,
                                                 const GraphPattern& pattern,
                                                 std::span<const std::size_t> anchors,
                                                 std::span<const double> weights) {
  constexpr int D = Manifold::space;
  LinearSystem<D> system(pattern, D);
  const std::vector<double> turn_weights = rotation_weights<Manifold>(graph, weights);
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    if (turn_weights[i] <= 0) continue;
    const auto& edge = graph.edges[i];
    const typename Manifold::Rotation measured = Manifold::rotation(edge.from_from_to);
    system.diagonal(edge.from).diagonal().array() += turn_weights[i];
    system.diagonal(edge.to).diagonal().array() += turn_weights[i];
    auto block = system.off_diagonal(pattern.pair_of_edge[i]);
    if (edge.from < edge.to)
      block -= turn_weights[i] * measured;
    else
      block -= turn_weights[i] * measured.transpose();
  }
  Eigen::MatrixXd given =
      Eigen::MatrixXd::Zero(D * static_cast<Eigen::Index>(graph.poses.size()), D);
  for (const std::size_t anchor : anchors)
    given.middleRows<D>(D * static_cast<Eigen::Index>(anchor)) =
        Manifold::rotation(graph.poses[anchor]).transpose();
  return system.solved(anchors, given);
}

}  // namespace

template <class Manifold>
std::vector<typename Manifold::PoseType> chordal_initialization(
    const typename Manifold::GraphType& graph, const GraphPattern& pattern,
    std::span<const std::size_t> anchors, std::span<const double> weights) {
  constexpr int D = Manifold::space;
  const auto relaxed = relaxed_rotations<Manifold>(graph, pattern, anchors, weights);
  if (!relaxed) return {};
  std::vector<typename Manifold::PoseType> poses(graph.poses.size());
  parallel_for(poses.size(), 2048, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const typename Manifold::Rotation transposed =
          relaxed->template middleRows<D>(D * static_cast<Eigen::Index>(i));
      poses[i] =
          Manifold::pose(nearest_rotation<D>(transposed.transpose()), Manifold::Position::Zero());
    }
  });
  for (const std::size_t anchor : anchors) poses[anchor] = graph.poses[anchor];
  return with_best_positions<Manifold>(graph, pattern, anchors, weights, poses,
                                       RotationError::chord);
}

template std::vector<Pose> chordal_initialization<SpatialManifold>(const PoseGraph&,
                                                                   const GraphPattern&,
                                                                   std::span<const std::size_t>,
                                                                   std::span<const double>);
template std::vector<PlanarPose> chordal_initialization<PlanarManifold>(
    const PlanarPoseGraph&, const GraphPattern&, std::span<const std::size_t>,
    std::span<const double>);

}  // namespace planum
