#include "tools/maps/floor_plan.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"

namespace planum {
namespace {

using Eigen::Vector2d;

constexpr double unit = 100;         // of the drawing in a metre
constexpr double paper = 20;         // mm on paper in a metre
constexpr double margin = 0.8;       // m
constexpr double usual_wall = 0.15;  // m, where the thickness of a wall is not known
constexpr double tick = 0.08;        // m, half of a dimension line's end
constexpr double line_at = 0.36;     // of a room's size from its middle: its dimension lines

constexpr const char* style =
    ".room{fill:#f6f3ea;stroke:#222;stroke-width:5;stroke-linejoin:miter}"
    ".gap{fill:#fff;stroke:none}.leaf{fill:none;stroke:#d55e00;stroke-width:3}"
    ".swing{fill:none;stroke:#d55e00;stroke-width:1;stroke-dasharray:4 3}"
    ".window{fill:#cfe8f7;stroke:#0072b2;stroke-width:2}"
    ".passage{fill:none;stroke:#777;stroke-width:1;stroke-dasharray:8 5}"
    ".dimension{fill:none;stroke:#555;stroke-width:1}"
    "text{font-family:sans-serif;text-anchor:middle;fill:#222}"
    ".name{font-size:24px}.size{font-size:17px}.measure{font-size:15px;fill:#555}";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else
      result += c;
  }
  return result;
}

/// From the world to the drawing: the largest room lies along x, y goes down.
class Drawing {
 public:
  explicit Drawing(const RoomMap& rooms) {
    const Room& largest = *std::max_element(
        rooms.rooms.begin(), rooms.rooms.end(),
        [](const Room& a, const Room& b) { return a.width * a.depth < b.width * b.depth; });
    along_ = largest.along.head<2>().normalized();
    Eigen::Array2d low = Eigen::Array2d::Constant(HUGE_VAL), high = -low;
    const auto add = [&](const Eigen::Vector3d& p, double around) {
      low = low.min(turned(p.head<2>()).array() - around);
      high = high.max(turned(p.head<2>()).array() + around);
    };
    for (const Room& room : rooms.rooms)
      for (const Eigen::Vector3d& p : room.outline) add(p, margin);
    for (const Opening& opening : rooms.openings) add(opening.position, opening.width);
    low_ = low;
    size_ = high - low;
  }

  /// In units of the drawing, from a place in the plan of the world.
  Vector2d at(const Vector2d& p) const {
    const Vector2d t = turned(p);
    return {unit * (t.x() - low_.x()), unit * (low_.y() + size_.y() - t.y())};
  }

  void polygon(const std::vector<Vector2d>& places, const char* css) {
    text_ += fmt::format("<polygon class=\"{}\" points=\"", css);
    for (const Vector2d& p : places) {
      const Vector2d q = at(p);
      fmt::format_to(std::back_inserter(text_), "{:.1f},{:.1f} ", q.x(), q.y());
    }
    text_.back() = '"';
    text_ += "/>\n";
  }

  void line(const Vector2d& from, const Vector2d& to, const char* css) {
    const Vector2d a = at(from), b = at(to);
    text_ += fmt::format(
        "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", css,
        a.x(), a.y(), b.x(), b.y());
  }

  /// A quarter of a circle, counter-clockwise in the world from `from` to `to`.
  void quarter(const Vector2d& from, const Vector2d& to, double radius, const char* css) {
    const Vector2d a = at(from), b = at(to);
    text_ += fmt::format(
        "<path class=\"{}\" d=\"M{:.1f} {:.1f} A{:.1f} {:.1f} 0 0 0 {:.1f} {:.1f}\"/>\n", css,
        a.x(), a.y(), unit * radius, unit * radius, b.x(), b.y());
  }

