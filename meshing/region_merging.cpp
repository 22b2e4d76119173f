#include "meshing/region_merging.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <set>

#include "meshing/face_geometry.hpp"

namespace planum {
namespace {

constexpr int gap_rings = 2;  // Regions this many rings of rest triangles apart still touch.

/// Labels with the rest next to regions given to them, ring by ring.
std::vector<std::uint32_t> widened(const std::vector<std::uint32_t>& labels,
                                   const HalfEdges& edges) {
  std::vector<std::uint32_t> wide = labels, ring;
  for (std::uint32_t f = 0; f < labels.size(); ++f)
    if (labels[f] != Regions::rest) ring.push_back(f);
  for (int depth = 0; depth < gap_rings; ++depth) {
    std::vector<std::uint32_t> next_ring;
    for (const std::uint32_t f : ring)
      for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        const std::uint32_t back = edges.opposite[h];
        if (back == HalfEdges::none || wide[back / 3] != Regions::rest) continue;
        wide[back / 3] = wide[f];
        next_ring.push_back(back / 3);
      }
    ring.swap(next_ring);
  }
  return wide;
}

/// A set of regions that have become one.
struct Cluster {
  Plane plane;  ///< relative to the common origin
  double area = 0;
  PointMoments moments;
  std::set<std::uint32_t> neighbours;
  std::uint32_t version = 0;  ///< counts merges; an older candidate is stale
};

struct Candidate {
  double error;  ///< m, the worse rms distance from the common plane
  std::uint32_t a, b, version_a, version_b;
  bool operator>(const Candidate& other) const {
    if (error != other.error) return error > other.error;
    return a != other.a ? a > other.a : b > other.b;
  }
};

Plane turned_like(const Plane& plane, const Eigen::Vector3d& direction) {
  if (plane.normal.dot(direction) >= 0) return plane;
  return {-plane.normal, -plane.offset};
}

class Merger {
 public:
  Merger(const Regions& regions, const TriangleMesh& mesh, const HalfEdges& edges,
         const RegionParams& params)
      : regions_(regions), params_(params), parent_(regions.regions.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    if (!mesh.vertices.empty()) origin_ = mesh.vertices.front().cast<double>();
    for (const Region& region : regions.regions)
      clusters_.push_back({relative_to(region.plane, origin_), region.area, {}, {}, 0});
    const FaceGeometry faces = face_geometry(mesh);
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
      if (regions.of_triangle[f] != Regions::rest)
        add_triangle(clusters_[regions.of_triangle[f]].moments, mesh, f, faces.area[f] * 1e6,
                     origin_);
    find_neighbours(edges);
  }

  Regions merged() {
    for (std::uint32_t a = 0; a < clusters_.size(); ++a)
      for (const std::uint32_t b : clusters_[a].neighbours)
        if (a < b) consider(a, b);
    while (!queue_.empty()) {
      const Candidate best = queue_.top();
      queue_.pop();
      if (parent_[best.a] != best.a || parent_[best.b] != best.b) continue;
      if (clusters_[best.a].version != best.version_a) continue;
      if (clusters_[best.b].version != best.version_b) continue;
      join(best.a, best.b);
    }
    return sorted();
  }

 private:
  void find_neighbours(const HalfEdges& edges) {
    const std::vector<std::uint32_t> wide = widened(regions_.of_triangle, edges);
    for (std::uint32_t h = 0; h < edges.opposite.size(); ++h) {
      const std::uint32_t back = edges.opposite[h];
      if (back == HalfEdges::none) continue;
      const std::uint32_t a = wide[h / 3], b = wide[back / 3];
      if (a != b && a != Regions::rest && b != Regions::rest) clusters_[a].neighbours.insert(b);
    }
  }

  void consider(std::uint32_t a, std::uint32_t b) {
    const Cluster &first = clusters_[a], &second = clusters_[b];
    if (first.plane.normal.dot(second.plane.normal) < std::cos(params_.merge_angle)) return;
    PointMoments both = first.moments;
    both += second.moments;
    const std::optional<PlaneFit> fit = fit_plane(both);
    if (!fit) return;
    const double error =
        std::max(rms_distance(first.moments, fit->plane), rms_distance(second.moments, fit->plane));
    if (error <= params_.merge_distance) queue_.push({error, a, b, first.version, second.version});
  }

  void join(std::uint32_t a, std::uint32_t b) {
    Cluster &kept = clusters_[a], &lost = clusters_[b];
    parent_[b] = a;
    kept.moments += lost.moments;
    kept.area += lost.area;
    if (const auto fit = fit_plane(kept.moments))
      kept.plane = turned_like(fit->plane, kept.plane.normal);
    ++kept.version;
    kept.neighbours.insert(lost.neighbours.begin(), lost.neighbours.end());
    kept.neighbours.erase(a);
    kept.neighbours.erase(b);
    for (const std::uint32_t c : kept.neighbours) {
      clusters_[c].neighbours.erase(b);
      clusters_[c].neighbours.insert(a);
      consider(std::min(a, c), std::max(a, c));
    }
  }

  std::uint32_t root(std::uint32_t a) const {
    while (parent_[a] != a) a = parent_[a];
    return a;
  }

  Regions sorted() const {
    std::vector<std::uint32_t> order;
    for (std::uint32_t a = 0; a < clusters_.size(); ++a)
      if (parent_[a] == a && clusters_[a].area >= params_.min_area) order.push_back(a);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return clusters_[a].area > clusters_[b].area;
    });
    Regions result;
    std::vector<std::uint32_t> rank(clusters_.size(), Regions::rest);
    for (const std::uint32_t a : order) {
      rank[a] = static_cast<std::uint32_t>(result.regions.size());
      result.regions.push_back({relative_to(clusters_[a].plane, -origin_), clusters_[a].area});
    }
    for (std::uint32_t a = 0; a < clusters_.size(); ++a)
      if (parent_[a] != a) rank[a] = rank[root(a)];
    result.of_triangle = regions_.of_triangle;
    for (std::uint32_t& label : result.of_triangle)
      if (label != Regions::rest) label = rank[label];
    return result;
  }

  const Regions& regions_;
  const RegionParams& params_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<std::uint32_t> parent_;
  std::vector<Cluster> clusters_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
};

}  // namespace

Regions merged(const Regions& regions, const TriangleMesh& mesh, const HalfEdges& edges,
               const RegionParams& params) {
  return Merger(regions, mesh, edges, params).merged();
}

}  // namespace planum
