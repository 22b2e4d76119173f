#include "tools/planum/optimized_file.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/graph/edge_relaxation.hpp"
#include "slam/graph/g2o_pose_graph.hpp"

namespace planum {
namespace {

const Pose& in_space(const Pose& pose) { return pose; }
Pose in_space(const PlanarPose& pose) { return lifted(pose); }

template <class Matrix>
double largest_sigma(const std::vector<Matrix>& covariances) {
  constexpr int space = Matrix::RowsAtCompileTime == 6 ? 3 : 2;
  double largest = -1;
  for (const Matrix& covariance : covariances) {
    const auto eigen = covariance.template topLeftCorner<space, space>()
                           .template selfadjointView<Eigen::Lower>()
                           .eigenvalues();
    largest = std::max(largest, std::sqrt(std::max(0.0, eigen.maxCoeff())));
  }
  return largest;
}

/// What becomes of the edges of a file when some of them are repaired, and others do not count.
template <class Graph>
void write_edges(const G2oGraph& file, const Graph& graph, const GraphQuality& quality,
                 G2oGraph& result) {
  std::vector<G2oEdge> edges = file.edges;
  for (const RepairedInformation& repaired : quality.repaired)
    edges[repaired.edge].information = file_information(graph.edges[repaired.edge]);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (quality.counts[i])
      result.edges.push_back(edges[i]);
    else
      result.comments.push_back(
          fmt::format("rejected {} {}: contradicts the other edges", edges[i].from, edges[i].to));
  }
}

/// `graph`: with repaired information.
template <class Graph, class Result>
OptimizedFile assembled(const G2oGraph& file, const Graph& graph, G2oIndex index, Result result,
                        std::vector<RepairedInformation> repaired) {
  OptimizedFile optimized;
  optimized.quality = std::move(result.quality);
  optimized.quality.repaired = std::move(repaired);
  optimized.largest_sigma = largest_sigma(result.covariances);
  G2oGraph& output = optimized.file;
  output.planar = file.planar;
  output.fixed = file.fixed;
  output.comments = file.comments;
  for (std::size_t i = 0; i < index.ids.size(); ++i)
    output.vertices.push_back({index.ids[i], in_space(result.poses[i])});
  write_edges(file, graph, optimized.quality, output);
  optimized.ids = std::move(index.ids);
  return optimized;
}

template <class Graph>
OptimizedFile optimized(const G2oGraph& file, Graph graph, G2oIndex index, GraphParams params,
                        const Progress& progress) {
  std::vector<RepairedInformation> repaired = repair_information(graph);
  params.fixed = index.fixed;
  auto result = optimize(graph, params, progress);
  return assembled(file, graph, std::move(index), std::move(result), std::move(repaired));
}

/// Moves each part so that its fixed pose, if there is one, is back where it was.
void put_back(const std::vector<Pose>& before, const std::vector<std::size_t>& fixed,
              const std::vector<std::vector<std::size_t>>& parts, std::vector<Pose>& poses) {
  for (const auto& part : parts) {
    std::vector<std::size_t> held;
    std::set_intersection(part.begin(), part.end(), fixed.begin(), fixed.end(),
                          std::back_inserter(held));
    if (held.empty()) continue;
    if (held.size() > 1)
      throw Error(
          fmt::format("lu-milios keeps one vertex fixed, but {} that hang together have a "
                      "FIX; --method pose-graph keeps them all",
                      held.size()));
    const Pose motion = before[held[0]] * poses[held[0]].inverse();
    for (const std::size_t pose : part) poses[pose] = motion * poses[pose];
  }
}

template <class Graph>
OptimizedFile relaxed(const G2oGraph& file, Graph graph, G2oIndex index) {
  std::vector<RepairedInformation> repaired = repair_information(graph);
  GraphParams params = {.rejection = LoopRejection::never,
                        .fixed = index.fixed,
                        .max_iterations = 0,
                        .covariances = false};
  const auto start = optimize(graph, params);
  PoseGraph spatial = spatial_graph(file, index);
  repair_information(spatial);
  for (std::size_t i = 0; i < spatial.poses.size(); ++i)
    spatial.poses[i] = in_space(start.poses[i]);
  EdgeRelaxation relaxation = relax_edges(spatial);
  put_back(spatial.poses, index.fixed, start.quality.components, relaxation.poses);
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    if constexpr (std::is_same_v<Graph, PlanarPoseGraph>)
      graph.poses[i] = flattened(relaxation.poses[i]);
    else
      graph.poses[i] = relaxation.poses[i];
  }
  params.start = GraphStart::given;
  params.covariances = true;
  auto result = optimize(graph, params);
  result.quality.cost_before = start.quality.cost_before;
  result.quality.iterations = relaxation.iterations;
  result.quality.converged = relaxation.converged;
  return assembled(file, graph, std::move(index), std::move(result), std::move(repaired));
}

}  // namespace

OptimizedFile optimized_pose_graph(const G2oGraph& file, GraphParams params,
                                   const Progress& progress) {
  const G2oIndex index = g2o_index(file);
  if (file.planar)
    return optimized(file, planar_graph(file, index), index, std::move(params), progress);
  return optimized(file, spatial_graph(file, index), index, std::move(params), progress);
}

OptimizedFile relaxed_file(const G2oGraph& file) {
  const G2oIndex index = g2o_index(file);
  if (file.planar) return relaxed(file, planar_graph(file, index), index);
  return relaxed(file, spatial_graph(file, index), index);
}

}  // namespace planum
