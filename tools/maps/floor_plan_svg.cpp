#include "tools/maps/floor_plan_svg.hpp"

#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "slam/core/pose.hpp"
#include "slam/io/atomic_file.hpp"

namespace planum {
namespace {

using Eigen::Vector2d;

constexpr double unit = 100;  // of the drawing in a metre
constexpr double paper = 20;  // mm on paper in a metre

constexpr const char* style =
    ".room{fill:#f6f3ea;stroke:#222;stroke-width:5;stroke-linejoin:miter}"
    ".gap{fill:#fff;stroke:none}.leaf{fill:none;stroke:#d55e00;stroke-width:3}"
    ".swing{fill:none;stroke:#d55e00;stroke-width:1;stroke-dasharray:4 3}"
    ".window{fill:#cfe8f7;stroke:#0072b2;stroke-width:2}"
    ".passage{fill:none;stroke:#777;stroke-width:1;stroke-dasharray:8 5}"
    ".dimension{fill:none;stroke:#555;stroke-width:1}"
    "text{font-family:sans-serif;text-anchor:middle;fill:#222}.measure{fill:#555}";

const char* css_class(PlanPart part) {
  switch (part) {
    case PlanPart::room:
      return "room";
    case PlanPart::doorway:
      return "gap";
    case PlanPart::leaf:
      return "leaf";
    case PlanPart::swing:
      return "swing";
    case PlanPart::passage:
      return "passage";
    case PlanPart::window:
      return "window";
    case PlanPart::dimension:
      return "dimension";
    case PlanPart::room_name:
      return "name";
    case PlanPart::room_size:
      return "size";
    case PlanPart::measure:
      break;
  }
  return "measure";
}

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

/// y goes down, the corner of the paper is the origin.
class Sheet {
 public:
  explicit Sheet(const Eigen::AlignedBox2d& box) : box_(box) {}

  void add(const PlanPolygon& polygon) {
    append("<polygon class=\"{}\" points=\"", css_class(polygon.part));
    for (const Vector2d& p : polygon.corners) append("{:.1f},{:.1f} ", at(p).x(), at(p).y());
    text_.back() = '"';
    text_ += "/>\n";
  }

  void add(const PlanLine& line) {
    const Vector2d a = at(line.from), b = at(line.to);
    append("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
           css_class(line.part), a.x(), a.y(), b.x(), b.y());
  }

  void add(const PlanQuarter& quarter) {
    const Vector2d a = at(quarter.from), b = at(quarter.to);
    const double radius = unit * (quarter.from - quarter.centre).norm();
    append("<path class=\"{}\" d=\"M{:.1f} {:.1f} A{:.1f} {:.1f} 0 0 0 {:.1f} {:.1f}\"/>\n",
           css_class(quarter.part), a.x(), a.y(), radius, radius, b.x(), b.y());
  }

  void add(const PlanText& text) {
    const Vector2d p = at(text.place);
    append("<text class=\"{}\" font-size=\"{:.0f}\" x=\"{:.1f}\" y=\"{:.1f}\"",
           css_class(text.part), unit * text.size, p.x(), p.y());
    if (text.turn != 0)
      append(" transform=\"rotate({:.1f} {:.1f} {:.1f})\"", -degrees(text.turn), p.x(), p.y());
    append(">{}</text>\n", escaped(text.words));
  }

  std::string written() const {
    const Vector2d size = box_.sizes();
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "width=\"{:.1f}mm\" height=\"{:.1f}mm\" viewBox=\"0 0 {:.1f} {:.1f}\">\n<style>{}</style>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{}</svg>\n",
        paper * size.x(), paper * size.y(), unit * size.x(), unit * size.y(), style, text_);
  }

 private:
  /// In units of the drawing.
  Vector2d at(const Vector2d& p) const {
    return {unit * (p.x() - box_.min().x()), unit * (box_.max().y() - p.y())};
  }

  template <typename... Values>
  void append(fmt::format_string<Values...> pattern, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), pattern, std::forward<Values>(values)...);
  }

  Eigen::AlignedBox2d box_;
  std::string text_;
};

}  // namespace

void write_floor_plan_svg(const std::filesystem::path& path, const PlanDrawing& drawing) {
  Sheet sheet(drawing.paper);
  for (const PlanPolygon& polygon : drawing.polygons) sheet.add(polygon);
  for (const PlanLine& line : drawing.lines) sheet.add(line);
  for (const PlanQuarter& quarter : drawing.quarters) sheet.add(quarter);
  for (const PlanText& text : drawing.texts) sheet.add(text);
  write_file_atomically(path, sheet.written());
}

}  // namespace planum
