#include "meshing/polygons.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "meshing/border_lenses.hpp"
#include "meshing/border_repair.hpp"
#include "meshing/components.hpp"
#include "meshing/creases.hpp"
#include "meshing/face_geometry.hpp"
#include "meshing/gap_closing.hpp"
#include "meshing/geos_polygons.hpp"
#include "meshing/half_edge.hpp"
#include "meshing/plane_geometry.hpp"
#include "meshing/polygon_drafts.hpp"
#include "meshing/rest_surface.hpp"
#include "meshing/surface_reduction.hpp"
#include "slam/core/error.hpp"

namespace planum {
namespace {

void check(const TriangleMesh& mesh, const Regions& regions, const PolygonParams& params) {
  if (regions.of_triangle.size() != mesh.triangles.size())
    throw Error("polygons: the regions are of a mesh of " +
                std::to_string(regions.of_triangle.size()) + " triangles, this one has " +
                std::to_string(mesh.triangles.size()));
  for (const std::uint32_t label : regions.of_triangle)
    if (label != Regions::rest && label >= regions.regions.size())
      throw Error("polygons: a triangle is in region " + std::to_string(label) + " of " +
                  std::to_string(regions.regions.size()));
  const auto not_negative = [](const char* name, double value) {
    if (!(value >= 0))
      throw Error("polygons: " + std::string(name) + " is " + std::to_string(value) +
                  ", must be at least 0");
  };
  not_negative("max_error", params.max_error);
  not_negative("max_move", params.max_move);
  not_negative("crease_reach", params.crease_reach);
  not_negative("max_gap", params.max_gap);
  not_negative("min_component", params.min_component);
  not_negative("min_hole", params.min_hole);
  not_negative("rest_error", params.rest_error);
}

BorderNetwork border_network(TriangleMesh& mesh, Regions regions, HalfEdges& edges,
                             const PolygonParams& params) {
  close_gaps(mesh, edges, params.max_gap);
  regions.of_triangle.resize(mesh.triangles.size(), Regions::rest);
  BorderNetwork network;
  network.regions = regions.regions;
  network.labels =
      closed_creases(regions, edges, face_geometry(mesh),
                     {.reach = params.crease_reach, .min_component = params.min_component});
  network.component_of = components(edges, network.labels).of_triangle;
  network.chains = border_chains(edges, network.labels);
  network.rings = border_rings(edges, network.labels, network.chains);
  network.corners =
      snapped_corners(regions.regions, mesh, edges, network.labels, {.max_move = params.max_move});
  for (const BorderChain& chain : network.chains) {
    network.shapes.push_back(chain_shape(chain, edges, network.corners, regions.regions));
    simplify(network.shapes.back(), network.corners.points, params.max_error);
  }
  return network;
}

/// Gives snapped points their places in the map when a polygon first uses them.
class MapBuilder {
 public:
  MapBuilder(const std::vector<Eigen::Vector3d>& points)
      : points_(points), name_(points.size(), HalfEdges::none) {}

  void add(const PolygonDraft& draft, const Plane& plane) {
    std::vector<Ring> rings;
    for (const Ring& ring : draft.rings) {
      rings.emplace_back();
      for (const std::uint32_t v : ring) rings.back().push_back(named(v));
    }
    add(rings, plane);
  }

  /// A draft that crosses itself in spite of all: what it covers. Crossings become new vertices.
  /// Returns the pieces smaller than min_area.
  std::vector<std::vector<Ring2d>> add_made_valid(const PolygonDraft& draft, const Plane& plane,
                                                  double min_area) {
    const PlaneFrame frame(plane);
    std::map<std::pair<double, double>, std::uint32_t> corners;
    for (const Ring& ring : draft.rings)
      for (const std::uint32_t v : ring) {
        const Eigen::Vector2d p = frame.flat(points_[v]);
        corners.emplace(std::pair(p.x(), p.y()), v);
      }
    std::vector<std::vector<Ring2d>> scraps;
    for (std::vector<Ring2d>& piece : made_valid(flat_rings(draft.rings, plane, points_))) {
      double area = 0;
      for (const Ring2d& ring : piece) area += signed_area(ring);
      if (area < min_area) {
        scraps.push_back(std::move(piece));
        continue;
      }
      std::vector<Ring> rings;
      for (const Ring2d& ring : piece) {
        rings.emplace_back();
        for (const Eigen::Vector2d& p : ring) {
          const auto known = corners.find({p.x(), p.y()});
          rings.back().push_back(known != corners.end() ? named(known->second)
                                                        : added(frame.raised(p)));
        }
      }
      add(rings, plane);
    }
    return scraps;
  }

  PolygonMap built() {
    std::stable_sort(map_.polygons.begin(), map_.polygons.end(),
                     [](const MapPolygon& a, const MapPolygon& b) { return a.area > b.area; });
    return std::move(map_);
  }

 private:
  std::uint32_t added(const Eigen::Vector3d& vertex) {
    map_.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(map_.vertices.size() - 1);
  }

  std::uint32_t named(std::uint32_t point) {
    if (name_[point] == HalfEdges::none) name_[point] = added(points_[point]);
    return name_[point];
  }

