#include "meshing/plane_gaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "meshing/geos_polygons.hpp"
#include "meshing/plane_meeting.hpp"

namespace planum {
namespace {

constexpr std::size_t most_corners = 6;     // neighbours tried for the other side of a corner
constexpr double same_plane_cosine = 0.99;  // about 8 degrees
constexpr double same_plane_offset = 0.03;  // m
constexpr double min_angle_sine = 0.5;      // of planes whose line closes a notch: 30 degrees
constexpr double longest_way = 1.5;         // around a corner, against the border of the notch
constexpr double farthest_corner = 10;      // m, from where a notch begins
constexpr double on_plane = 1e-3;           // m, of a vertex that two planes share

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Which polygon has which edge, in the direction of its rings.
std::map<Edge, std::uint32_t> owners_of_edges(const PolygonMap& map) {
  std::map<Edge, std::uint32_t> owners;
  const auto add = [&](const Ring& ring, std::uint32_t polygon) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      owners.emplace(Edge(ring[i], ring[(i + 1) % ring.size()]), polygon);
  };
  for (std::uint32_t p = 0; p < map.polygons.size(); ++p) {
    add(map.polygons[p].outer, p);
    for (const Ring& hole : map.polygons[p].holes) add(hole, p);
  }
  return owners;
}

class GapSearch {
 public:
  GapSearch(const PolygonMap& map, const PlaneGapParams& params)
      : map_(map), params_(params), owners_(owners_of_edges(map)) {}

  std::vector<PlaneGap> of(std::uint32_t polygon) const {
    std::vector<PlaneGap> gaps;
    const MapPolygon& own = map_.polygons[polygon];
    for (const Ring& hole : own.holes)
      if (free_share(hole, 0, hole.size()) >= params_.min_free_border)
        add({hole.rbegin(), hole.rend()}, std::nullopt, polygon, 0, 0, gaps);
    add_notches(polygon, gaps);
    return gaps;
  }

 private:
  /// The polygon beyond an edge of a ring.
  std::optional<std::uint32_t> beyond(const Ring& ring, std::size_t i) const {
    const auto found = owners_.find({ring[(i + 1) % ring.size()], ring[i % ring.size()]});
    if (found == owners_.end()) return std::nullopt;
    return found->second;
  }

  double length(const Ring& ring, std::size_t i) const {
    return (vertex(ring, i + 1) - vertex(ring, i)).norm();
  }

  /// Of some edges of a ring, the share of their length that no other polygon has.
  double free_share(const Ring& ring, std::size_t first, std::size_t edges) const {
    double free = 0, all = 0;
    for (std::size_t i = first; i < first + edges; ++i) {
      const double l = length(ring, i);
      all += l;
      if (!beyond(ring, i)) free += l;
    }
    return all > 0 ? free / all : 0;
  }

  /// The plane beyond an edge, if it cuts the polygon's own at an angle.
  const Plane* wall(const Ring& ring, std::size_t i, const Plane& own) const {
    const auto polygon = beyond(ring, i);
    if (!polygon) return nullptr;
    const Plane& other = map_.polygons[*polygon].plane;
    return other.normal.cross(own.normal).norm() >= min_angle_sine ? &other : nullptr;
  }

  /// Whether two planes are one as far as can be told near a place.
  static bool is_same(const Plane& a, const Plane& b, const Eigen::Vector3d& at) {
    return a.normal.dot(b.normal) >= same_plane_cosine &&
           std::abs(a.signed_distance(at) - b.signed_distance(at)) <= same_plane_offset;
  }

  const Eigen::Vector3d& vertex(const Ring& ring, std::size_t i) const {
    return map_.vertices[ring[i % ring.size()]];
  }

  void add_notches(std::uint32_t polygon, std::vector<PlaneGap>& gaps) const {
    const Plane& own = map_.polygons[polygon].plane;
    const Ring& ring = map_.polygons[polygon].outer;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Plane* const from = wall(ring, i, own);
      if (!from) continue;
      const Plane* const next = wall(ring, i + 1, own);
      if (next && is_same(*next, *from, vertex(ring, i + 1))) continue;
      add_notches_after(polygon, i + 1, *from, gaps);
    }
  }

  /// Those that begin at a vertex of the outer ring, behind an edge that it shares with `from`.
  void add_notches_after(std::uint32_t polygon, std::size_t first, const Plane& from,
                         std::vector<PlaneGap>& gaps) const {
    const Plane& own = map_.polygons[polygon].plane;
    const Ring& ring = map_.polygons[polygon].outer;
    std::vector<const Plane*> tried;
    for (std::size_t edges = 1; edges + 1 < ring.size(); ++edges) {
      const Plane* const to = wall(ring, first + edges, own);
      if (!to) continue;
      if (is_same(*to, from, vertex(ring, first + edges))) {
        add_notch(polygon, first, edges, std::nullopt, gaps);
        return;
      }
      if (std::any_of(tried.begin(), tried.end(), [&](const Plane* p) {
            return is_same(*p, *to, vertex(ring, first + edges));
          }))
        continue;
      tried.push_back(to);
      const auto corner =
          meeting(std::array{own, from, *to}, vertex(ring, first), farthest_corner, on_plane);
      if (corner && corner->rank == 3 && edges > 1)
        add_notch(polygon, first, edges, corner->point, gaps);
      if (tried.size() == most_corners) return;
    }
  }

