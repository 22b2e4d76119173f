#include "slam/graph/best_positions.hpp"

#include <algorithm>

#include "slam/graph/linear_graph_system.hpp"

namespace planum {
namespace {

/// What one edge says about the difference of two positions d: (d - wanted)' weight (d - wanted).
template <class Manifold>
struct PositionTerm {
  typename Manifold::Rotation weight;
  typename Manifold::Position pull;  ///< weight * wanted
};

/// With C = R_measured^T R_from^T the error of translation is C (t_to - t_from) - R_measured^T
/// t_measured; information that ties it to the rotation error moves the minimum.
template <class Manifold>
PositionTerm<Manifold> position_term(const typename Manifold::EdgeType& edge,
                                     const typename Manifold::PoseType& from,
                                     const typename Manifold::PoseType& to,
                                     RotationError rotation_error, double least) {
  constexpr int D = Manifold::space, turns = Manifold::dimension - D;
  const typename Manifold::Rotation measured = Manifold::rotation(edge.from_from_to);
  const typename Manifold::Rotation c = (Manifold::rotation(from) * measured).transpose();
  const typename Manifold::Position step =
      measured.transpose() * Manifold::position(edge.from_from_to);
  const auto turn =
      Manifold::error(from, to, edge.from_from_to, rotation_error).template tail<turns>().eval();
  typename Manifold::Rotation information = edge.information.template topLeftCorner<D, D>();
  const auto coupling = edge.information.template topRightCorner<D, turns>();
  information.diagonal().array() += least;
  return {.weight = c.transpose() * information * c,
          .pull = c.transpose() * (information * step - coupling * turn)};
}

/// A billionth of the mean information of positions.
double least_information(const auto& edges, int dimension) {
  double sum = 0;
  for (const auto& edge : edges) sum += edge.information.diagonal().head(dimension).sum();
  const double mean =
      sum / (dimension * static_cast<double>(std::max<std::size_t>(edges.size(), 1)));
  return mean > 0 ? 1e-9 * mean : 1.0;
}

}  // namespace

template <class Manifold>
std::vector<typename Manifold::PoseType> with_best_positions(
    const typename Manifold::GraphType& graph, const GraphPattern& pattern,
    std::span<const std::size_t> anchors, std::span<const double> weights,
    std::span<const typename Manifold::PoseType> poses, RotationError rotation_error) {
  constexpr int D = Manifold::space;
  const auto row = [](std::size_t pose) { return D * static_cast<Eigen::Index>(pose); };
  const double least = least_information(graph.edges, D);
  LinearSystem<D> system(pattern, 1);
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    if (weights[i] <= 0) continue;
    const auto& edge = graph.edges[i];
    PositionTerm<Manifold> term =
        position_term<Manifold>(edge, poses[edge.from], poses[edge.to], rotation_error, least);
    term.weight *= weights[i];
    term.pull *= weights[i];
    system.diagonal(edge.from) += term.weight;
    system.diagonal(edge.to) += term.weight;
    system.off_diagonal(pattern.pair_of_edge[i]) -= term.weight;
    system.right(edge.to) += term.pull;
    system.right(edge.from) -= term.pull;
  }
  Eigen::MatrixXd given = Eigen::MatrixXd::Zero(row(poses.size()), 1);
  for (const std::size_t anchor : anchors)
    given.middleRows<D>(row(anchor)) = Manifold::position(poses[anchor]);
  const auto positions = system.solved(anchors, given);
  std::vector<typename Manifold::PoseType> result;
  for (std::size_t i = 0; positions && i < poses.size(); ++i)
    result.push_back(
        Manifold::pose(Manifold::rotation(poses[i]), positions->template middleRows<D>(row(i))));
  return result;
}

template std::vector<Pose> with_best_positions<SpatialManifold>(
    const PoseGraph&, const GraphPattern&, std::span<const std::size_t>, std::span<const double>,
    std::span<const Pose>, RotationError);
template std::vector<PlanarPose> with_best_positions<PlanarManifold>(
    const PlanarPoseGraph&, const GraphPattern&, std::span<const std::size_t>,
    std::span<const double>, std::span<const PlanarPose>, RotationError);

}  // namespace planum
