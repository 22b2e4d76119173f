#include "meshing/rest_surface.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "meshing/borders.hpp"

namespace planum {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

bool is_degenerate(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

class RestBuilder {
 public:
  RestBuilder(const TriangleMesh& mesh, const HalfEdges& edges,
              const std::vector<std::uint32_t>& labels, const SnappedCorners& corners,
              std::vector<ChainShape>& shapes)
      : mesh_(mesh), edges_(edges), labels_(labels), corners_(corners), shapes_(shapes) {
    surface_.points = corners.points;
  }

  RestSurface built() {
    collect_triangles();
    straighten();
    merge_dropped();
    std::vector<Triangle> kept;
    for (Triangle t : surface_.triangles) {
      for (std::uint32_t& p : t) p = target(p);
      if (!is_degenerate(t)) kept.push_back(t);
    }
    surface_.triangles.swap(kept);
    for (const ChainShape& shape : shapes_) close_step(shape);
    for (const Triangle& t : corners_.fill)
      if (!is_degenerate(t)) surface_.triangles.push_back(t);
    return std::move(surface_);
  }

 private:
  void collect_triangles() {
    std::vector<std::uint32_t> point_of(edges_.source.size(), HalfEdges::none);
    for (std::uint32_t f = 0; f < labels_.size(); ++f) {
      if (labels_[f] != Regions::rest || edges_.is_degenerate(f)) continue;
      Triangle t;
      for (std::uint32_t k = 0; k < 3; ++k) {
        t[k] = corners_.corner[3 * f + k];
        if (t[k] != SnappedCorners::none) continue;
        std::uint32_t& point = point_of[edges_.triangles[f][k]];
        if (point == HalfEdges::none) {
          point = static_cast<std::uint32_t>(surface_.points.size());
          surface_.points.push_back(mesh_.vertices[mesh_.triangles[f][k]].cast<double>());
        }
        t[k] = point;
      }
      surface_.triangles.push_back(t);
    }
    touched_.assign(surface_.points.size(), false);
    for (const Triangle& t : surface_.triangles)
      for (const std::uint32_t p : t) touched_[p] = true;
  }

  /// Calls visit(i, a, b) for each place i of a chain that was dropped between a and b.
  template <typename Visit>
  static void each_dropped(const ChainShape& shape, Visit&& visit) {
    const std::size_t count = shape.left.size();
    for (std::size_t k = 0; k + 1 < shape.kept.size() + shape.closed; ++k) {
      const std::size_t a = shape.kept[k];
      const std::size_t b =
          k + 1 < shape.kept.size() ? shape.kept[k + 1] : shape.kept.front() + count;
      for (std::size_t i = a + 1; i < b; ++i) visit(i, a, b);
    }
  }

  /// Puts dropped points that the rest uses onto the simplified border, spaced as they were. That
  /// is the border of the region on the left: the rest may hang on other planes at the ends of a
  /// chain.
  void straighten() {
    for (const ChainShape& shape : shapes_) {
      if (shape.right.empty() || shape.straight) continue;
      const std::size_t count = shape.left.size();
      const auto at = [&](std::size_t i) -> const Eigen::Vector3d& {
        return corners_.points[shape.left[i % count]];
      };
      each_dropped(shape, [&](std::size_t i, std::size_t a, std::size_t b) {
        double before = 0, length = 0;
        for (std::size_t j = a; j < b; ++j) {
          length += (at(j + 1) - at(j)).norm();
          if (j < i) before = length;
        }
        const double t = length > 0 ? before / length : 0;
        surface_.points[shape.right[i % count]] = (1 - t) * at(a) + t * at(b);
      });
    }
  }

  void merge_dropped() {
    merged_into_.resize(surface_.points.size());
    for (std::uint32_t p = 0; p < merged_into_.size(); ++p) merged_into_[p] = p;
    for (ChainShape& shape : shapes_) {
      if (shape.right.empty() || shape.straight) continue;
      const std::size_t count = shape.left.size();
      each_dropped(shape, [&](std::size_t i, std::size_t a, std::size_t b) {
        const std::uint32_t p = shape.right[i % count];
        if (!touched_[p]) return;
        const std::uint32_t from = shape.right[a % count], to = shape.right[b % count];
        const auto off = [&](std::uint32_t q) {
          return (surface_.points[p] - surface_.points[q]).squaredNorm();
        };
        merged_into_[p] = off(from) <= off(to) ? from : to;
      });
    }
    while (undo_folds()) {
    }
    for (ChainShape& shape : shapes_) keep_unmerged(shape);
  }

  std::uint32_t target(std::uint32_t p) const { return merged_into_[p]; }

  Eigen::Vector3d normal(const Triangle& t) const {
    const auto& p = surface_.points;
    return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
  }

  /// Takes back merges that turn a triangle by more than 60 degrees.
  bool undo_folds() {
    bool undone = false;
    for (const Triangle& t : surface_.triangles) {
      const Triangle now{target(t[0]), target(t[1]), target(t[2])};
      if (now == t || is_degenerate(now)) continue;
      const Eigen::Vector3d before = normal(t), after = normal(now);
      if (after.dot(before) >= 0.5 * after.norm() * before.norm()) continue;
      for (const std::uint32_t p : t) merged_into_[p] = p;
      undone = true;
    }
    return undone;
  }

  void keep_unmerged(ChainShape& shape) const {
    if (shape.right.empty() || shape.straight) return;
    std::vector<std::size_t> kept = shape.kept;
    each_dropped(shape, [&](std::size_t i, std::size_t, std::size_t) {
      const std::uint32_t p = shape.right[i % shape.left.size()];
      if (touched_[p] && target(p) == p) kept.push_back(i % shape.left.size());
    });
    std::sort(kept.begin(), kept.end());
    shape.kept.swap(kept);
  }

  /// Where the two sides of a chain are different points, the strip between them.
  void close_step(const ChainShape& shape) {
    if (shape.right.empty() || shape.left == shape.right) return;
    for (std::size_t k = 0; k + 1 < shape.kept.size() + shape.closed; ++k) {
      const std::size_t i = shape.kept[k], j = shape.kept[(k + 1) % shape.kept.size()];
      const Triangle first{shape.left[j], shape.left[i], shape.right[i]};
      const Triangle second{shape.left[j], shape.right[i], shape.right[j]};
      if (!is_degenerate(first)) surface_.triangles.push_back(first);
      if (!is_degenerate(second)) surface_.triangles.push_back(second);
    }
  }

  const TriangleMesh& mesh_;
  const HalfEdges& edges_;
  const std::vector<std::uint32_t>& labels_;
  const SnappedCorners& corners_;
  std::vector<ChainShape>& shapes_;
  RestSurface surface_;
  std::vector<bool> touched_;  ///< points that triangles of the rest use
  std::vector<std::uint32_t> merged_into_;
};

}  // namespace

RestSurface rest_surface(const TriangleMesh& mesh, const HalfEdges& edges,
                         const std::vector<std::uint32_t>& labels, const SnappedCorners& corners,
                         std::vector<ChainShape>& shapes) {
  return RestBuilder(mesh, edges, labels, corners, shapes).built();
}

}  // namespace planum
