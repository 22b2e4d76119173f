#pragma once

#include <cstddef>
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
  std::size_t line = 0;  ///< of the file it was read from, counted from 1
};

/// A pose graph as a .g2o file holds it, in space or in the plane.
struct G2oGraph {
  /// Written as VERTEX_SE2 and EDGE_SE2: z, roll and pitch are 0, information says nothing about
  /// them, and that of the heading is of the whole angle.
  bool planar = false;
  std::vector<G2oVertex> vertices;
  std::vector<G2oEdge> edges;
  std::vector<int> fixed;             ///< ids of vertices that an optimizer leaves alone
  std::vector<std::string> comments;  ///< without '#', each one a line
};

/// What is to become of edges whose vertices are not in the file.
enum class LooseEdges {
  forbidden,  ///< an Error
  allowed,    ///< the vertices have no pose yet
};

/// Reads VERTEX_SE3:QUAT and EDGE_SE3:QUAT, or VERTEX_SE2 and EDGE_SE2, and FIX lines; PARAMS_
/// lines are passed over. Throws Error `path:line` for other lines, both kinds in one file, numbers
/// that are not finite, a vertex that is there twice, an edge that joins a vertex with itself, an
/// edge or FIX of a vertex that is not there, and if there is no vertex (or, if loose edges are
/// allowed, nothing at all).
G2oGraph read_g2o(const std::filesystem::path& path,
                  LooseEdges loose_edges = LooseEdges::forbidden);

/// Writes vertices, FIX lines, edges and comments, in this order.
void write_g2o(const std::filesystem::path& path, const G2oGraph& graph);

/// The information of the error log_se3(measured^-1 * estimated) (translation, then rotation in
/// radians) that a file's information stands for, to first order; and back. Not for planar graphs,
/// whose information is of the whole angle in both.
Matrix6d information_from_g2o(const Matrix6d& information);
Matrix6d g2o_from_information(const Matrix6d& information);

}  // namespace planum
