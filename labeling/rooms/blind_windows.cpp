#include "labeling/rooms/blind_windows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "labeling/plan/plan_ring.hpp"
#include "meshing/plane_geometry.hpp"
#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"

namespace planum {
namespace {

const double parallel_cosine = std::cos(radians(15));
constexpr double max_front = 0.08;          // m of a reveal before the face of the wall
constexpr double max_closed = 0.5;          // of a hole, by a surface behind it
constexpr double max_jamb_distance = 4;     // m, of one window
constexpr double min_closing_depth = 0.02;  // m

/// A wall's own frame: u along it (its normal turned left), z up, depth behind its face.
struct WallFrame {
  explicit WallFrame(const Plane& plane)
      : normal(plane.normal.head<2>().normalized()),
        along(-normal.y(), normal.x()),
        offset(plane.offset / plane.normal.head<2>().norm()) {}

  double u_of(const Eigen::Vector3d& p) const { return along.dot(p.head<2>()); }
  double depth_of(const Eigen::Vector3d& p) const { return offset - normal.dot(p.head<2>()); }

  Eigen::Vector2d normal, along;
  double offset;
};

/// A box in the frame of a wall (m).
struct WallBox {
  double left = HUGE_VAL, right = -HUGE_VAL, low = HUGE_VAL, high = -HUGE_VAL;
  double near = HUGE_VAL, far = -HUGE_VAL;  ///< depth

  double width() const { return right - left; }
  double height() const { return high - low; }
};

WallBox box_of(const Ring& ring, const PolygonMap& map, const WallFrame& frame) {
  WallBox box;
  for (const std::uint32_t v : ring) {
    const Eigen::Vector3d& p = map.vertices[v];
    box.left = std::min(box.left, frame.u_of(p));
    box.right = std::max(box.right, frame.u_of(p));
    box.low = std::min(box.low, p.z());
    box.high = std::max(box.high, p.z());
    box.near = std::min(box.near, frame.depth_of(p));
    box.far = std::max(box.far, frame.depth_of(p));
  }
  return box;
}

double area_of(const Ring& ring, const PolygonMap& map, const WallFrame& frame) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector3d &a = map.vertices[ring[i]],
                          &b = map.vertices[ring[(i + 1) % ring.size()]];
    twice += frame.u_of(a) * b.z() - frame.u_of(b) * a.z();
  }
  return std::abs(twice) / 2;
}

double shared(double a, double b, double c, double d) { return std::min(b, d) - std::max(a, c); }

/// What the polygons around a hole show of it.
struct Reveals {
  std::array<std::optional<double>, 4> edges;  ///< m: left, right (u), low, high (z)
  double depth = 0;                            ///< m
  bool closed = false;

  int count() const {
    return static_cast<int>(std::count_if(edges.begin(), edges.end(),
                                          [](const auto& edge) { return edge.has_value(); }));
  }
};

/// Which edge of a hole a polygon may be the reveal of, by its normal; -1: none.
int edge_of(const Eigen::Vector3d& normal, const WallFrame& frame) {
  const double u = frame.along.dot(normal.head<2>());
  if (u > parallel_cosine) return 0;
  if (u < -parallel_cosine) return 1;
  if (normal.z() > parallel_cosine) return 2;
  if (normal.z() < -parallel_cosine) return 3;
  return -1;
}