  /// `down`: units of the drawing below the place; `turn`: degrees clockwise.
  void label(const Vector2d& place, double down, double turn, const char* css,
             const std::string& words) {
    const Vector2d p = at(place);
    const std::string around =
        turn == 0 ? ""
                  : fmt::format(" transform=\"rotate({:.1f} {:.1f} {:.1f})\"", turn, p.x(), p.y());
    text_ += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", css, p.x(),
                         p.y() + down, around, escaped(words));
  }

  /// Direction of a vector of the plan on the drawing, degrees clockwise, so that text is read
  /// from below or from the right.
  double text_turn(const Vector2d& way) const {
    const Vector2d t(along_.dot(way), Vector2d(-along_.y(), along_.x()).dot(way));
    double degrees_clockwise = -degrees(std::atan2(t.y(), t.x()));
    while (degrees_clockwise > 89.99) degrees_clockwise -= 180;
    while (degrees_clockwise < -90.01) degrees_clockwise += 180;
    return degrees_clockwise;
  }

  std::string written() const {
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "width=\"{:.1f}mm\" height=\"{:.1f}mm\" viewBox=\"0 0 {:.1f} {:.1f}\">\n<style>{}</style>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{}</svg>\n",
        paper * size_.x(), paper * size_.y(), unit * size_.x(), unit * size_.y(), style, text_);
  }

 private:
  Vector2d turned(const Vector2d& p) const {
    return {along_.dot(p), Vector2d(-along_.y(), along_.x()).dot(p)};
  }

  Vector2d along_ = Vector2d::UnitX();
  Eigen::Array2d low_ = Eigen::Array2d::Zero(), size_ = Eigen::Array2d::Zero();
  std::string text_;
};

void draw_measure(Drawing& drawing, const Vector2d& middle, const Vector2d& way, double length) {
  const Vector2d side(-way.y(), way.x());
  const Vector2d a = middle - 0.5 * length * way, b = middle + 0.5 * length * way;
  drawing.line(a, b, "dimension");
  for (const Vector2d& end : {a, b})
    drawing.line(end - tick * (side + way), end + tick * (side + way), "dimension");
  drawing.label(middle, -4, drawing.text_turn(way), "measure", fmt::format("{:.2f}", length));
}

void draw_room(Drawing& drawing, const Room& room) {
  std::vector<Vector2d> outline;
  for (const Eigen::Vector3d& p : room.outline) outline.push_back(p.head<2>());
  drawing.polygon(outline, "room");
}

void draw_sizes(Drawing& drawing, const Room& room) {
  const Vector2d middle = room.centre.head<2>(), along = room.along.head<2>().normalized();
  const Vector2d across(-along.y(), along.x());
  if (room.width > 0 && room.depth > 0) {
    draw_measure(drawing, middle - line_at * room.width * across, along, room.depth);
    draw_measure(drawing, middle - line_at * room.depth * along, across, room.width);
  }
  drawing.label(middle, -6, 0, "name", room.name);
  drawing.label(middle, 16, 0, "size",
                fmt::format("{:.1f} m², {:.2f} m high", room.area, room.height));
}

void draw_opening(Drawing& drawing, const Opening& opening) {
  const Vector2d across = opening.across.head<2>().normalized(), along(-across.y(), across.x());
  const Vector2d middle = opening.position.head<2>();
  const double thickness = (opening.thickness > 0 ? opening.thickness : usual_wall) + 0.04;
  const Vector2d half = 0.5 * opening.width * along, deep = 0.5 * thickness * across;
  const std::vector<Vector2d> gap = {middle - half - deep, middle + half - deep,
                                     middle + half + deep, middle - half + deep};
  switch (opening.kind) {
    case OpeningKind::window:
      drawing.polygon(gap, "window");
      drawing.line(middle - half, middle + half, "window");
      return;
    case OpeningKind::passage:
      drawing.polygon(gap, "gap");
      drawing.line(middle - half - deep, middle + half - deep, "passage");
      drawing.line(middle - half + deep, middle + half + deep, "passage");
      return;
    case OpeningKind::door: {
      drawing.polygon(gap, "gap");
      const Vector2d hinge = middle + half + deep, open = hinge + opening.width * across;
      drawing.line(hinge, open, "leaf");
      drawing.quarter(open, middle - half + deep, opening.width, "swing");
      drawing.label(middle - deep, 4, drawing.text_turn(along), "measure",
                    fmt::format("{:.2f}", opening.width));
      return;
    }
  }
}

}  // namespace

void write_floor_plan_svg(const std::filesystem::path& path, const RoomMap& rooms) {
  if (rooms.rooms.empty()) throw Error(path.string() + ": there is no room to draw");
  Drawing drawing(rooms);
  for (const Room& room : rooms.rooms) draw_room(drawing, room);
  for (const Opening& opening : rooms.openings) draw_opening(drawing, opening);
  for (const Room& room : rooms.rooms) draw_sizes(drawing, room);
  write_file_atomically(path, drawing.written());
}

}  // namespace planum
