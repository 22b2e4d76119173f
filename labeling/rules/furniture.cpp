#include "labeling/rules/furniture.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "labeling/rules/upright.hpp"

namespace planum {
namespace {

constexpr int directions = 8;                // in which a floor beside a top is looked for
constexpr double max_thickness = 0.15;       // m, of a table's top
constexpr double max_reveal_width = 0.7;     // m, of a wall: as thick as OpeningParams allows
constexpr double min_side = 0.1;             // m
constexpr double max_underside_share = 0.9;  // of headroom; lintels begin there
constexpr int samples = 20;

/// The highest floor below a surface or beside it.
std::optional<double> floor_near(const LabelScene& scene, const std::vector<PolygonLabel>& labels,
                                 const LevelPolygon& it, double reach) {
  const Eigen::Vector2d middle = (it.low + it.high).head<2>() / 2;
  const double height = it.low.z() + 0.5 * (it.high.z() - it.low.z());
  std::optional<double> floor = height_of_floor_below(scene, labels, middle, height);
  const double radius = it.length / 2 + reach / 2;
  for (int d = 0; d < directions && !floor; ++d) {
    const double angle = 2 * pi * d / directions;
    const Eigen::Vector2d place =
        middle + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    floor = height_of_floor_below(scene, labels, place, height);
  }
  return floor;
}

bool overlaps_in_plan(const LevelPolygon& a, const LevelPolygon& b) {
  const std::vector<Eigen::Vector2d> places = plan_samples(a, samples);
  return std::any_of(places.begin(), places.end(),
                     [&](const Eigen::Vector2d& place) { return b.covers(place); });
}

bool is_underside(const LabelScene& scene, const std::vector<PolygonLabel>& labels, std::size_t i) {
  const LevelPolygon& it = scene.polygons[i];
  for (std::size_t j = 0; j < labels.size(); ++j) {
    const double above = scene.polygons[j].middle_height() - it.middle_height();
    if (labels[j].label == Label::furniture_horizontal &&
        scene.polygons[j].attitude == Attitude::facing_up && above > 0 && above < max_thickness &&
        overlaps_in_plan(it, scene.polygons[j]))
      return true;
  }
  return false;
}

bool is_reveal(const LabelScene& scene, const std::vector<PolygonLabel>& labels, std::size_t i) {
  const LevelPolygon& it = scene.polygons[i];
  if (width(it) > max_reveal_width) return false;
  int walls = 0;
  for (std::size_t j = 0; j < labels.size(); ++j)
    walls += labels[j].label == Label::wall && shared_vertices(it, scene.polygons[j]) >= 2;
  return walls >= 2;
}

/// A top whose edge this upright surface ends at, or which it stands below.
bool is_below_top(const LabelScene& scene, const std::vector<PolygonLabel>& labels,
                  const LevelPolygon& it, double same_level) {
  for (std::size_t j = 0; j < labels.size(); ++j)
    if (labels[j].label == Label::furniture_horizontal &&
        scene.polygons[j].attitude == Attitude::facing_up &&
        std::abs(scene.polygons[j].middle_height() - it.high.z()) < same_level &&
        shared_vertices(it, scene.polygons[j]) >= 2)
      return true;
  return false;
}

}  // namespace

void label_furniture_tops(const LabelScene& scene, const LabelParams& params,
                          std::vector<PolygonLabel>& labels) {
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const LevelPolygon& it = scene.polygons[i];
    if (it.attitude != Attitude::facing_up || labels[i].label != Label::unknown) continue;
    const auto floor = floor_near(scene, labels, it, params.neighbourhood);
    if (!floor) continue;
    const double height = it.middle_height() - *floor;
    if (height >= params.min_furniture_height && height <= params.max_furniture_height)
      labels[i] = {Label::furniture_horizontal, 0.8 * (1 - 0.5 * it.tilt / params.max_tilt)};
  }
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (scene.polygons[i].attitude == Attitude::facing_down && labels[i].label == Label::unknown &&
        is_underside(scene, labels, i))
      labels[i] = {Label::furniture_horizontal, 0.7};
}

void label_furniture_sides(const LabelScene& scene, const LabelParams& params,
                           std::vector<PolygonLabel>& labels) {
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const LevelPolygon& it = scene.polygons[i];
    if (it.attitude != Attitude::upright || labels[i].label != Label::unknown) continue;
    if (width(it) < min_side || is_reveal(scene, labels, i)) continue;
    const bool below_top = is_below_top(scene, labels, it, params.same_level);
    const auto floor = floor_near(scene, labels, it, params.neighbourhood);
    if (!floor || it.high.z() - *floor > params.max_furniture_height) continue;
    if (below_top)
      labels[i] = {Label::furniture_vertical, 0.85};
    else if (it.low.z() - *floor <= params.max_gap_to_floor)
      labels[i] = {Label::furniture_vertical, 0.6};
  }
}

}  // namespace planum