  void add(const std::vector<Ring>& rings, const Plane& plane) {
    MapPolygon polygon{plane, rings.front(), {rings.begin() + 1, rings.end()}, 0};
    for (const Ring2d& ring : flat_rings(rings, plane, map_.vertices))
      polygon.area += signed_area(ring);
    map_.polygons.push_back(std::move(polygon));
  }

  const std::vector<Eigen::Vector3d>& points_;
  std::vector<std::uint32_t> name_;
  PolygonMap map_;
};

/// What is too small to be a polygon goes to the rest; `corners` are the points of all rings.
void add_scrap(RestSurface& rest, std::span<const Ring2d> rings, const Ring& corners) {
  const auto triangles = constrained_delaunay(rings);
  if (!triangles) return;
  for (const auto& t : *triangles)
    rest.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
}

void add_scrap(RestSurface& rest, const PolygonDraft& draft, const Plane& plane) {
  Ring corners;
  for (const Ring& ring : draft.rings) corners.insert(corners.end(), ring.begin(), ring.end());
  add_scrap(rest, flat_rings(draft.rings, plane, rest.points), corners);
}

void add_scrap(RestSurface& rest, std::span<const Ring2d> rings, const Plane& plane) {
  const PlaneFrame frame(plane);
  Ring corners;
  for (const Ring2d& ring : rings)
    for (const Eigen::Vector2d& p : ring) {
      corners.push_back(static_cast<std::uint32_t>(rest.points.size()));
      rest.points.push_back(frame.raised(p));
    }
  add_scrap(rest, rings, corners);
}

TriangleMesh mesh_of(const RestSurface& rest) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> name(rest.points.size(), HalfEdges::none);
  for (auto t : rest.triangles) {
    for (std::uint32_t& p : t) {
      if (name[p] == HalfEdges::none) {
        name[p] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(rest.points[p].cast<float>());
      }
      p = name[p];
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

/// Triangles that lie on each other and face opposite ways enclose nothing; of those that face the
/// same way one is enough.
void drop_folded_pairs(RestSurface& rest) {
  std::map<std::array<std::uint32_t, 3>, int> sides;  // by corners, the least first
  const auto turned = [](const std::array<std::uint32_t, 3>& t) {
    std::array<std::uint32_t, 3> key = t;
    std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
    const bool is_even = key[1] < key[2];
    if (!is_even) std::swap(key[1], key[2]);
    return std::pair(key, is_even ? 1 : -1);
  };
  for (const auto& t : rest.triangles) {
    const auto [key, side] = turned(t);
    sides[key] += side;
  }
  std::erase_if(rest.triangles, [&](const auto& t) {
    const auto [key, side] = turned(t);
    int& left = sides[key];
    if (left * side <= 0) return true;
    left = 0;
    return false;
  });
}

/// Takes vertices out of the rest that no polygon shares.
void reduce(RestSurface& rest, std::size_t shared_points, double max_error) {
  std::vector<bool> fixed(rest.points.size(), false);
  std::fill_n(fixed.begin(), shared_points, true);
  drop_folded_pairs(rest);
  rest.triangles = reduced_surface(rest.points, rest.triangles, fixed, max_error);
  drop_folded_pairs(rest);
}

PolygonMap finished(BorderNetwork& network, RestSurface& rest, const DraftParams& params,
                    double rest_error) {
  std::copy_n(rest.points.begin(), network.corners.points.size(), network.corners.points.begin());
  MapBuilder builder(network.corners.points);
  for (const PolygonDraft& draft : polygon_drafts(network, params)) {
    const Plane& plane = network.regions[draft.region].plane;
    if (draft.is_scrap)
      add_scrap(rest, draft, plane);
    else if (is_valid_polygon(flat_rings(draft.rings, plane, network.corners.points)))
      builder.add(draft, plane);
    else
      for (const auto& scrap : builder.add_made_valid(draft, plane, params.min_area))
        add_scrap(rest, scrap, plane);
  }
  reduce(rest, network.corners.points.size(), rest_error);
  PolygonMap map = builder.built();
  map.rest = mesh_of(rest);
  close_lenses(map, params.min_area);
  return map;
}

}  // namespace

PolygonParams polygon_params(double cell) {
  PolygonParams params;
  const double scale = cell / 0.05;
  params.max_error *= scale;
  params.max_move *= scale;
  params.crease_reach *= scale;
  params.max_gap *= scale;
  params.rest_error *= scale;
  params.min_component *= scale * scale;
  params.min_hole *= scale * scale;
  return params;
}

PolygonMap polygonize(const TriangleMesh& mesh, const Regions& regions,
                      const PolygonParams& params) {
  check(mesh, regions, params);
  const DraftParams draft_params{.min_hole = params.min_hole, .min_area = params.min_component};
  TriangleMesh whole = mesh;
  HalfEdges edges = half_edges(mesh);
  BorderNetwork network = border_network(whole, regions, edges, params);
  uncross_borders(network, draft_params, params.max_error);
  RestSurface rest = rest_surface(whole, edges, network.labels, network.corners, network.shapes);
  return finished(network, rest, draft_params, params.rest_error);
}

}  // namespace planum
