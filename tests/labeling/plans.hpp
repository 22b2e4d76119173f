#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

#include "meshing/polygon_map.hpp"
#include "slam/core/pose.hpp"

namespace planum::testing {

using Eigen::Vector3d;

/// Polygon maps made by hand; each polygon comes with the label it should get.
class PlanMaker {
 public:
  /// A polygon counter-clockwise seen from free space, with holes.
  void add(const std::string& label, const std::vector<Vector3d>& outer,
           const std::vector<std::vector<Vector3d>>& holes = {}) {
    MapPolygon polygon;
    Vector3d area = area_vector(outer);
    for (const auto& hole : holes) area += area_vector(hole);
    polygon.plane.normal = area.normalized();
    polygon.plane.offset = polygon.plane.normal.dot(outer.front());
    polygon.area = area.norm();
    polygon.outer = ring(outer);
    for (const auto& hole : holes) polygon.holes.push_back(ring(hole));
    map.polygons.push_back(polygon);
    labels.push_back(label);
  }

  /// The inside of a box: floor, ceiling and four walls; the last two may be left out.
  void add_room(const Vector3d& low, const Vector3d& high, bool with_ceiling = true) {
    const auto p = corners(low, high);
    add("floor", {p[0], p[1], p[3], p[2]});
    if (with_ceiling) add("ceiling", {p[4], p[6], p[7], p[5]});
    add("wall", {p[0], p[4], p[5], p[1]});
    add("wall", {p[2], p[3], p[7], p[6]});
    add("wall", {p[0], p[2], p[6], p[4]});
    add("wall", {p[1], p[5], p[7], p[3]});
  }

  /// The outside of a box without its bottom.
  void add_furniture(const Vector3d& low, const Vector3d& high) {
    const auto p = corners(low, high);
    add("furniture_horizontal", {p[4], p[5], p[7], p[6]});
    add("furniture_vertical", {p[0], p[1], p[5], p[4]});
    add("furniture_vertical", {p[2], p[6], p[7], p[3]});
    add("furniture_vertical", {p[0], p[4], p[6], p[2]});
    add("furniture_vertical", {p[1], p[3], p[7], p[5]});
  }

  /// A board: top and bottom.
  void add_board(const Vector3d& low, const Vector3d& high,
                 const std::string& label = "furniture_horizontal") {
    const auto p = corners(low, high);
    add(label, {p[4], p[5], p[7], p[6]});
    add(label, {p[0], p[2], p[3], p[1]});
  }

  PolygonMap moved(const Pose& b_from_a) const {
    PolygonMap result = map;
    for (Vector3d& v : result.vertices) v = b_from_a * v;
    for (MapPolygon& polygon : result.polygons) {
      polygon.plane.normal = b_from_a.linear() * polygon.plane.normal;
      polygon.plane.offset += polygon.plane.normal.dot(b_from_a.translation());
    }
    return result;
  }

  PolygonMap map;
  std::vector<std::string> labels;

 private:
  static std::array<Vector3d, 8> corners(const Vector3d& low, const Vector3d& high) {
    std::array<Vector3d, 8> p;
    for (std::size_t i = 0; i < 8; ++i)
      p[i] = {i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z()};
    return p;
  }

  static Vector3d area_vector(const std::vector<Vector3d>& ring) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 2; i < ring.size(); ++i)
      sum += (ring[i - 1] - ring[0]).cross(ring[i] - ring[0]) / 2;
    return sum;
  }

  Ring ring(const std::vector<Vector3d>& points) {
    Ring result;
    for (const Vector3d& p : points) {
      const auto [at, is_new] = known_.try_emplace({p.x(), p.y(), p.z()},
                                                   static_cast<std::uint32_t>(map.vertices.size()));
      if (is_new) map.vertices.push_back(p);
      result.push_back(at->second);
    }
    return result;
  }

  std::map<std::tuple<double, double, double>, std::uint32_t> known_;
};

}  // namespace planum::testing
