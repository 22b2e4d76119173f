#include "slam/sensor/plan_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <geos_c.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

double signed_area(const std::vector<Eigen::Vector2d>& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& a = ring[i];
    const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return twice / 2;
}

std::vector<Eigen::Vector2d> turned(std::vector<Eigen::Vector2d> ring, bool counter_clockwise) {
  const double area = signed_area(ring);
  if (ring.size() < 3 || area == 0)
    throw Error(fmt::format("a ring of {} corners has no area", ring.size()));
  if ((area > 0) != counter_clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

/// The thread-safe interface of GEOS wants a context for everything.
class Geos {
 public:
  Geos() : context_(GEOS_init_r(), GEOS_finish_r) {}

  using Geometry = std::unique_ptr<GEOSGeometry, std::function<void(GEOSGeometry*)>>;

  Geometry own(GEOSGeometry* geometry) const {
    if (!geometry) throw Error("the polygon cannot be triangulated (GEOS)");
    GEOSContextHandle_t context = context_.get();
    return {geometry, [context](GEOSGeometry* g) { GEOSGeom_destroy_r(context, g); }};
  }

  GEOSGeometry* new_ring(const std::vector<Eigen::Vector2d>& corners) const {
    const auto count = static_cast<unsigned int>(corners.size());
    GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(context_.get(), count + 1, 2);
    for (unsigned int i = 0; i <= count; ++i)
      GEOSCoordSeq_setXY_r(context_.get(), sequence, i, corners[i % count].x(),
                           corners[i % count].y());
    return GEOSGeom_createLinearRing_r(context_.get(), sequence);
  }

  Geometry polygon(const PlanPolygon& polygon) const {
    std::vector<GEOSGeometry*> holes;
    for (const auto& hole : polygon.holes) holes.push_back(new_ring(hole));
    return own(GEOSGeom_createPolygon_r(context_.get(), new_ring(polygon.outer), holes.data(),
                                        static_cast<unsigned int>(holes.size())));
  }

  GEOSContextHandle_t context() const { return context_.get(); }

 private:
  std::unique_ptr<GEOSContextHandle_HS, void (*)(GEOSContextHandle_t)> context_;
};

std::array<Eigen::Vector2d, 3> corners_of(const Geos& geos, const GEOSGeometry* triangle) {
  const GEOSCoordSequence* sequence =
      GEOSGeom_getCoordSeq_r(geos.context(), GEOSGetExteriorRing_r(geos.context(), triangle));
  std::array<Eigen::Vector2d, 3> corners;
  for (unsigned int i = 0; i < 3; ++i)
    GEOSCoordSeq_getXY_r(geos.context(), sequence, i, &corners[i].x(), &corners[i].y());
  if (signed_area({corners.begin(), corners.end()}) < 0) std::swap(corners[1], corners[2]);
  return corners;
}

}  // namespace

PlanPolygon oriented(const PlanPolygon& polygon) {
  PlanPolygon result;
  result.outer = turned(polygon.outer, true);
  for (const auto& hole : polygon.holes) result.holes.push_back(turned(hole, false));
  return result;
}

double area(const PlanPolygon& polygon) {
  double sum = std::abs(signed_area(polygon.outer));
  for (const auto& hole : polygon.holes) sum -= std::abs(signed_area(hole));
  return sum;
}

std::vector<std::array<Eigen::Vector2d, 3>> triangulated(const PlanPolygon& polygon) {
  const Geos geos;
  const auto input = geos.polygon(oriented(polygon));
  if (GEOSisValid_r(geos.context(), input.get()) != 1)
    throw Error("the rings of the polygon cross or touch");
  const auto triangles =
      geos.own(GEOSConstrainedDelaunayTriangulation_r(geos.context(), input.get()));
  std::vector<std::array<Eigen::Vector2d, 3>> result;
  const int count = GEOSGetNumGeometries_r(geos.context(), triangles.get());
  for (int i = 0; i < count; ++i)
    result.push_back(corners_of(geos, GEOSGetGeometryN_r(geos.context(), triangles.get(), i)));
  return result;
}

PlanRectangle smallest_rectangle(const PlanPolygon& polygon) {
  PlanRectangle best;
  double best_area = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
    const Eigen::Vector2d along =
        (polygon.outer[(i + 1) % polygon.outer.size()] - polygon.outer[i]).normalized();
    Eigen::Matrix2d edge_from_plan;
    edge_from_plan << along.x(), along.y(), -along.y(), along.x();
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& corner : polygon.outer) box.extend(edge_from_plan * corner);
    if (box.volume() >= best_area) continue;
    best_area = box.volume();
    best = {edge_from_plan.transpose() * box.center(), box.sizes().minCoeff(),
            box.sizes().maxCoeff()};
  }
  return best;
}

}  // namespace planum
