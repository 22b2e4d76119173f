#include "labeling/rules/floors.hpp"

#include <algorithm>
#include <cmath>

#include "labeling/rules/floor_doubts.hpp"

namespace planum {
namespace {

constexpr double roof_confidence = 0.6, roof_share = 0.5;
constexpr int roof_samples = 60;

/// Labels the surfaces of one attitude whose doubt is small, if they are large or at the level of
/// large ones.
void label_levels(const LabelScene& scene, Attitude attitude, Label label,
                  const std::vector<double>& doubts, double min_width, const LabelParams& params,
                  std::vector<PolygonLabel>& labels) {
  const auto is_large = [&](const LevelPolygon& it) {
    return it.area >= params.min_level_area && it.mean_width() >= min_width;
  };
  const auto is_at_a_level = [&](std::size_t i) {
    const LevelPolygon& it = scene.polygons[i];
    if (is_large(it)) return true;
    return std::any_of(
        scene.polygons.begin(), scene.polygons.end(), [&](const LevelPolygon& other) {
          const auto j = static_cast<std::size_t>(&other - scene.polygons.data());
          return other.attitude == attitude && is_large(other) &&
                 doubts[j] <= params.max_raised_share &&
                 std::abs(other.middle_height() - it.middle_height()) < params.same_level;
        });
  };
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (scene.polygons[i].attitude != attitude) continue;
    const double slope = 0.5 * scene.polygons[i].tilt / params.max_tilt;
    if (doubts[i] <= params.max_raised_share && is_at_a_level(i))
      labels[i] = {label, (1 - slope) * (1 - 0.5 * doubts[i])};
    else
      labels[i] = {Label::unknown, std::max(0.5, doubts[i])};
  }
}

/// Whether a floor is below a place, with headroom.
bool is_above_floor(const LabelScene& scene, const std::vector<PolygonLabel>& labels,
                    const Eigen::Vector2d& place, double height, double min_headroom) {
  const auto floor = height_of_floor_below(scene, labels, place, height);
  return floor && height - *floor >= min_headroom;
}

}  // namespace

void label_floors(const LabelScene& scene, const LabelParams& params,
                  std::vector<PolygonLabel>& labels) {
  label_levels(scene, Attitude::facing_up, Label::floor, floor_doubts(scene, params), 0, params,
               labels);
}

void label_ceilings(const LabelScene& scene, const LabelParams& params,
                    std::vector<PolygonLabel>& labels) {
  label_levels(scene, Attitude::facing_down, Label::ceiling,
               floor_doubts(upside_down(scene), params), params.min_ceiling_width, params, labels);
}

void label_roofs(const LabelScene& scene, const LabelParams& params,
                 std::vector<PolygonLabel>& labels) {
  const double max_cosine = -std::cos(params.max_roof_tilt);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const LevelPolygon& it = scene.polygons[i];
    if (it.attitude != Attitude::slanted || it.plane.normal.z() > max_cosine) continue;
    if (it.mean_width() < params.min_ceiling_width) continue;
    const std::vector<Eigen::Vector2d> places = plan_samples(it, roof_samples);
    const auto over_floor =
        std::count_if(places.begin(), places.end(), [&](const Eigen::Vector2d& place) {
          return is_above_floor(scene, labels, place, it.height_at(place), params.min_headroom);
        });
    if (!places.empty() &&
        static_cast<double>(over_floor) >= roof_share * static_cast<double>(places.size()))
      labels[i] = {Label::ceiling, roof_confidence};
  }
}

}  // namespace planum
