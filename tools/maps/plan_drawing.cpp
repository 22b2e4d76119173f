#include "tools/maps/plan_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"

namespace planum {
namespace {

using Eigen::Vector2d;

constexpr double margin = 0.8;       // m
constexpr double usual_wall = 0.15;  // m, where the thickness of a wall is not known
constexpr double overlap = 0.04;     // m, by which a hole is drawn deeper than its wall
constexpr double tick = 0.08;        // m, half of a dimension line's end
constexpr double line_at = 0.36;     // of a room's size from its middle: its dimension lines
constexpr double name_size = 0.24, size_size = 0.17, measure_size = 0.15;  // m, of fonts

Vector2d left_of(const Vector2d& way) { return {-way.y(), way.x()}; }

/// Of a text along a line, so that it is read from below or from the right.
double text_turn(const Vector2d& way) {
  constexpr double slack = radians(5);  // walls are not quite at right angles: their texts agree
  double turn = std::atan2(way.y(), way.x());
  if (turn > pi / 2 + slack) turn -= pi;
  if (turn <= -pi / 2 + slack) turn += pi;
  return turn;
}

/// Collects the pieces; takes places of the world.
class Draughtsman {
 public:
  explicit Draughtsman(const RoomMap& rooms) {
    const Room& largest = *std::max_element(
        rooms.rooms.begin(), rooms.rooms.end(),
        [](const Room& a, const Room& b) { return a.width * a.depth < b.width * b.depth; });
    drawing_.turn = -std::atan2(largest.along.y(), largest.along.x());
    plan_from_world_ = Eigen::Rotation2Dd(drawing_.turn);
    const auto extend = [&](const Eigen::Vector3d& p, double around) {
      drawing_.paper.extend(at(p) - Vector2d::Constant(around));
      drawing_.paper.extend(at(p) + Vector2d::Constant(around));
    };
    for (const Room& room : rooms.rooms)
      for (const Eigen::Vector3d& p : room.outline) extend(p, margin);
    for (const Opening& opening : rooms.openings) extend(opening.position, opening.width);
  }

  void draw_outline(const Room& room) {
    std::vector<Vector2d> corners;
    for (const Eigen::Vector3d& p : room.outline) corners.push_back(at(p));
    drawing_.polygons.push_back({PlanPart::room, std::move(corners)});
  }

  void draw_sizes(const Room& room) {
    const Vector2d middle = at(room.centre);
    const Vector2d along = plan_from_world_ * room.along.head<2>().normalized();
    if (room.width > 0 && room.depth > 0) {
      draw_measure(middle - line_at * room.width * left_of(along), along, room.depth);
      draw_measure(middle - line_at * room.depth * along, left_of(along), room.width);
    }
    drawing_.texts.push_back(
        {PlanPart::room_name, middle + Vector2d(0, 0.06), 0, name_size, room.name});
    drawing_.texts.push_back({PlanPart::room_size, middle - Vector2d(0, 0.16), 0, size_size,
                              fmt::format("{:.1f} m², {:.2f} m high", room.area, room.height)});
  }

  void draw_opening(const Opening& opening) {
    const Vector2d across = plan_from_world_ * opening.across.head<2>().normalized();
    const Vector2d along = -left_of(across), middle = at(opening.position);
    const double thickness = (opening.thickness > 0 ? opening.thickness : usual_wall) + overlap;
    const Vector2d half = 0.5 * opening.width * along, deep = 0.5 * thickness * across;
    const bool is_window = opening.kind == OpeningKind::window;
    drawing_.polygons.push_back(
        {is_window ? PlanPart::window : PlanPart::doorway,
         {middle - half - deep, middle + half - deep, middle + half + deep, middle - half + deep}});
    switch (opening.kind) {
      case OpeningKind::window:
        draw_line(PlanPart::window, middle - half, middle + half);
        return;
      case OpeningKind::passage:
        draw_line(PlanPart::passage, middle - half - deep, middle + half - deep);
        draw_line(PlanPart::passage, middle - half + deep, middle + half + deep);
        return;
      case OpeningKind::door: {
        const Vector2d hinge = middle + half + deep, open = hinge + opening.width * across;
        draw_line(PlanPart::leaf, hinge, open);
        drawing_.quarters.push_back({PlanPart::swing, hinge, open, middle - half + deep});
        draw_length(middle, -0.055, along, opening.width);
        return;
      }
    }
  }

  PlanDrawing drawing() && { return std::move(drawing_); }

 private:
  Vector2d at(const Eigen::Vector3d& p) const { return plan_from_world_ * p.head<2>(); }

  void draw_line(PlanPart part, const Vector2d& from, const Vector2d& to) {
    drawing_.lines.push_back({part, from, to});
  }

  /// A number along a line, `above` it.
  void draw_length(const Vector2d& middle, double above, const Vector2d& way, double length) {
    const double turn = text_turn(way);
    const Vector2d up = Eigen::Rotation2Dd(turn) * Vector2d::UnitY();
    drawing_.texts.push_back({PlanPart::measure, middle + above * up, turn, measure_size,
                              fmt::format("{:.2f}", length)});
  }

  void draw_measure(const Vector2d& middle, const Vector2d& way, double length) {
    const Vector2d side = left_of(way);
    const Vector2d a = middle - 0.5 * length * way, b = middle + 0.5 * length * way;
    draw_line(PlanPart::dimension, a, b);
    for (const Vector2d& end : {a, b})
      draw_line(PlanPart::dimension, end - tick * (side + way), end + tick * (side + way));
    draw_length(middle, 0.04, way, length);
  }

  Eigen::Rotation2Dd plan_from_world_{0};
  PlanDrawing drawing_;
};

}  // namespace

PlanDrawing plan_drawing(const RoomMap& rooms, std::size_t storey) {
  std::vector<const Room*> drawn;
  for (const Room& room : rooms.rooms)
    if (room.storey == storey) drawn.push_back(&room);
  if (drawn.empty())
    throw Error(fmt::format("floor plan: there is no room in storey {}", storey + 1));
  Draughtsman draughtsman(rooms);
  for (const Room* room : drawn) draughtsman.draw_outline(*room);
  for (const Opening& opening : rooms.openings)
    if (std::any_of(opening.rooms.begin(), opening.rooms.end(),
                    [&](std::size_t room) { return rooms.rooms.at(room).storey == storey; }))
      draughtsman.draw_opening(opening);
  for (const Room* room : drawn) draughtsman.draw_sizes(*room);
  return std::move(draughtsman).drawing();
}

}  // namespace planum