Reveals reveals_of(const WallBox& hole, const PolygonMap& map, const WallFrame& frame,
                   const BlindWindowParams& params) {
  Reveals reveals;
  for (const MapPolygon& polygon : map.polygons) {
    const WallBox box = box_of(polygon.outer, map, frame);
    const double across = shared(box.left, box.right, hole.left, hole.right) / hole.width();
    const double up = shared(box.low, box.high, hole.low, hole.high) / hole.height();
    const bool looks_out = frame.normal.dot(polygon.plane.normal.head<2>()) > parallel_cosine;
    if (looks_out && box.near > min_closing_depth && box.near < params.max_depth && across > 0 &&
        up > 0 && across * up > max_closed)
      reveals.closed = true;
    const int edge = edge_of(polygon.plane.normal, frame);
    if (edge < 0 || box.near < -max_front || box.far <= max_front || box.near > params.max_depth)
      continue;
    const bool jamb = edge < 2;
    const double place = jamb ? (box.left + box.right) / 2 : (box.low + box.high) / 2;
    const std::array<double, 4> rough = {hole.left, hole.right, hole.low, hole.high};
    if (std::abs(place - rough[static_cast<std::size_t>(edge)]) > params.edge_reach ||
        (jamb ? up : across) < params.min_along)
      continue;
    reveals.edges[static_cast<std::size_t>(edge)] = place;
    reveals.depth = std::max(reveals.depth, std::min(box.far, params.max_depth));
  }
  return reveals;
}

bool is_known(const Eigen::Vector3d& position, const std::vector<Opening>& openings) {
  return std::any_of(openings.begin(), openings.end(), [&](const Opening& opening) {
    return (opening.position - position).norm() < (opening.width + opening.height) / 4;
  });
}

/// A hole in a wall that is about a rectangle.
std::optional<WallBox> rectangle_of(const Ring& ring, const PolygonMap& map, const WallFrame& frame,
                                    double min_fill) {
  const WallBox hole = box_of(ring, map, frame);
  if (area_of(ring, map, frame) < min_fill * hole.width() * hole.height()) return std::nullopt;
  return hole;
}

/// Share of a rectangle that is not wall.
double open_share(const WallBox& box, const MapPolygon& wall, const PolygonMap& map,
                  const WallFrame& frame) {
  constexpr int steps = 5;
  std::vector<Ring2d> rings;
  const auto add = [&](const Ring& ring) {
    rings.emplace_back();
    for (const std::uint32_t v : ring)
      rings.back().emplace_back(frame.u_of(map.vertices[v]), map.vertices[v].z());
  };
  add(wall.outer);
  for (const Ring& hole : wall.holes) add(hole);
  int open = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const Eigen::Vector2d place(box.left + (i + 0.5) / steps * box.width(),
                                  box.low + (j + 0.5) / steps * box.height());
      open += !rings_contain(rings, place);
    }
  return open / static_cast<double>(steps * steps);
}

/// Rectangles between jambs that face each other, and below a lintel with a jamb at one end: the
/// hole itself may have run into a shadow or over the end of the polygon.
std::vector<WallBox> between_reveals(const MapPolygon& wall, const PolygonMap& map,
                                     const WallFrame& frame, const BlindWindowParams& params) {
  const WallBox reach = box_of(wall.outer, map, frame);
  std::array<std::vector<WallBox>, 4> reveals;  // as edge_of numbers them
  for (const MapPolygon& polygon : map.polygons) {
    const int edge = edge_of(polygon.plane.normal, frame);
    if (edge < 0) continue;
    const WallBox box = box_of(polygon.outer, map, frame);
    const double length = edge < 2 ? box.height() : box.width();
    const double thickness = edge < 2 ? box.width() : box.height();
    if (std::abs(box.near) > max_front || box.far < 2 * max_front || box.far > params.max_depth ||
        thickness > params.edge_reach || length < params.min_size || box.right < reach.left ||
        box.left > reach.right)
      continue;
    reveals[static_cast<std::size_t>(edge)].push_back(box);
  }
  std::vector<WallBox> result;
  const auto add = [&](const WallBox& box) {
    if (box.width() <= max_jamb_distance && box.height() >= params.min_size &&
        open_share(box, wall, map, frame) > params.min_fill)
      result.push_back(box);
  };
  const auto& [left, right, sills, lintels] = reveals;
  for (const WallBox& from : left)
    for (const WallBox& to : right) {
      WallBox box = from;
      box.left = (from.left + from.right) / 2;
      box.right = (to.left + to.right) / 2;
      box.low = std::min(from.low, to.low);
      box.high = std::max(from.high, to.high);
      if (shared(from.low, from.high, to.low, to.high) > max_closed * box.height()) add(box);
    }
  for (const WallBox& lintel : lintels)
    for (const auto* jambs : {&left, &right})
      for (const WallBox& jamb : *jambs) {
        const double end = jambs == &left ? lintel.left : lintel.right;
        if (std::abs(end - (jamb.left + jamb.right) / 2) > 2 * params.edge_reach ||
            std::abs(lintel.low - jamb.high) > 2 * params.edge_reach)
          continue;
        WallBox box = lintel;
        box.low = jamb.low;
        add(box);
      }
  return result;
}

