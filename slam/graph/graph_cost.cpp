#include "slam/graph/graph_cost.hpp"

#include "slam/core/parallel.hpp"

namespace planum {

template <class Manifold>
std::vector<double> squared_errors(const typename Manifold::GraphType& graph,
                                   const GraphTerms& terms,
                                   std::span<const typename Manifold::PoseType> poses) {
  const auto& edges = graph.edges;
  std::vector<double> squared(edges.size());
  parallel_for(edges.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto e = Manifold::error(poses[edges[i].from], poses[edges[i].to],
                                     edges[i].from_from_to, terms.rotation_error);
      squared[i] = e.dot(edges[i].information * e);
    }
  });
  return squared;
}

template <class Manifold>
double graph_cost(const typename Manifold::GraphType& graph, const GraphTerms& terms,
                  std::span<const typename Manifold::PoseType> poses,
                  std::span<const double> weights) {
  const std::vector<double> squared = squared_errors<Manifold>(graph, terms, poses);
  double sum = 0;
  for (std::size_t i = 0; i < squared.size(); ++i)
    if (weights[i] > 0) sum += weights[i] * squared[i];
  if constexpr (Manifold::space == 3)
    for (const GravityObservation& seen : terms.gravity)
      sum += (poses[seen.pose].linear().transpose() * terms.up - seen.up_in_pose).squaredNorm() /
             (seen.sigma * seen.sigma);
  return sum;
}

template std::vector<double> squared_errors<SpatialManifold>(const PoseGraph&, const GraphTerms&,
                                                             std::span<const Pose>);
template std::vector<double> squared_errors<PlanarManifold>(const PlanarPoseGraph&,
                                                            const GraphTerms&,
                                                            std::span<const PlanarPose>);
template double graph_cost<SpatialManifold>(const PoseGraph&, const GraphTerms&,
                                            std::span<const Pose>, std::span<const double>);
template double graph_cost<PlanarManifold>(const PlanarPoseGraph&, const GraphTerms&,
                                           std::span<const PlanarPose>, std::span<const double>);

}  // namespace planum
