#include "labeling/label_scene.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "labeling/plan/plan_ring.hpp"

namespace planum {
namespace {

constexpr int extent_directions = 16;

/// Rows are the axes of the frame of LevelPolygon.
Eigen::Matrix3d level_axes(const PolygonMap& map, const Eigen::Vector3d& up, double max_tilt) {
  Eigen::Vector3d forward = Eigen::Vector3d::Zero();
  double largest = 0;
  for (const MapPolygon& polygon : map.polygons) {
    if (std::abs(polygon.plane.normal.dot(up)) > std::sin(max_tilt)) continue;
    if (polygon.area <= largest) continue;
    largest = polygon.area;
    forward = polygon.plane.normal;
  }
  if (largest == 0 && !map.vertices.empty()) forward = map.vertices.back() - map.vertices.front();
  forward -= forward.dot(up) * up;
  if (forward.norm() < 1e-9) forward = up.unitOrthogonal();
  forward.normalize();
  Eigen::Matrix3d axes;
  axes << forward.transpose(), up.cross(forward).transpose(), up.transpose();
  return axes;
}

Attitude attitude_of(double cosine, double max_tilt) {
  if (cosine >= std::cos(max_tilt)) return Attitude::facing_up;
  if (cosine <= -std::cos(max_tilt)) return Attitude::facing_down;
  if (std::abs(cosine) <= std::sin(max_tilt)) return Attitude::upright;
  return Attitude::slanted;
}

void measure(LevelPolygon& polygon) {
  polygon.low = polygon.high = polygon.rings.front().front();
  polygon.plan.clear();
  for (const auto& ring : polygon.rings) {
    polygon.plan.emplace_back();
    for (const Eigen::Vector3d& p : ring) {
      polygon.low = polygon.low.cwiseMin(p);
      polygon.high = polygon.high.cwiseMax(p);
      polygon.plan.back().push_back(p.head<2>());
    }
  }
  polygon.length = 0;
  for (int k = 0; k < extent_directions; ++k) {
    const double angle = pi * k / extent_directions;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Eigen::Vector2d& p : polygon.plan.front()) {
      low = std::min(low, direction.dot(p));
      high = std::max(high, direction.dot(p));
    }
    polygon.length = std::max(polygon.length, high - low);
  }
}

double side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

}  // namespace

bool LevelPolygon::covers(const Eigen::Vector2d& p) const {
  if (p.x() < low.x() || p.y() < low.y() || p.x() > high.x() || p.y() > high.y()) return false;
  return rings_contain(plan, p);
}

double LevelPolygon::height_at(const Eigen::Vector2d& p) const {
  return (plane.offset - plane.normal.head<2>().dot(p)) / plane.normal.z();
}

LabelScene label_scene(const PolygonMap& map, const Eigen::Vector3d& up, double max_tilt) {
  const Eigen::Matrix3d axes = level_axes(map, up, max_tilt);
  LabelScene scene;
  for (const MapPolygon& polygon : map.polygons) {
    LevelPolygon level;
    const double cosine = polygon.plane.normal.dot(up);
    const double from_level = std::acos(std::min(1.0, std::abs(cosine)));
    level.attitude = attitude_of(cosine, max_tilt);
    level.tilt = std::min(from_level, pi / 2 - from_level);
    level.area = polygon.area;
    level.outer = polygon.outer;
    level.plane = {axes * polygon.plane.normal, polygon.plane.offset};
    const auto add = [&](const Ring& ring) {
      level.rings.emplace_back();
      for (const std::uint32_t v : ring) level.rings.back().push_back(axes * map.vertices[v]);
    };
    add(polygon.outer);
    for (const Ring& hole : polygon.holes) add(hole);
    measure(level);
    scene.polygons.push_back(std::move(level));
  }
  return scene;
}

LabelScene upside_down(const LabelScene& scene) {
  LabelScene turned = scene;
  for (LevelPolygon& polygon : turned.polygons) {
    // Half a turn about x: up and down change places, nothing is mirrored.
    const auto turn = [](Eigen::Vector3d& p) { p = Eigen::Vector3d(p.x(), -p.y(), -p.z()); };
    turn(polygon.plane.normal);
    for (auto& ring : polygon.rings)
      for (Eigen::Vector3d& p : ring) turn(p);
    measure(polygon);
    if (polygon.attitude == Attitude::facing_up)
      polygon.attitude = Attitude::facing_down;
    else if (polygon.attitude == Attitude::facing_down)
      polygon.attitude = Attitude::facing_up;
  }
  return turned;
}

std::optional<double> height_of_floor_below(const LabelScene& scene,
                                            const std::vector<PolygonLabel>& labels,
                                            const Eigen::Vector2d& place, double height) {
  std::optional<double> highest;
  for (std::size_t i = 0; i < scene.polygons.size(); ++i) {
    if (labels[i].label != Label::floor || !scene.polygons[i].covers(place)) continue;
    const double floor = scene.polygons[i].height_at(place);
    if (floor <= height && (!highest || floor > *highest)) highest = floor;
  }
  return highest;
}

std::vector<PlanSegment> cross_section(const LevelPolygon& polygon, double height) {
  if (height <= polygon.low.z() || height >= polygon.high.z()) return {};
  std::vector<Eigen::Vector2d> points;
  for (const auto& ring : polygon.rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector3d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.z() > height) == (b.z() > height)) continue;
      const double t = (height - a.z()) / (b.z() - a.z());
      points.push_back((1 - t) * a.head<2>() + t * b.head<2>());
    }
  const Eigen::Vector2d along(-polygon.plane.normal.y(), polygon.plane.normal.x());
  std::sort(points.begin(), points.end(),
            [&](const auto& a, const auto& b) { return along.dot(a) < along.dot(b); });
  std::vector<PlanSegment> segments;
  for (std::size_t i = 0; i + 1 < points.size(); i += 2)
    segments.push_back({points[i], points[i + 1]});
  return segments;
}

bool segments_cross(const PlanSegment& s, const PlanSegment& t) {
  return side(s.a, s.b, t.a) * side(s.a, s.b, t.b) <= 0 &&
         side(t.a, t.b, s.a) * side(t.a, t.b, s.b) <= 0;
}

std::vector<Eigen::Vector2d> plan_samples(const LevelPolygon& polygon, int count) {
  const Eigen::Vector2d low = polygon.low.head<2>(), size = polygon.high.head<2>() - low;
  const double step = std::sqrt(std::max(polygon.area, 1e-6) / count);
  std::vector<Eigen::Vector2d> samples;
  for (double y = step / 2; y < size.y(); y += step)
    for (double x = step / 2; x < size.x(); x += step)
      if (polygon.covers(low + Eigen::Vector2d(x, y)))
        samples.push_back(low + Eigen::Vector2d(x, y));
  if (samples.empty() && polygon.covers(low + size / 2)) samples.push_back(low + size / 2);
  return samples;
}

}  // namespace planum
