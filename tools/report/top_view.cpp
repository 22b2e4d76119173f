#include "tools/report/top_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "tools/report/canvas.hpp"

namespace planum {
namespace {

constexpr Colour ink = {40, 40, 40}, paper = {255, 255, 255};
constexpr Colour before_colour = {230, 159, 0}, after_colour = {0, 114, 178},
                 loop_colour = {204, 121, 167}, door_colour = {213, 94, 0},
                 window_colour = {86, 180, 233};
constexpr double legend_height = 56;  // pixels
constexpr int legend_width = 800;     // pixels, at least: all its entries
constexpr float max_level = 0.7f;     // |cos| of a normal: steeper surfaces are drawn

/// From metres, y up, to pixels, y down.
struct PlanFrame {
  Eigen::Vector2d low, high;  // m
  double scale = 1;           // pixels a metre

  Eigen::Vector2d operator()(const Eigen::Vector3d& p) const {
    return {(p.x() - low.x()) * scale, (high.y() - p.y()) * scale};
  }
};

/// Around the bulk of what is drawn: the last thousandth of points at each end may be outside.
PlanFrame frame_of(const TopView& view, const TopViewParams& params) {
  std::array<std::vector<float>, 2> drawn;
  for (std::size_t i = 0; i < view.cloud.points.size(); ++i) {
    if (std::abs(view.cloud.normals[i].z()) > max_level) continue;
    for (const int axis : {0, 1})
      drawn[static_cast<std::size_t>(axis)].push_back(view.cloud.points[i][axis]);
  }
  Eigen::AlignedBox2d box;
  for (const int axis : {0, 1}) {
    auto& values = drawn[static_cast<std::size_t>(axis)];
    if (values.empty()) continue;
    const auto at = [&](double share) {
      const auto place =
          values.begin() + static_cast<std::ptrdiff_t>(share * double(values.size() - 1));
      std::nth_element(values.begin(), place, values.end());
      return double(*place);
    };
    box.min()[axis] = at(0.001);
    box.max()[axis] = at(0.999);
  }
  for (const auto* path : {&view.before, &view.after})
    for (const Pose& pose : *path) box.extend(pose.translation().head<2>());
  if (box.isEmpty()) box.extend(Eigen::Vector2d(0, 0));
  return {.low = box.min().array() - params.margin,
          .high = box.max().array() + params.margin,
          .scale = params.longest_side / (box.sizes().maxCoeff() + 2 * params.margin)};
}

void draw_rooms(Canvas& canvas, const PlanFrame& frame, const RoomMap& rooms) {
  for (const Room& room : rooms.rooms) {
    std::vector<Eigen::Vector2d> ring;
    for (const Eigen::Vector3d& p : room.outline) ring.push_back(frame(p));
    canvas.fill({ring}, {226, 240, 234}, 1);
  }
}

/// The more points stand above each other, the darker; the scale is that of a wall in this cloud.
void draw_points(Canvas& canvas, const PlanFrame& frame, const Cloud& cloud) {
  const auto width = static_cast<std::size_t>(canvas.width());
  std::vector<float> count(width * static_cast<std::size_t>(canvas.height()));
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (std::abs(cloud.normals[i].z()) > max_level) continue;
    const Eigen::Vector2d p = frame(cloud.points[i].cast<double>());
    if (p.x() < 0 || p.y() < 0 || p.x() >= canvas.width() || p.y() >= canvas.height()) continue;
    count[static_cast<std::size_t>(p.y()) * width + static_cast<std::size_t>(p.x())] += 1;
  }
  std::vector<float> filled;
  for (const float value : count)
    if (value > 0) filled.push_back(value);
  if (filled.empty()) return;
  const auto place = filled.begin() + static_cast<std::ptrdiff_t>(0.9 * double(filled.size() - 1));
  std::nth_element(filled.begin(), place, filled.end());
  const double dark = std::log1p(*place);
  for (std::size_t i = 0; i < count.size(); ++i)
    if (count[i] > 0)
      canvas.blend(static_cast<int>(i % width), static_cast<int>(i / width), ink,
                   std::min(1.0, 0.15 + 0.85 * std::log1p(count[i]) / dark));
}

void draw_openings(Canvas& canvas, const PlanFrame& frame, const RoomMap& rooms) {
  for (const Opening& opening : rooms.openings) {
    const Eigen::Vector3d along =
        Eigen::Vector3d::UnitZ().cross(opening.across).normalized() * opening.width / 2;
    canvas.line(frame(opening.position - along), frame(opening.position + along),
                {.colour = opening.kind == OpeningKind::window ? window_colour : door_colour,
                 .width = std::max(3.0, 0.09 * frame.scale)});
  }
}

void draw_path(Canvas& canvas, const PlanFrame& frame, const std::vector<Pose>& path,
               const Stroke& stroke) {
  std::vector<Eigen::Vector2d> points;
  for (const Pose& pose : path) points.push_back(frame(pose.translation()));
  canvas.polyline(points, false, stroke);
  for (const Eigen::Vector2d& p : points) canvas.disc(p, 1.6 * stroke.width, stroke.colour);
}

/// Letters on a halo, so that they can be read on anything.
void draw_label(Canvas& canvas, const Eigen::Vector2d& middle, const std::string& words,
                double letter_height, const Colour& colour) {
  const double width = letter_height / 7;
  canvas.text(middle, words, letter_height, {.colour = paper, .width = 4 * width, .opacity = 0.75});
  canvas.text(middle, words, letter_height, {.colour = colour, .width = width});
}

void draw_names(Canvas& canvas, const PlanFrame& frame, const TopView& view) {
  for (std::size_t i = 0; i < std::min(view.names.size(), view.after.size()); ++i)
    draw_label(canvas, frame(view.after[i].translation()) + Eigen::Vector2d(0, -14), view.names[i],
               10, after_colour);
  if (!view.rooms) return;
  for (const Room& room : view.rooms->rooms) {
    const Eigen::Vector2d middle = frame(room.centre);
    draw_label(canvas, middle, room.name, 16, ink);
    draw_label(canvas, middle + Eigen::Vector2d(0, 24),
               fmt::format("{:.2f} x {:.2f} m, {:.1f} m2", room.width, room.depth, room.area), 11,
               ink);
  }
}

void draw_legend(Canvas& canvas, const PlanFrame& frame, const TopView& view) {
  const double y = canvas.height() - legend_height / 2;
  canvas.fill({{{0, canvas.height() - legend_height},
                {double(canvas.width()), canvas.height() - legend_height},
                {double(canvas.width()), double(canvas.height())},
                {0, double(canvas.height())}}},
              paper, 1);
  // The largest of these that is shorter than a sixth of the picture.
  double metres = 0.1;
  for (const double step : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
    if (step * frame.scale < canvas.width() / 6.0) metres = step;
  const double bar = metres * frame.scale;
  canvas.line({20, y + 8}, {20 + bar, y + 8}, {.colour = ink, .width = 3});
  canvas.text({20 + bar / 2, y - 6}, fmt::format("{:g} m", metres), 10,
              {.colour = ink, .width = 1.5});
  double x = 60 + bar;
  const auto entry = [&](const Colour& colour, const std::string& words) {
    canvas.line({x, y}, {x + 26, y}, {.colour = colour, .width = 5});
    const double width = Canvas::text_width(words, 10);
    canvas.text({x + 36 + width / 2, y}, words, 10, {.colour = ink, .width = 1.5});
    x += 66 + width;
  };
  if (!view.before.empty()) entry(before_colour, "odometry");
  if (!view.after.empty()) entry(after_colour, "path");
  if (!view.loops.empty()) entry(loop_colour, "loops");
  if (view.rooms && !view.rooms->openings.empty()) {
    entry(door_colour, "doors");
    entry(window_colour, "windows");
  }
}

}  // namespace

void write_top_view(const std::filesystem::path& path, const TopView& view,
                    const TopViewParams& params) {
  if (params.longest_side < 100)
    throw Error(
        fmt::format("top view: longest_side must be >= 100 pixels, got {}", params.longest_side));
  if (!(params.margin > 0))
    throw Error(fmt::format("top view: margin must be > 0 m, got {}", params.margin));
  if (view.cloud.normals.size() != view.cloud.points.size())
    throw Error("top view: the cloud has no normals");
  const PlanFrame frame = frame_of(view, params);
  const Eigen::Vector2d size = (frame.high - frame.low) * frame.scale;
  Canvas canvas(std::max(legend_width, static_cast<int>(std::lround(size.x()))),
                static_cast<int>(std::lround(size.y() + legend_height)), paper);
  if (view.rooms) draw_rooms(canvas, frame, *view.rooms);
  draw_points(canvas, frame, view.cloud);
  if (view.rooms) draw_openings(canvas, frame, *view.rooms);
  draw_path(canvas, frame, view.before, {.colour = before_colour, .width = 1.5, .opacity = 0.8});
  for (const auto& [a, b] : view.loops)
    canvas.line(frame(view.after[a].translation()), frame(view.after[b].translation()),
                {.colour = loop_colour, .width = 1.5, .opacity = 0.8});
  draw_path(canvas, frame, view.after, {.colour = after_colour, .width = 2});
  draw_names(canvas, frame, view);
  draw_legend(canvas, frame, view);
  canvas.write_png(path);
}

}  // namespace planum
