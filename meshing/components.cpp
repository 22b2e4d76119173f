#include "meshing/components.hpp"

namespace planum {

MeshComponents components(const HalfEdges& edges, const std::vector<std::uint32_t>& labels) {
  MeshComponents result;
  result.of_triangle.assign(labels.size(), HalfEdges::none);
  for (std::uint32_t seed = 0; seed < labels.size(); ++seed) {
    if (result.of_triangle[seed] != HalfEdges::none || edges.is_degenerate(seed)) continue;
    const auto id = static_cast<std::uint32_t>(result.triangles.size());
    result.of_triangle[seed] = id;
    std::vector<std::uint32_t> members{seed};
    for (std::size_t at = 0; at < members.size(); ++at)
      for (std::uint32_t h = 3 * members[at]; h < 3 * members[at] + 3; ++h) {
        const std::uint32_t back = edges.opposite[h];
        if (back == HalfEdges::none || result.of_triangle[back / 3] != HalfEdges::none) continue;
        if (labels[back / 3] != labels[seed]) continue;
        result.of_triangle[back / 3] = id;
        members.push_back(back / 3);
      }
    result.triangles.push_back(std::move(members));
  }
  return result;
}

}  // namespace planum
