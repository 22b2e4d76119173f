#include "meshing/gap_closing.hpp"

#include <cmath>
#include <optional>
#include <queue>
#include <vector>

#include <Eigen/Geometry>

namespace planum {
namespace {

constexpr double max_cosine_of_ear = 0.985;  ///< edges of an ear turn by ten degrees at least
constexpr double min_agreement = 0.1;        ///< cosine between an ear and the triangles beside it

/// A corner of the rim that may be closed.
struct Ear {
  double length;  ///< m, of the new edge
  std::uint32_t vertex, version;
  bool operator>(const Ear& other) const {
    return length != other.length ? length > other.length : vertex > other.vertex;
  }
};

class GapCloser {
 public:
  GapCloser(TriangleMesh& mesh, HalfEdges& edges, double max_gap)
      : mesh_(mesh), edges_(edges), max_gap_(max_gap) {
    into_.assign(edges.source.size(), HalfEdges::none);
    out_of_.assign(edges.source.size(), HalfEdges::none);
    version_.assign(edges.source.size(), 0);
    for (std::uint32_t h = 0; h < edges.opposite.size(); ++h)
      if (edges.opposite[h] == HalfEdges::none && !edges.is_degenerate(h / 3)) add_rim(h);
  }

  std::size_t close() {
    const std::size_t before = mesh_.triangles.size();
    for (std::uint32_t v = 0; v < into_.size(); ++v) consider(v);
    while (!ears_.empty()) {
      const Ear ear = ears_.top();
      ears_.pop();
      if (ear.version == version_[ear.vertex] && is_on_rim(ear.vertex)) clip(ear.vertex);
    }
    return mesh_.triangles.size() - before;
  }

 private:
  bool is_on_rim(std::uint32_t v) const { return into_[v] != HalfEdges::none; }

  /// Half-edges on the rim, seen from their triangles: `into_[v]` ends at v, `out_of_[v]` begins.
  void add_rim(std::uint32_t h) {
    into_[edges_.to(h)] = h;
    out_of_[edges_.from(h)] = h;
  }

  Eigen::Vector3d position(std::uint32_t v) const {
    return mesh_.vertices[edges_.source[v]].cast<double>();
  }

  Eigen::Vector3d normal(std::uint32_t f) const {
    const auto& t = mesh_.triangles[f];
    return (mesh_.vertices[t[1]] - mesh_.vertices[t[0]])
        .cross(mesh_.vertices[t[2]] - mesh_.vertices[t[0]])
        .cast<double>();
  }

  static bool agree(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return a.dot(b) > min_agreement * a.norm() * b.norm();
  }

  void consider(std::uint32_t v) {
    ++version_[v];
    if (!is_on_rim(v)) return;
    // The triangle to add runs against the rim: from `next` over v to `previous`.
    const std::uint32_t previous = edges_.from(into_[v]), next = edges_.to(out_of_[v]);
    if (previous == next) {
      ears_.push({0, v, version_[v]});
      return;
    }
    const Eigen::Vector3d to_previous = position(previous) - position(v);
    const Eigen::Vector3d to_next = position(next) - position(v);
    const double length = (to_next - to_previous).norm();
    if (length > max_gap_) return;
    if (to_previous.dot(to_next) < -max_cosine_of_ear * to_previous.norm() * to_next.norm()) return;
    const Eigen::Vector3d across = to_previous.cross(to_next);
    if (!agree(across, normal(into_[v] / 3)) || !agree(across, normal(out_of_[v] / 3))) return;
    ears_.push({length, v, version_[v]});
  }

  void join(std::uint32_t a, std::uint32_t b) {
    edges_.opposite[a] = b;
    edges_.opposite[b] = a;
  }

  void leave_rim(std::uint32_t v) {
    into_[v] = out_of_[v] = HalfEdges::none;
    ++version_[v];
  }

  void clip(std::uint32_t v) {
    const std::uint32_t in = into_[v], out = out_of_[v];
    const std::uint32_t previous = edges_.from(in), next = edges_.to(out);
    leave_rim(v);
    if (previous == next) {  // two edges back to back
      join(in, out);
      leave_rim(previous);
      return;
    }
    const auto face = static_cast<std::uint32_t>(edges_.triangles.size());
    edges_.triangles.push_back({next, v, previous});
    mesh_.triangles.push_back({edges_.source[next], edges_.source[v], edges_.source[previous]});
    edges_.opposite.resize(edges_.opposite.size() + 3, HalfEdges::none);
    join(3 * face, out);
    join(3 * face + 1, in);
    const std::uint32_t closing = 3 * face + 2;  // previous to next
    if (edges_.to(out_of_[next]) == previous) {  // the last triangle of a hole
      join(closing, out_of_[next]);
      leave_rim(previous);
      leave_rim(next);
      return;
    }
    add_rim(closing);
    consider(previous);
    consider(next);
  }

  TriangleMesh& mesh_;
  HalfEdges& edges_;
  double max_gap_;
  std::vector<std::uint32_t> into_, out_of_, version_;
  std::priority_queue<Ear, std::vector<Ear>, std::greater<>> ears_;
};

}  // namespace

std::size_t close_gaps(TriangleMesh& mesh, HalfEdges& edges, double max_gap) {
  return GapCloser(mesh, edges, max_gap).close();
}

}  // namespace planum
