#include "meshing/laser_shadows.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "meshing/geos_polygons.hpp"
#include "meshing/plane_geometry.hpp"
#include "meshing/plane_meeting.hpp"
#include "meshing/scan_indices.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t maps_at_once = 32;
constexpr double most_samples = 300;                // of one hole
constexpr double beside = 0.08, border_step = 0.1;  // m, of places on the polygon around a hole
constexpr double min_border_seen = 0.25;    // share of these that a scan sees, to miss the rest
constexpr std::size_t most_corners = 6;     // neighbours tried for the other side of a corner
constexpr double same_plane_cosine = 0.99;  // about 8 degrees
constexpr double same_plane_offset = 0.03;  // m
constexpr double min_angle_sine = 0.5;      // of planes whose line closes a notch: 30 degrees
constexpr double longest_way = 1.5;         // around a corner, against the border of the notch
constexpr double on_plane = 1e-3;           // m, of a vertex that two planes share

void check(const Cloud& cloud, std::span<const Eigen::Vector3d> origins,
           const ShadowParams& params) {
  const auto fail = [](const std::string& what) { throw Error("laser shadows: " + what); };
  if (!(params.max_area >= 0))
    fail("max_area must be at least 0, is " + std::to_string(params.max_area) + " m2");
  if (!(params.sample > 0))
    fail("sample must be positive, is " + std::to_string(params.sample) + " m");
  check_scan_indices(cloud, origins.size(), "laser shadows");
}

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

/// A hole or a notch that may be a shadow.
struct Gap {
  std::uint32_t polygon = 0;
  std::vector<Eigen::Vector3d> outer = {};  ///< counter-clockwise seen from free space
  Ring names = {};                          ///< vertices of the map, or `unnamed` for a new corner
  std::size_t first = 0, edges = 0;         ///< of the outer ring; 0 edges: a hole
  std::vector<std::uint32_t> islands = {};  ///< polygons in the same plane inside
  double area = 0;                          ///< m^2, without islands
};
constexpr std::uint32_t unnamed = 0xffffffffu;

class GapSearch {
 public:
  GapSearch(const PolygonMap& map, const ShadowParams& params)
      : map_(map), params_(params), owners_(owners_of_edges(map)) {}

  std::vector<Gap> of(std::uint32_t polygon) const {
    std::vector<Gap> gaps;
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
    return (map_.vertices[ring[(i + 1) % ring.size()]] - map_.vertices[ring[i % ring.size()]])
        .norm();
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

  static bool is_same(const Plane& a, const Plane& b) {
    return a.normal.dot(b.normal) >= same_plane_cosine &&
           std::abs(a.offset - b.offset) <= same_plane_offset;
  }

  void add_notches(std::uint32_t polygon, std::vector<Gap>& gaps) const {
    const Plane& own = map_.polygons[polygon].plane;
    const Ring& ring = map_.polygons[polygon].outer;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Plane* const from = wall(ring, i, own);
      if (!from) continue;
      const Plane* const next = wall(ring, i + 1, own);
      if (next && is_same(*next, *from)) continue;
      add_notches_after(polygon, i + 1, *from, gaps);
    }
  }

  /// Those that begin at a vertex of the outer ring, behind an edge that it shares with `from`.
  void add_notches_after(std::uint32_t polygon, std::size_t first, const Plane& from,
                         std::vector<Gap>& gaps) const {
    const Plane& own = map_.polygons[polygon].plane;
    const Ring& ring = map_.polygons[polygon].outer;
    std::vector<const Plane*> tried;
    for (std::size_t edges = 1; edges + 1 < ring.size(); ++edges) {
      const Plane* const to = wall(ring, first + edges, own);
      if (!to) continue;
      if (is_same(*to, from)) {
        add_notch(polygon, first, edges, std::nullopt, gaps);
        return;
      }
      if (std::any_of(tried.begin(), tried.end(), [&](const Plane* p) { return is_same(*p, *to); }))
        continue;
      tried.push_back(to);
      const Eigen::Vector3d& start = map_.vertices[ring[first % ring.size()]];
      const auto corner = meeting(std::array{own, from, *to}, start, 10, on_plane);
      if (corner && corner->rank == 3 && edges > 1)
        add_notch(polygon, first, edges, corner->point, gaps);
      if (tried.size() == most_corners) return;
    }
  }

  /// Closes a chain of edges of the outer ring by a straight line, or by two that meet in `corner`.
  void add_notch(std::uint32_t polygon, std::size_t first, std::size_t edges,
                 const std::optional<Eigen::Vector3d>& corner, std::vector<Gap>& gaps) const {
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
    const auto at = [&](std::size_t i) -> const Eigen::Vector3d& {
      return map_.vertices[ring[i % ring.size()]];
    };
    double chain = 0;
    for (std::size_t i = first; i < first + edges; ++i) chain += length(ring, i);
    if ((corner - at(first)).norm() + (corner - at(first + edges)).norm() > longest_way * chain)
      return false;
    const std::size_t before = first + ring.size() - 1;
    return (corner - at(first)).dot(at(first) - at(before)) > 0 &&
           (at(first + edges) - corner).dot(at(first + edges + 1) - at(first + edges)) > 0;
  }

