#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/registration/sequence.hpp"

namespace planum {

enum class EdgeKind {
  odometry,  ///< from a scan to the next one
  loop,      ///< between scans that are not neighbours in time
};

/// A measured relative pose of two scans.
struct Edge {
  std::size_t from = 0, to = 0;          ///< positions in PoseGraph::poses
  Pose from_from_to = Pose::Identity();  ///< measured
  /// Of the error log_se3(measured^-1 * world_from_from^-1 * world_from_to), order
  /// [translation, rotation], 1/m^2 and 1/rad^2.
  Matrix6d information = Matrix6d::Identity();
  Matrix6d odometry_information =
      Matrix6d::Zero();  ///< what of it is from odometry, not from a match
  double rms = 0;        ///< m, of the match; 0 if it is none
  double overlap = 0;    ///< share of the points of `to` that have a pair in `from`
  EdgeKind kind = EdgeKind::odometry;
  bool accepted = true;  ///< others are left out of account
  bool matched = true;   ///< false: odometry alone, because the scans could not be matched
  std::string reason{};  ///< why it was not accepted, or not matched
};

/// Poses and what is known about how they lie to each other.
struct PoseGraph {
  std::vector<Pose> poses;  ///< world_from_scan
  std::vector<Edge> edges;
};

/// The steps of a sequence as a graph.
PoseGraph pose_graph(const SequenceMatch& sequence);

/// The error of an edge with the poses of a graph, in the sense of Edge::information.
Vector6d edge_error(const Edge& edge, const std::vector<Pose>& poses);

/// For each of `count` things the first one that pairs, one after another, connect it with.
std::vector<std::size_t> first_connected(
    std::size_t count, std::span<const std::pair<std::size_t, std::size_t>> pairs);

/// Scans that matches hold together: for each pose the number of its component, counted from 0 in
/// the order of their first poses. Edges that are not accepted, or not matched, hold nothing.
struct Components {
  std::vector<std::size_t> of_pose;
  std::size_t count = 0;

  /// The poses of each component, ascending.
  std::vector<std::vector<std::size_t>> members() const;
};

Components components(const PoseGraph& graph);

/// The same for `count` things that pairs connect.
Components components(std::size_t count,
                      std::span<const std::pair<std::size_t, std::size_t>> pairs);

}  // namespace planum
