#pragma once

#include <cstddef>
#include <vector>

#include "slam/graph/planar_pose_graph.hpp"
#include "slam/graph/pose_graph.hpp"
#include "slam/io/g2o.hpp"

namespace planum {

/// The vertices of a .g2o file in the order of a graph's poses.
struct G2oIndex {
  std::vector<int> ids;            ///< of each pose, ascending
  std::vector<std::size_t> fixed;  ///< poses with a FIX
};

/// All vertices that the file has or that its edges join.
G2oIndex g2o_index(const G2oGraph& file);

/// The graph of a file, its edges in the order of the file; a 2D one lies in the plane z = 0.
/// Vertices without a pose get one that is not finite. Edges between ids in a row are odometry, all
/// others are loops.
PoseGraph spatial_graph(const G2oGraph& file, const G2oIndex& index);

/// The same of a 2D file.
PlanarPoseGraph planar_graph(const G2oGraph& file, const G2oIndex& index);

/// The information of an edge as a 3D file, or a 2D one, has it.
Matrix6d file_information(const Edge& edge);
Matrix6d file_information(const PlanarEdge& edge);

}  // namespace planum
