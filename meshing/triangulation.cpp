#include "meshing/triangulation.hpp"

#include <array>
#include <cmath>
#include <map>

#include "meshing/ear_clipping.hpp"
#include "meshing/geos_polygons.hpp"
#include "meshing/plane_geometry.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

double area_of(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector2d>& points) {
  double sum = 0;
  for (const Triangle& t : triangles)
    sum += std::abs(
        signed_area(std::array<Eigen::Vector2d, 3>{points[t[0]], points[t[1]], points[t[2]]}));
  return sum;
}

/// Triangles of a polygon, as indices of the map's vertices.
std::vector<Triangle> triangles_of(const MapPolygon& polygon,
                                   const std::vector<Eigen::Vector3d>& vertices) {
  const PlaneFrame frame(polygon.plane);
  std::vector<Ring2d> rings;
  std::vector<std::uint32_t> corners;
  std::vector<Eigen::Vector2d> points;
  double area = 0;
  const auto add = [&](const Ring& ring) {
    rings.emplace_back();
    for (const std::uint32_t v : ring) rings.back().push_back(frame.flat(vertices[v]));
    corners.insert(corners.end(), ring.begin(), ring.end());
    points.insert(points.end(), rings.back().begin(), rings.back().end());
    area += signed_area(rings.back());
  };
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) add(hole);
  auto triangles = constrained_delaunay(rings);
  if (!triangles || std::abs(area_of(*triangles, points) - area) > 1e-6 * std::abs(area))
    triangles = clipped_ears(rings);
  for (Triangle& t : *triangles)
    for (std::uint32_t& corner : t) corner = corners[corner];
  return *triangles;
}

/// Finds vertices again by their position.
class VertexIndex {
 public:
  explicit VertexIndex(TriangleMesh& mesh) : mesh_(mesh) {
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) known_.emplace(key(v), v);
  }

  std::uint32_t of(const Eigen::Vector3f& p) {
    const auto [at, is_new] = known_.try_emplace({p.x(), p.y(), p.z()},
                                                 static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(p);
    return at->second;
  }

 private:
  std::array<float, 3> key(std::uint32_t v) const {
    return {mesh_.vertices[v].x(), mesh_.vertices[v].y(), mesh_.vertices[v].z()};
  }

  TriangleMesh& mesh_;
  std::map<std::array<float, 3>, std::uint32_t> known_;
};

}  // namespace

TriangulatedMap triangulated(const PolygonMap& map) {
  std::vector<std::vector<Triangle>> of_polygon(map.polygons.size());
  parallel_for(map.polygons.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      of_polygon[i] = triangles_of(map.polygons[i], map.vertices);
  });
  TriangulatedMap result;
  for (const Eigen::Vector3d& v : map.vertices) result.mesh.vertices.push_back(v.cast<float>());
  for (std::uint32_t i = 0; i < of_polygon.size(); ++i)
    for (const Triangle& t : of_polygon[i]) {
      result.mesh.triangles.push_back(t);
      result.polygon.push_back(i);
    }
  VertexIndex index(result.mesh);
  std::vector<std::uint32_t> name;
  for (const Eigen::Vector3f& v : map.rest.vertices) name.push_back(index.of(v));
  for (const Triangle& t : map.rest.triangles) {
    const Triangle named{name[t[0]], name[t[1]], name[t[2]]};
    // Places that only differ beyond a float's precision are one.
    if (named[0] == named[1] || named[1] == named[2] || named[2] == named[0]) continue;
    result.mesh.triangles.push_back(named);
    result.polygon.push_back(TriangulatedMap::rest);
  }
  result.inferred.assign(result.polygon.size(), 0);
  for (const InferredPatch& patch : map.inferred)
    for (const Triangle& t : triangles_of(patch.shape, map.vertices)) {
      result.mesh.triangles.push_back(t);
      result.polygon.push_back(patch.polygon);
      result.inferred.push_back(1);
    }
  return result;
}

}  // namespace planum
