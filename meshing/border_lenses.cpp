#include "meshing/border_lenses.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "meshing/geos_polygons.hpp"
#include "meshing/plane_geometry.hpp"
#include "meshing/polygon_drafts.hpp"

namespace planum {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

template <typename Visit>
void each_ring(MapPolygon& polygon, Visit&& visit) {
  visit(polygon.outer);
  for (Ring& hole : polygon.holes) visit(hole);
}

class LensCloser {
 public:
  LensCloser(PolygonMap& map, double max_area) : map_(map), max_area_(max_area) {
    uses_.assign(map.vertices.size(), 0);
    for (MapPolygon& polygon : map.polygons)
      each_ring(polygon, [&](const Ring& ring) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
          ++uses_[ring[i]];
          edges_.insert({ring[i], ring[(i + 1) % ring.size()]});
        }
      });
    std::set<std::array<float, 3>> rest;
    for (const Eigen::Vector3f& v : map.rest.vertices) rest.insert({v.x(), v.y(), v.z()});
    for (std::uint32_t v = 0; v < map.vertices.size(); ++v) {
      const Eigen::Vector3f p = map.vertices[v].cast<float>();
      uses_[v] += static_cast<int>(rest.count({p.x(), p.y(), p.z()}));
    }
  }

  void close() {
    for (MapPolygon& polygon : map_.polygons)
      each_ring(polygon, [&](Ring& ring) {
        for (std::size_t i = 0; i < ring.size() && ring.size() > 3;) i += !drop(polygon, ring, i);
      });
  }

 private:
  /// Takes a vertex out of a ring if it is the tip of a lens.
  bool drop(MapPolygon& polygon, Ring& ring, std::size_t i) {
    const std::uint32_t u = ring[(i + ring.size() - 1) % ring.size()], m = ring[i];
    const std::uint32_t w = ring[(i + 1) % ring.size()];
    if (uses_[m] != 1 || !edges_.contains({w, u}) || edges_.contains({u, w})) return false;
    const PlaneFrame frame(polygon.plane);
    const Ring2d tip{frame.flat(map_.vertices[u]), frame.flat(map_.vertices[m]),
                     frame.flat(map_.vertices[w])};
    const double area = signed_area(tip);
    if (!(std::abs(area) < max_area_)) return false;
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
    if (!is_valid(polygon)) {
      ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(i), m);
      return false;
    }
    polygon.area -= area;
    edges_.erase({u, m});
    edges_.erase({m, w});
    edges_.insert({u, w});
    return true;
  }

  bool is_valid(const MapPolygon& polygon) const {
    std::vector<Ring> rings{polygon.outer};
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
    return is_valid_polygon(flat_rings(rings, polygon.plane, map_.vertices));
  }

  PolygonMap& map_;
  double max_area_;
  std::vector<int> uses_;  ///< per vertex, by rings and by the rest
  std::set<Edge> edges_;   ///< in the direction of the rings
};

void drop_unused_vertices(PolygonMap& map) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> name(map.vertices.size(), unused);
  for (MapPolygon& polygon : map.polygons)
    each_ring(polygon, [&](const Ring& ring) {
      for (const std::uint32_t v : ring) name[v] = 0;
    });
  std::uint32_t count = 0;
  for (std::uint32_t v = 0; v < name.size(); ++v) {
    if (name[v] == unused) continue;
    name[v] = count;
    map.vertices[count++] = map.vertices[v];
  }
  map.vertices.resize(count);
  for (MapPolygon& polygon : map.polygons)
    each_ring(polygon, [&](Ring& ring) {
      for (std::uint32_t& v : ring) v = name[v];
    });
}

}  // namespace

void close_lenses(PolygonMap& map, double max_area) {
  LensCloser(map, max_area).close();
  drop_unused_vertices(map);
}

}  // namespace planum
