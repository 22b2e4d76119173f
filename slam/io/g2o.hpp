#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "slam/core/pose.hpp"

namespace planum {

struct G2oVertex {
  int id = 0;
  Pose world_from_vertex = Pose::Identity();
};

struct G2oEdge {
  int from = 0;
  int to = 0;
  Pose from_from_to = Pose::Identity();  ///< measured
  /// As the file has it: of [translation; vector part of the unit quaternion], the latter being
  /// half a small rotation. See information_from_g2o.
  Matrix6d information = Matrix6d::Identity();
};

/// A 3D pose graph as a .g2o file holds it.
struct G2oGraph {
  std::vector<G2oVertex> vertices;
  std::vector<G2oEdge> edges;
  std::vector<int> fixed;             ///< ids of vertices that an optimizer leaves alone
  std::vector<std::string> comments;  ///< without '#', each one a line
};

/// Reads VERTEX_SE3:QUAT, EDGE_SE3:QUAT and FIX lines; PARAMS_ lines are passed over. Throws Error
/// `path:line` for other lines, a vertex that is there twice or an edge to none, and if there is no
/// vertex.
G2oGraph read_g2o(const std::filesystem::path& path);

/// Writes vertices, FIX lines, edges and comments, in this order.
void write_g2o(const std::filesystem::path& path, const G2oGraph& graph);

/// The information of the error log_se3(measured^-1 * estimated) (translation, then rotation in
/// radians) that a file's information stands for, to first order; and back.
Matrix6d information_from_g2o(const Matrix6d& information);
Matrix6d g2o_from_information(const Matrix6d& information);

}  // namespace planum
