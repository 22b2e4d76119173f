#include "labeling/rules/opening_parts.hpp"

#include <algorithm>
#include <cmath>

#include "slam/core/pose.hpp"

namespace planum {
namespace {

constexpr double margin = 0.08;      // m beside, below and above an opening
constexpr double deep_margin = 0.2;  // m before and behind: jambs may be cut where rays ended
constexpr double usual_wall = 0.30;  // m, where the thickness is not known
constexpr double hinge_reach = 0.2;  // m from a jamb to the edge of its leaf
constexpr double max_below_top = 0.2, max_above_top = 0.06;  // m, upper edge of a leaf
constexpr double max_above_floor = 0.5;  // m, lower edge of a leaf, which may be hidden
constexpr double min_width_share = 0.7, max_width_share = 1.1;
constexpr double frame_confidence = 0.9, leaf_confidence = 0.8;
constexpr double sure_wall = 0.8;  // what ends at a ceiling, or goes on in a wall, is no leaf
constexpr double max_leaf_thickness = 0.08, max_wall_thickness = 0.7;  // m
constexpr double max_turn = radians(8);  // between the faces of a wall
const double max_leaf_lean = std::sin(radians(8));

/// An opening as a box: along the wall, through it, up; the middle of its bottom is the origin.
struct OpeningBox {
  explicit OpeningBox(const Opening& opening)
      : middle(opening.position.head<2>()),
        across(opening.across.head<2>().normalized()),
        half_width(opening.width / 2),
        half_depth((opening.thickness > 0 ? opening.thickness : usual_wall) / 2),
        bottom(opening.position.z() - opening.height / 2),
        top(opening.position.z() + opening.height / 2) {}

  double along_of(const Eigen::Vector3d& p) const {
    return Eigen::Vector2d(-across.y(), across.x()).dot(p.head<2>() - middle);
  }
  double depth_of(const Eigen::Vector3d& p) const { return across.dot(p.head<2>() - middle); }

  /// `deep` m are given in front of it and behind.
  bool holds(const Eigen::Vector3d& p, double deep) const {
    return std::abs(along_of(p)) <= half_width + margin &&
           std::abs(depth_of(p)) <= half_depth + deep && p.z() >= bottom - margin &&
           p.z() <= top + margin;
  }

  Eigen::Vector2d middle, across;
  double half_width, half_depth, bottom, top;
};

bool lies_in(const PolygonMap& map, const MapPolygon& polygon, const OpeningBox& box) {
  Eigen::Vector3d low = map.vertices[polygon.outer.front()], high = low;
  for (const std::uint32_t v : polygon.outer) {
    low = low.cwiseMin(map.vertices[v]);
    high = high.cwiseMax(map.vertices[v]);
  }
  return box.holds((low + high) / 2, 0) &&
         std::all_of(polygon.outer.begin(), polygon.outer.end(),
                     [&](std::uint32_t v) { return box.holds(map.vertices[v], deep_margin); });
}

Label label_of(const Opening& opening) {
  return opening.kind == OpeningKind::window ? Label::window : Label::door;
}

bool is_leaf_of(const PolygonMap& map, const MapPolygon& polygon, const Opening& opening) {
  if (std::abs(polygon.plane.normal.z()) > max_leaf_lean) return false;
  const OpeningBox box(opening);
  const Eigen::Vector2d run =
      Eigen::Vector2d(-polygon.plane.normal.y(), polygon.plane.normal.x()).normalized();
  double low = HUGE_VAL, high = -HUGE_VAL, from = HUGE_VAL, to = -HUGE_VAL;
  for (const std::uint32_t v : polygon.outer) {
    const Eigen::Vector3d& p = map.vertices[v];
    low = std::min(low, p.z());
    high = std::max(high, p.z());
    from = std::min(from, run.dot(p.head<2>()));
    to = std::max(to, run.dot(p.head<2>()));
  }
  if (low > box.bottom + max_above_floor || high < box.top - max_below_top ||
      high > box.top + max_above_top)
    return false;
  if (to - from < min_width_share * opening.width || to - from > max_width_share * opening.width)
    return false;
  // One edge is at a jamb, on either side of the wall.
  const Eigen::Vector2d normal = polygon.plane.normal.head<2>().normalized();
  const double offset = normal.dot(map.vertices[polygon.outer.front()].head<2>());
  const Eigen::Vector2d side(-box.across.y(), box.across.x());
  for (const double edge : {from, to})
    for (const double jamb : {-1.0, 1.0})
      for (const double face : {-1.0, 1.0}) {
        const Eigen::Vector2d hinge =
            box.middle + jamb * box.half_width * side + face * box.half_depth * box.across;
        if ((edge * run + offset * normal - hinge).norm() < hinge_reach) return true;
      }
  return false;
}

/// Whether the other face of the same wall is behind.
bool is_face_of_wall(const PolygonMap& map, std::size_t leaf,
                     const std::vector<PolygonLabel>& labels) {
  const Plane& plane = map.polygons[leaf].plane;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const std::uint32_t v : map.polygons[leaf].outer) middle += map.vertices[v];
  middle /= static_cast<double>(map.polygons[leaf].outer.size());
  const Eigen::Vector2d run = Eigen::Vector2d(-plane.normal.y(), plane.normal.x()).normalized();
  for (std::size_t j = 0; j < map.polygons.size(); ++j) {
    const MapPolygon& back = map.polygons[j];
    if (labels[j].label != Label::wall || labels[j].confidence < sure_wall ||
        back.plane.normal.dot(plane.normal) > -std::cos(max_turn))
      continue;
    const double thickness = -back.plane.signed_distance(middle);
    if (thickness < max_leaf_thickness || thickness > max_wall_thickness) continue;
    double from = HUGE_VAL, to = -HUGE_VAL;
    for (const std::uint32_t v : back.outer) {
      from = std::min(from, run.dot(map.vertices[v].head<2>()));
      to = std::max(to, run.dot(map.vertices[v].head<2>()));
    }
    const double place = run.dot(middle.head<2>());
    if (place > from && place < to) return true;
  }
  return false;
}

}  // namespace

void label_frames(const PolygonMap& map, std::span<const Opening> openings,
                  std::vector<PolygonLabel>& labels) {
  for (const Opening& opening : openings) {
    const OpeningBox box(opening);
    for (std::size_t i = 0; i < map.polygons.size(); ++i)
      if (labels[i].label != Label::floor && lies_in(map, map.polygons[i], box))
        labels[i] = {label_of(opening), frame_confidence};
  }
}

void label_open_leaves(const PolygonMap& map, std::span<const Opening> openings,
                       std::vector<PolygonLabel>& labels) {
  for (const Opening& opening : openings) {
    if (opening.kind != OpeningKind::door) continue;
    for (std::size_t i = 0; i < map.polygons.size(); ++i)
      if (labels[i].label != Label::door && labels[i].confidence < sure_wall &&
          is_leaf_of(map, map.polygons[i], opening) && !is_face_of_wall(map, i, labels))
        labels[i] = {Label::door, leaf_confidence};
  }
}

}  // namespace planum