  void add(Ring names, const std::optional<Eigen::Vector3d>& corner, std::uint32_t polygon,
           std::size_t first, std::size_t edges, std::vector<Gap>& gaps) const {
    Gap gap{.polygon = polygon, .names = std::move(names), .first = first, .edges = edges};
    for (const std::uint32_t v : gap.names) gap.outer.push_back(map_.vertices[v]);
    if (corner) {
      gap.names.push_back(unnamed);
      gap.outer.push_back(*corner);
    }
    const PlaneFrame frame(map_.polygons[polygon].plane);
    Ring2d outer;
    for (const Eigen::Vector3d& p : gap.outer) outer.push_back(frame.flat(p));
    gap.area = signed_area(outer);
    if (!find_islands(frame, outer, gap)) return;
    if (!(gap.area >= params_.min_area && gap.area <= params_.max_area)) return;
    if (is_valid_polygon(rings_of(gap, frame))) gaps.push_back(std::move(gap));
  }

  /// Other polygons in the plane, inside the gap. False if one is partly inside.
  bool find_islands(const PlaneFrame& frame, const Ring2d& outer, Gap& gap) const {
    const Plane& own = map_.polygons[gap.polygon].plane;
    for (std::uint32_t p = 0; p < map_.polygons.size(); ++p) {
      const MapPolygon& other = map_.polygons[p];
      if (p == gap.polygon || !is_same(other.plane, own)) continue;
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

 public:
  /// In the plane: the outer ring, then the islands.
  std::vector<Ring2d> rings_of(const Gap& gap, const PlaneFrame& frame) const {
    std::vector<Ring2d> rings(1);
    for (const Eigen::Vector3d& p : gap.outer) rings.front().push_back(frame.flat(p));
    for (const std::uint32_t island : gap.islands) {
      rings.emplace_back();
      const Ring& outer = map_.polygons[island].outer;
      for (auto v = outer.rbegin(); v != outer.rend(); ++v)
        rings.back().push_back(frame.flat(map_.vertices[*v]));
    }
    return rings;
  }

 private:
  const PolygonMap& map_;
  const ShadowParams& params_;
  std::map<Edge, std::uint32_t> owners_;
};

/// A place in a gap, and what all scans together say about it.
struct Sample {
  Eigen::Vector3f place = Eigen::Vector3f::Zero();
  bool before = false, at = false, through = false, lost = false;
};

/// Where a gap is judged.
struct GapSamples {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  std::vector<Sample> inside;
  std::vector<Eigen::Vector3f> border;  ///< on the polygon, just beside the gap
};

std::vector<Sample> samples_inside(const std::vector<Ring2d>& rings, const PlaneFrame& frame,
                                   double step) {
  Eigen::Array2d low = rings.front().front(), high = low;
  for (const Eigen::Vector2d& p : rings.front()) {
    low = low.min(p.array());
    high = high.max(p.array());
  }
  std::vector<Sample> samples;
  for (double y = low.y() + step / 2; y < high.y(); y += step)
    for (double x = low.x() + step / 2; x < high.x(); x += step) {
      const Eigen::Vector2d p(x, y);
      if (is_inside(rings.front(), p) &&
          std::none_of(rings.begin() + 1, rings.end(),
                       [&](const Ring2d& island) { return is_inside(island, p); }))
        samples.push_back({.place = frame.raised(p).cast<float>()});
    }
  return samples;
}

/// Beside the edges of the polygon; those that close a notch have nothing beside them.
std::vector<Eigen::Vector3f> samples_beside(const Gap& gap, const Ring2d& outer,
                                            const PlaneFrame& frame) {
  const std::size_t edges = gap.edges > 0 ? gap.edges : outer.size();
  std::vector<Eigen::Vector3f> places;
  for (std::size_t i = 0; i < edges; ++i) {
    const Eigen::Vector2d &a = outer[i], along = outer[(i + 1) % outer.size()] - a;
    const double length = along.norm();
    if (!(length > 0)) continue;
    const Eigen::Vector2d outwards = Eigen::Vector2d(along.y(), -along.x()) / length;
    const double count = std::ceil(length / border_step);
    for (double k = 0.5; k < count; ++k) {
      const Eigen::Vector2d p = a + k / count * along + beside * outwards;
      places.push_back(frame.raised(p).cast<float>());
    }
  }
  return places;
}

GapSamples samples_of(const Gap& gap, const std::vector<Ring2d>& rings, const Plane& plane,
                      double distance) {
  const PlaneFrame frame(plane);
  const double step = std::max(distance, std::sqrt(gap.area / most_samples));
  return {.normal = plane.normal.cast<float>(),
          .inside = samples_inside(rings, frame, step),
          .border = samples_beside(gap, rings.front(), frame)};
}

/// Whether a scan sees the polygon beside the gap, so that rays into the gap should come back.
bool sees_border(const RangeMap& map, const SightParams& params, const GapSamples& gap) {
  double seen = 0;
  for (const Eigen::Vector3f& place : gap.border)
    seen += map.sight(place, gap.normal, params) == Sight::at;
  return seen >= min_border_seen * static_cast<double>(gap.border.size());
}

/// Adds what one scan says.
void look(const RangeMap& map, const SightParams& params, GapSamples& gap) {
  if (gap.border.empty()) return;
  const Eigen::Vector3f way = map.origin() - gap.border.front();
  if (gap.normal.dot(way) <= 0 || way.norm() > map.farthest()) return;
  const bool is_witness = sees_border(map, params, gap);
  for (Sample& s : gap.inside) {
    const Sight sight = map.sight(s.place, gap.normal, params);
    s.before |= sight == Sight::before;
    s.at |= sight == Sight::at;
    s.through |= sight == Sight::through;
    s.lost |= sight == Sight::lost && is_witness;
  }
}

void look(std::vector<GapSamples>& gaps, const Cloud& cloud,
          std::span<const Eigen::Vector3d> origins, const SightParams& params) {
  const auto own = points_of_scans(cloud, origins.size());
  for (std::size_t first = 0; first < origins.size(); first += maps_at_once) {
    std::vector<RangeMap> maps(std::min(maps_at_once, origins.size() - first));
    parallel_for(maps.size(), 1, [&](std::size_t k, std::size_t) {
      maps[k] = RangeMap(cloud.points, own[first + k], origins[first + k]);
    });
    parallel_for(gaps.size(), 1, [&](std::size_t g, std::size_t) {
      for (const RangeMap& map : maps) look(map, params, gaps[g]);
    });
  }
}

bool is_shadow(const std::vector<Sample>& samples, const ShadowParams& params) {
  double open = 0, hidden = 0, known = 0;
  for (const Sample& s : samples) {
    const bool is_open = s.through || s.lost;
    open += is_open;
    hidden += s.before && !s.at && !is_open;
    known += s.before || s.at || s.through;
  }
  const auto all = static_cast<double>(samples.size());
  return all > 0 && open <= params.max_open * all && hidden >= params.min_hidden * all &&
         known >= params.min_known * all;
}

/// Whether two gaps have an edge of the outer ring in common.
bool overlap(const Gap& a, const Gap& b, std::size_t ring_edges) {
  if (a.polygon != b.polygon || a.edges == 0 || b.edges == 0) return false;
  const auto covers = [&](const Gap& gap, std::size_t edge) {
    return (edge + ring_edges - gap.first % ring_edges) % ring_edges < gap.edges;
  };
  return covers(a, b.first % ring_edges) || covers(b, a.first % ring_edges);
}

InferredPatch patch_of(const Gap& gap, PolygonMap& map) {
  InferredPatch patch{.polygon = gap.polygon,
                      .shape = {map.polygons[gap.polygon].plane, gap.names, {}, gap.area}};
  for (std::size_t i = 0; i < gap.names.size(); ++i) {
    if (gap.names[i] != unnamed) continue;
    patch.shape.outer[i] = static_cast<std::uint32_t>(map.vertices.size());
    map.vertices.push_back(gap.outer[i]);
  }
  for (const std::uint32_t island : gap.islands) {
    const Ring& outer = map.polygons[island].outer;
    patch.shape.holes.emplace_back(outer.rbegin(), outer.rend());
  }
  return patch;
}

}  // namespace

PolygonMap with_shadows_filled(PolygonMap map, const Cloud& cloud,
                               std::span<const Eigen::Vector3d> origins,
                               const ShadowParams& params) {
  check(cloud, origins, params);
  map.inferred.clear();
  if (params.max_area == 0) return map;
  const GapSearch search(map, params);
  std::vector<Gap> gaps;
  for (std::uint32_t p = 0; p < map.polygons.size(); ++p)
    for (Gap& gap : search.of(p)) gaps.push_back(std::move(gap));
  std::stable_sort(gaps.begin(), gaps.end(),
                   [](const Gap& a, const Gap& b) { return a.area > b.area; });
  std::vector<GapSamples> samples;
  for (const Gap& gap : gaps) {
    const Plane& plane = map.polygons[gap.polygon].plane;
    samples.push_back(
        samples_of(gap, search.rings_of(gap, PlaneFrame(plane)), plane, params.sample));
  }
  look(samples, cloud, origins, params.sight);
  std::vector<const Gap*> filled;
  for (std::uint32_t g = 0; g < gaps.size(); ++g) {
    if (!is_shadow(samples[g].inside, params)) continue;
    const std::size_t ring = map.polygons[gaps[g].polygon].outer.size();
    if (std::none_of(filled.begin(), filled.end(),
                     [&](const Gap* other) { return overlap(gaps[g], *other, ring); }))
      filled.push_back(&gaps[g]);
  }
  for (const Gap* gap : filled) map.inferred.push_back(patch_of(*gap, map));
  return map;
}

}  // namespace planum