std::optional<Opening> window_in(WallBox hole, const PolygonMap& map, const WallFrame& frame,
                                 double floor, const BlindWindowParams& params) {
  if (hole.width() < params.min_size || hole.height() < params.min_size ||
      hole.low - floor < params.min_sill)
    return std::nullopt;
  const Reveals reveals = reveals_of(hole, map, frame, params);
  if (reveals.closed || reveals.count() < params.min_reveals) return std::nullopt;
  hole.left = reveals.edges[0].value_or(hole.left);
  hole.right = reveals.edges[1].value_or(hole.right);
  hole.low = reveals.edges[2].value_or(hole.low);
  hole.high = reveals.edges[3].value_or(hole.high);
  Opening window;
  window.kind = OpeningKind::window;
  window.width = hole.width();
  window.height = hole.height();
  window.sill = hole.low - floor;
  window.thickness = reveals.depth;
  const Eigen::Vector2d middle = (hole.left + hole.right) / 2 * frame.along +
                                 (frame.offset - reveals.depth / 2) * frame.normal;
  window.position = {middle.x(), middle.y(), (hole.low + hole.high) / 2};
  window.across = {-frame.normal.x(), -frame.normal.y(), 0};
  return window;
}

}  // namespace

RoomMap with_blind_windows(const PolygonMap& map, const Labels& labels, RoomMap rooms,
                           const BlindWindowParams& params) {
  if (labels.polygons.size() != map.polygons.size() ||
      rooms.room_of_polygon.size() != map.polygons.size())
    throw Error("windows: " + std::to_string(map.polygons.size()) + " polygons with " +
                std::to_string(labels.polygons.size()) + " labels and " +
                std::to_string(rooms.room_of_polygon.size()) + " rooms");
  for (std::size_t i = 0; i < map.polygons.size(); ++i) {
    const std::int32_t room = rooms.room_of_polygon[i];
    if (labels.polygons[i].label != Label::wall || room < 0 ||
        std::abs(map.polygons[i].plane.normal.z()) > std::sin(radians(15)))
      continue;
    const Room& inside = rooms.rooms[static_cast<std::size_t>(room)];
    if (inside.outline.empty()) continue;
    const WallFrame frame(map.polygons[i].plane);
    std::vector<WallBox> candidates;
    for (const Ring& hole : map.polygons[i].holes)
      if (const auto box = rectangle_of(hole, map, frame, params.min_fill))
        candidates.push_back(*box);
    for (const WallBox& box : between_reveals(map.polygons[i], map, frame, params))
      candidates.push_back(box);
    for (const WallBox& hole : candidates) {
      auto window = window_in(hole, map, frame, inside.outline.front().z(), params);
      if (!window || is_known(window->position, rooms.openings)) continue;
      window->rooms = {static_cast<std::size_t>(room)};
      rooms.openings.push_back(*window);
    }
  }
  std::stable_sort(rooms.openings.begin(), rooms.openings.end(),
                   [](const Opening& a, const Opening& b) { return a.rooms < b.rooms; });
  return rooms;
}

}  // namespace planum
