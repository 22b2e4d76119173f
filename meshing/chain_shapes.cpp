#include "meshing/chain_shapes.hpp"

#include <cmath>
#include <numeric>

#include "meshing/plane_meeting.hpp"
#include "meshing/simplification.hpp"

namespace planum {
namespace {

Polyline positions(const std::vector<std::uint32_t>& indices,
                   const std::vector<Eigen::Vector3d>& points) {
  Polyline line;
  line.reserve(indices.size());
  for (const std::uint32_t i : indices) line.push_back(points[i]);
  return line;
}

}  // namespace

std::vector<std::uint32_t> ChainShape::kept_points(bool of_right) const {
  const std::vector<std::uint32_t>& side = of_right ? right : left;
  std::vector<std::uint32_t> points;
  points.reserve(kept.size());
  for (const std::size_t i : kept) points.push_back(side[i]);
  return points;
}

ChainShape chain_shape(const BorderChain& chain, const HalfEdges& edges,
                       const SnappedCorners& corners, const std::vector<Region>& regions) {
  ChainShape shape;
  shape.closed = chain.closed;
  for (const std::uint32_t h : chain.half_edges) shape.left.push_back(corners.start[h]);
  if (!chain.closed) shape.left.push_back(corners.end[chain.half_edges.back()]);
  if (chain.right == outside_mesh) return shape;
  for (const std::uint32_t h : chain.half_edges)
    shape.right.push_back(corners.end[edges.opposite[h]]);
  if (!chain.closed) shape.right.push_back(corners.start[edges.opposite[chain.half_edges.back()]]);
  shape.straight = chain.right < outside_mesh && shape.left == shape.right &&
                   meet_in_a_line(regions[chain.left].plane, regions[chain.right].plane);
  return shape;
}

void simplify(ChainShape& shape, const std::vector<Eigen::Vector3d>& points, double max_error) {
  if (shape.straight) {
    shape.kept = {0, shape.left.size() - 1};
    return;
  }
  std::vector<Polyline> lines{positions(shape.left, points)};
  if (!shape.right.empty() && shape.right != shape.left)
    lines.push_back(positions(shape.right, points));
  shape.kept = kept_vertices(lines, max_error, shape.closed);
}

}  // namespace planum
