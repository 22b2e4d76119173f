#include "tools/maps/floor_plan_dxf.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "slam/core/pose.hpp"
#include "slam/io/atomic_file.hpp"
#include "tools/maps/dxf_document.hpp"

namespace planum {
namespace {

constexpr double capital = 0.72;  // height of a capital letter, of the size of its font

const char* layer_of(PlanPart part) {
  switch (part) {
    case PlanPart::room:
      return "ROOMS";
    case PlanPart::doorway:
    case PlanPart::leaf:
    case PlanPart::swing:
    case PlanPart::passage:
      return "DOORS";
    case PlanPart::window:
      return "WINDOWS";
    case PlanPart::dimension:
    case PlanPart::measure:
      return "DIMENSIONS";
    case PlanPart::room_name:
    case PlanPart::room_size:
      break;
  }
  return "TEXT";
}

bool is_dashed(PlanPart part) { return part == PlanPart::swing || part == PlanPart::passage; }

double direction(const Eigen::Vector2d& way) { return std::atan2(way.y(), way.x()); }

}  // namespace

void write_floor_plan_dxf(const std::filesystem::path& path, const PlanDrawing& drawing) {
  constexpr int red = 1, blue = 5, black = 7, grey = 8;
  DxfDocument document(
      {{"ROOMS", black}, {"DOORS", red}, {"WINDOWS", blue}, {"DIMENSIONS", grey}, {"TEXT", black}});
  for (const PlanPolygon& polygon : drawing.polygons)
    document.add_closed_polyline(layer_of(polygon.part), polygon.corners);
  for (const PlanLine& line : drawing.lines)
    document.add_line(layer_of(line.part), line.from, line.to, is_dashed(line.part));
  for (const PlanQuarter& quarter : drawing.quarters)
    document.add_arc(layer_of(quarter.part), quarter.centre, (quarter.from - quarter.centre).norm(),
                     direction(quarter.from - quarter.centre),
                     direction(quarter.to - quarter.centre), is_dashed(quarter.part));
  for (const PlanText& text : drawing.texts)
    document.add_text(layer_of(text.part), text.place, capital * text.size, text.turn, text.words);
  write_file_atomically(
      path, document.written(drawing.paper,
                             fmt::format("planum floor plan, metres; the world is turned by {:.6f} "
                                         "degrees counter-clockwise about its origin",
                                         degrees(drawing.turn))));
}

}  // namespace planum