  /// Closes a chain of edges of the outer ring by a straight line, or by two that meet in `corner`.
  void add_notch(std::uint32_t polygon, std::size_t first, std::size_t edges,
                 const std::optional<Eigen::Vector3d>& corner, std::vector<PlaneGap>& gaps) const {
    const Ring& ring = map_.polygons[polygon].outer;
    if (edges < 2 || free_share(ring, first, edges) < params_.min_free_border) return;
    Ring chain;
    for (std::size_t i = first + edges + 1; i-- > first;) chain.push_back(ring[i % ring.size()]);
    if (corner && !goes_on(ring, first, edges, *corner)) return;
    add(std::move(chain), corner, polygon, first, edges, gaps);
  }

  /// Whether the edges before and after a notch run towards the corner, and that is not far.
  bool goes_on(const Ring& ring, std::size_t first, std::size_t edges,
               const Eigen::Vector3d& corner) const {
    double chain = 0;
    for (std::size_t i = first; i < first + edges; ++i) chain += length(ring, i);
    if ((corner - vertex(ring, first)).norm() + (corner - vertex(ring, first + edges)).norm() >
        longest_way * chain)
      return false;
    const std::size_t before = first + ring.size() - 1;
    const Eigen::Vector3d &u = vertex(ring, first), &w = vertex(ring, first + edges);
    return (corner - u).dot(u - vertex(ring, before)) > 0 &&
           (w - corner).dot(vertex(ring, first + edges + 1) - w) > 0;
  }

  void add(Ring names, const std::optional<Eigen::Vector3d>& corner, std::uint32_t polygon,
           std::size_t first, std::size_t edges, std::vector<PlaneGap>& gaps) const {
    PlaneGap gap{.polygon = polygon, .names = std::move(names), .first = first, .edges = edges};
    for (const std::uint32_t v : gap.names) gap.outer.push_back(map_.vertices[v]);
    if (corner) {
      gap.names.push_back(PlaneGap::unnamed);
      gap.outer.push_back(*corner);
    }
    const PlaneFrame frame(map_.polygons[polygon].plane);
    Ring2d outer;
    for (const Eigen::Vector3d& p : gap.outer) outer.push_back(frame.flat(p));
    gap.area = signed_area(outer);
    if (!find_islands(frame, outer, gap)) return;
    if (!(gap.area >= params_.min_area && gap.area <= params_.max_area)) return;
    if (is_valid_polygon(rings_of(gap, map_, frame))) gaps.push_back(std::move(gap));
  }

  /// Other polygons in the plane, inside the gap. False if one is partly inside.
  bool find_islands(const PlaneFrame& frame, const Ring2d& outer, PlaneGap& gap) const {
    const Plane& own = map_.polygons[gap.polygon].plane;
    for (std::uint32_t p = 0; p < map_.polygons.size(); ++p) {
      const MapPolygon& other = map_.polygons[p];
      if (p == gap.polygon || !is_same(other.plane, own, map_.vertices[other.outer.front()]))
        continue;
      std::size_t inside = 0, on_border = 0;
      for (const std::uint32_t v : other.outer) {
        if (std::find(gap.names.begin(), gap.names.end(), v) != gap.names.end())
          ++on_border;
        else
          inside += is_inside(outer, frame.flat(map_.vertices[v]));
      }
      if (inside == 0) continue;
      if (on_border > 0 || inside < other.outer.size()) return false;
      gap.islands.push_back(p);
      Ring2d ring;
      for (const std::uint32_t v : other.outer) ring.push_back(frame.flat(map_.vertices[v]));
      gap.area -= signed_area(ring);
    }
    return true;
  }

  const PolygonMap& map_;
  const PlaneGapParams& params_;
  std::map<Edge, std::uint32_t> owners_;
};

}  // namespace

std::vector<PlaneGap> plane_gaps(const PolygonMap& map, const PlaneGapParams& params) {
  const GapSearch search(map, params);
  std::vector<PlaneGap> gaps;
  for (std::uint32_t p = 0; p < map.polygons.size(); ++p)
    for (PlaneGap& gap : search.of(p)) gaps.push_back(std::move(gap));
  return gaps;
}

std::vector<Ring2d> rings_of(const PlaneGap& gap, const PolygonMap& map, const PlaneFrame& frame) {
  std::vector<Ring2d> rings(1);
  for (const Eigen::Vector3d& p : gap.outer) rings.front().push_back(frame.flat(p));
  for (const std::uint32_t island : gap.islands) {
    rings.emplace_back();
    const Ring& outer = map.polygons[island].outer;
    for (auto v = outer.rbegin(); v != outer.rend(); ++v)
      rings.back().push_back(frame.flat(map.vertices[*v]));
  }
  return rings;
}

bool overlap(const PlaneGap& a, const PlaneGap& b, const PolygonMap& map) {
  if (a.polygon != b.polygon || a.edges == 0 || b.edges == 0) return false;
  const std::size_t ring = map.polygons[a.polygon].outer.size();
  const auto covers = [&](const PlaneGap& gap, std::size_t edge) {
    return (edge + ring - gap.first % ring) % ring < gap.edges;
  };
  return covers(a, b.first % ring) || covers(b, a.first % ring);
}

}  // namespace planum
