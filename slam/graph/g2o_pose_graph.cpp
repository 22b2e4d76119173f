#include "slam/graph/g2o_pose_graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace planum {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::size_t position_of(int id, const G2oIndex& index) {
  return static_cast<std::size_t>(std::lower_bound(index.ids.begin(), index.ids.end(), id) -
                                  index.ids.begin());
}

EdgeKind kind(const G2oEdge& edge) {
  const long long step = static_cast<long long>(edge.to) - edge.from;
  return std::abs(step) == 1 ? EdgeKind::odometry : EdgeKind::loop;
}

/// Where x, y and heading are among the six directions of a twist.
const std::array<int, 3> planar_rows = {0, 1, 5};

}  // namespace

G2oIndex g2o_index(const G2oGraph& file) {
  G2oIndex index;
  for (const G2oVertex& vertex : file.vertices) index.ids.push_back(vertex.id);
  for (const G2oEdge& edge : file.edges) {
    index.ids.push_back(edge.from);
    index.ids.push_back(edge.to);
  }
  std::sort(index.ids.begin(), index.ids.end());
  index.ids.erase(std::unique(index.ids.begin(), index.ids.end()), index.ids.end());
  for (const int id : file.fixed) index.fixed.push_back(position_of(id, index));
  std::sort(index.fixed.begin(), index.fixed.end());
  index.fixed.erase(std::unique(index.fixed.begin(), index.fixed.end()), index.fixed.end());
  return index;
}

PoseGraph spatial_graph(const G2oGraph& file, const G2oIndex& index) {
  Pose nowhere = Pose::Identity();
  nowhere.translation().setConstant(unknown);
  PoseGraph graph{.poses = std::vector<Pose>(index.ids.size(), nowhere), .edges = {}};
  for (const G2oVertex& vertex : file.vertices)
    graph.poses[position_of(vertex.id, index)] = vertex.world_from_vertex;
  graph.edges.reserve(file.edges.size());
  for (const G2oEdge& edge : file.edges)
    graph.edges.push_back(
        {.from = position_of(edge.from, index),
         .to = position_of(edge.to, index),
         .from_from_to = edge.from_from_to,
         .information = file.planar ? edge.information : information_from_g2o(edge.information),
         .kind = kind(edge)});
  return graph;
}

PlanarPoseGraph planar_graph(const G2oGraph& file, const G2oIndex& index) {
  const PlanarPose nowhere{.position = Eigen::Vector2d::Constant(unknown)};
  PlanarPoseGraph graph{.poses = std::vector<PlanarPose>(index.ids.size(), nowhere), .edges = {}};
  for (const G2oVertex& vertex : file.vertices)
    graph.poses[position_of(vertex.id, index)] = flattened(vertex.world_from_vertex);
  graph.edges.reserve(file.edges.size());
  for (const G2oEdge& edge : file.edges)
    graph.edges.push_back({.from = position_of(edge.from, index),
                           .to = position_of(edge.to, index),
                           .from_from_to = flattened(edge.from_from_to),
                           .information = edge.information(planar_rows, planar_rows),
                           .kind = kind(edge)});
  return graph;
}

Matrix6d file_information(const Edge& edge) { return g2o_from_information(edge.information); }

Matrix6d file_information(const PlanarEdge& edge) {
  Matrix6d information = Matrix6d::Zero();
  information(planar_rows, planar_rows) = edge.information;
  return information;
}

}  // namespace planum
