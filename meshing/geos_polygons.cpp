#include "meshing/geos_polygons.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <geos_c.h>

namespace planum {
namespace {

/// One GEOS context a thread: they must not be shared.
GEOSContextHandle_t context() {
  struct Release {
    void operator()(GEOSContextHandle_HS* handle) const { GEOS_finish_r(handle); }
  };
  thread_local const std::unique_ptr<GEOSContextHandle_HS, Release> handle(GEOS_init_r());
  return handle.get();
}

struct Destroy {
  void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(context(), geometry); }
};
using Geometry = std::unique_ptr<GEOSGeometry, Destroy>;

Geometry linear_ring(const Ring2d& ring) {
  const auto count = static_cast<unsigned>(ring.size());
  GEOSCoordSequence* points = GEOSCoordSeq_create_r(context(), count + 1, 2);
  for (unsigned i = 0; i <= count; ++i)
    GEOSCoordSeq_setXY_r(context(), points, i, ring[i % count].x(), ring[i % count].y());
  return Geometry(GEOSGeom_createLinearRing_r(context(), points));
}

/// Null if a ring is none.
Geometry polygon(std::span<const Ring2d> rings) {
  for (const Ring2d& ring : rings)
    if (ring.size() < 3) return nullptr;
  if (rings.empty()) return nullptr;
  Geometry outer = linear_ring(rings.front());
  if (!outer) return nullptr;
  std::vector<GEOSGeometry*> holes;
  for (const Ring2d& ring : rings.subspan(1)) holes.push_back(linear_ring(ring).release());
  return Geometry(GEOSGeom_createPolygon_r(context(), outer.release(), holes.data(),
                                           static_cast<unsigned>(holes.size())));
}

Ring2d positions_of(const GEOSGeometry* ring) {
  Ring2d result;
  const GEOSCoordSequence* points = ring ? GEOSGeom_getCoordSeq_r(context(), ring) : nullptr;
  unsigned count = 0;
  if (!points || !GEOSCoordSeq_getSize_r(context(), points, &count) || count < 4) return result;
  result.resize(count - 1);  // GEOS repeats the first
  for (unsigned i = 0; i + 1 < count; ++i)
    GEOSCoordSeq_getXY_r(context(), points, i, &result[i].x(), &result[i].y());
  return result;
}

/// Adds the polygons in a geometry, in collections too.
void collect_polygons(const GEOSGeometry* shape, std::vector<std::vector<Ring2d>>& polygons) {
  const int kind = GEOSGeomTypeId_r(context(), shape);
  if (kind == GEOS_POLYGON) {
    std::vector<Ring2d> rings{positions_of(GEOSGetExteriorRing_r(context(), shape))};
    for (int i = 0; i < GEOSGetNumInteriorRings_r(context(), shape); ++i)
      rings.push_back(positions_of(GEOSGetInteriorRingN_r(context(), shape, i)));
    for (Ring2d& ring : rings)
      if ((signed_area(ring) > 0) != (&ring == &rings.front()))
        std::reverse(ring.begin(), ring.end());
    if (!rings.front().empty()) polygons.push_back(std::move(rings));
  } else if (kind == GEOS_MULTIPOLYGON || kind == GEOS_GEOMETRYCOLLECTION) {
    for (int i = 0; i < GEOSGetNumGeometries_r(context(), shape); ++i)
      collect_polygons(GEOSGetGeometryN_r(context(), shape, i), polygons);
  }
}

/// The corners of all rings sorted by coordinates, to find them again.
class Corners {
 public:
  explicit Corners(std::span<const Ring2d> rings) {
    for (const Ring2d& ring : rings)
      for (const Eigen::Vector2d& p : ring)
        sorted_.push_back({p.x(), p.y(), static_cast<std::uint32_t>(sorted_.size())});
    std::sort(sorted_.begin(), sorted_.end());
  }

  std::optional<std::uint32_t> find(double x, double y) const {
    const auto at = std::lower_bound(sorted_.begin(), sorted_.end(), Corner{x, y, 0});
    if (at == sorted_.end() || at->x != x || at->y != y) return std::nullopt;
    return at->index;
  }

 private:
  struct Corner {
    double x, y;
    std::uint32_t index;
    bool operator<(const Corner& other) const {
      if (x != other.x) return x < other.x;
      return y != other.y ? y < other.y : index < other.index;
    }
  };
  std::vector<Corner> sorted_;
};

std::optional<std::array<std::uint32_t, 3>> corners_of(const GEOSGeometry* triangle,
                                                       const Corners& corners) {
  const Ring2d positions = positions_of(GEOSGetExteriorRing_r(context(), triangle));
  if (positions.size() != 3) return std::nullopt;
  std::array<std::uint32_t, 3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto corner = corners.find(positions[i].x(), positions[i].y());
    if (!corner) return std::nullopt;
    result[i] = *corner;
  }
  if (signed_area(positions) < 0) std::swap(result[1], result[2]);
  return result;
}

}  // namespace

bool is_valid_polygon(std::span<const Ring2d> rings) {
  const Geometry shape = polygon(rings);
  return shape && GEOSisValid_r(context(), shape.get()) == 1;
}

std::optional<std::vector<std::array<std::uint32_t, 3>>> constrained_delaunay(
    std::span<const Ring2d> rings) {
  const Geometry shape = polygon(rings);
  if (!shape) return std::nullopt;
  const Geometry pieces(GEOSConstrainedDelaunayTriangulation_r(context(), shape.get()));
  if (!pieces) return std::nullopt;
  const Corners corners(rings);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int i = 0; i < GEOSGetNumGeometries_r(context(), pieces.get()); ++i) {
    const auto triangle = corners_of(GEOSGetGeometryN_r(context(), pieces.get(), i), corners);
    if (!triangle) return std::nullopt;
    triangles.push_back(*triangle);
  }
  return triangles;
}

std::vector<std::vector<Ring2d>> made_valid(std::span<const Ring2d> rings) {
  std::vector<std::vector<Ring2d>> polygons;
  const Geometry shape = polygon(rings);
  if (!shape) return polygons;
  const Geometry valid(GEOSMakeValid_r(context(), shape.get()));
  if (valid) collect_polygons(valid.get(), polygons);
  return polygons;
}

}  // namespace planum
