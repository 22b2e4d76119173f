#include "labeling/rules/stairs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "meshing/plane_geometry.hpp"

namespace planum {
namespace {

constexpr double beside = 0.12;            // m between a step and the next, seen from above
constexpr double riser_reach = 0.08;       // m from a riser to its step
constexpr double max_covered_share = 0.6;  // of a step by the next one
constexpr int samples = 40;                // of a step
constexpr int min_rises = 2;
constexpr double max_rises = 2;  // of a riser: a podium may be as high as two steps
constexpr double edge_confidence = 0.6;

double distance_to_outline(const Eigen::Vector2d& p, const Ring2d& ring) {
  const auto lifted = [](const Eigen::Vector2d& q) { return Eigen::Vector3d(q.x(), q.y(), 0); };
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < ring.size(); ++i)
    nearest = std::min(nearest, squared_distance_to_segment(lifted(p), lifted(ring[i]),
                                                            lifted(ring[(i + 1) % ring.size()])));
  return std::sqrt(nearest);
}

/// Between two outlines seen from above; 0 where one has a corner in the other.
double plan_distance(const LevelPolygon& a, const LevelPolygon& b) {
  double nearest = HUGE_VAL;
  for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const Eigen::Vector2d& p : from->plan.front())
      nearest = std::min(nearest, to->covers(p) ? 0 : distance_to_outline(p, to->plan.front()));
  return nearest;
}

/// Share of a polygon that another covers, seen from above.
double covered_share(const LevelPolygon& it, const LevelPolygon& other) {
  const std::vector<Eigen::Vector2d> places = plan_samples(it, samples);
  if (places.empty()) return 1;
  return static_cast<double>(
             std::count_if(places.begin(), places.end(),
                           [&](const Eigen::Vector2d& place) { return other.covers(place); })) /
         static_cast<double>(places.size());
}

class StairSearch {
 public:
  StairSearch(const LabelScene& scene, const LabelParams& params, std::vector<PolygonLabel>& labels)
      : scene_(scene), params_(params), labels_(labels) {}

  void run() {
    std::vector<std::size_t> levels;
    for (std::size_t i = 0; i < labels_.size(); ++i)
      if (labels_[i].label == Label::floor || is_step(i)) levels.push_back(i);
    std::sort(levels.begin(), levels.end(), [&](std::size_t a, std::size_t b) {
      return height(a) != height(b) ? height(a) < height(b) : a < b;
    });
    below_.assign(labels_.size(), 0);
    above_.assign(labels_.size(), 0);
    count_rises(levels);
    for (const std::size_t i : levels)
      if (labels_[i].label != Label::floor && below_[i] + above_[i] >= min_rises)
        labels_[i] = {Label::stair, std::min(0.95, 0.4 + 0.15 * (below_[i] + above_[i]))};
    label_risers();
  }

 private:
  double height(std::size_t i) const { return scene_.polygons[i].middle_height(); }

  bool is_step(std::size_t i) const {
    const LevelPolygon& it = scene_.polygons[i];
    return it.attitude == Attitude::facing_up && it.length >= params_.min_step_width &&
           it.mean_width() >= params_.min_going && it.mean_width() <= params_.max_going;
  }

  /// A rise between two floors is a step in the floor, not a stair.
  bool follows(std::size_t low, std::size_t high) const {
    const double rise = height(high) - height(low);
    if (rise < params_.min_rise || rise > params_.max_rise) return false;
    if (labels_[low].label == Label::floor && labels_[high].label == Label::floor) return false;
    const LevelPolygon &a = scene_.polygons[low], &b = scene_.polygons[high];
    return plan_distance(a, b) <= beside && covered_share(a, b) <= max_covered_share &&
           covered_share(b, a) <= max_covered_share;
  }

  /// The longest way down and up from each step, in rises; floors are ends.
  void count_rises(const std::vector<std::size_t>& levels) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t b = 0; b < levels.size(); ++b)
      for (std::size_t a = b; a-- > 0;) {
        if (height(levels[b]) - height(levels[a]) > params_.max_rise) break;
        if (follows(levels[a], levels[b])) pairs.emplace_back(levels[a], levels[b]);
      }
    for (const auto& [low, high] : pairs)
      below_[high] = std::max(below_[high], 1 + rises_beyond(below_, low));
    for (auto it = pairs.rbegin(); it != pairs.rend(); ++it)
      above_[it->first] = std::max(above_[it->first], 1 + rises_beyond(above_, it->second));
  }

  int rises_beyond(const std::vector<int>& rises, std::size_t i) const {
    return labels_[i].label == Label::floor ? 0 : rises[i];
  }

  void label_risers() {
    for (std::size_t r = 0; r < labels_.size(); ++r) {
      const LevelPolygon& riser = scene_.polygons[r];
      if (riser.attitude != Attitude::upright || labels_[r].label == Label::wall ||
          riser.high.z() - riser.low.z() > max_rises * params_.max_rise)
        continue;
      if (is_edge_of_floor(riser)) labels_[r] = {Label::stair, edge_confidence};
      for (std::size_t i = 0; i < labels_.size(); ++i) {
        if (labels_[i].label != Label::stair || scene_.polygons[i].attitude != Attitude::facing_up)
          continue;
        const bool ends_there = std::abs(riser.high.z() - height(i)) < riser_reach ||
                                std::abs(riser.low.z() - height(i)) < riser_reach;
        if (ends_there && plan_distance(riser, scene_.polygons[i]) < riser_reach) {
          labels_[r] = {Label::stair, labels_[i].confidence};
          break;
        }
      }
    }
  }

  /// Whether a floor begins at its upper edge, and another one is at its foot.
  bool is_edge_of_floor(const LevelPolygon& riser) const {
    bool above = false, below = false;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      if (labels_[i].label != Label::floor) continue;
      const auto is_at = [&](double z) {
        return std::abs(height(i) - z) < riser_reach &&
               plan_distance(riser, scene_.polygons[i]) < riser_reach;
      };
      above = above || is_at(riser.high.z());
      below = below || is_at(riser.low.z());
    }
    return above && below;
  }

  const LabelScene& scene_;
  const LabelParams& params_;
  std::vector<PolygonLabel>& labels_;
  std::vector<int> below_, above_;
};

}  // namespace

void label_stairs(const LabelScene& scene, const LabelParams& params,
                  std::vector<PolygonLabel>& labels) {
  StairSearch(scene, params, labels).run();
}

void label_flights(const LabelScene& scene, const LabelParams& params,
                   std::vector<PolygonLabel>& labels) {
  constexpr double confidence = 0.5, max_below = 3;  // m from a flight down to its floor
  std::vector<std::size_t> upwards(labels.size());
  std::iota(upwards.begin(), upwards.end(), std::size_t{0});
  std::stable_sort(upwards.begin(), upwards.end(), [&](std::size_t a, std::size_t b) {
    return scene.polygons[a].low.z() < scene.polygons[b].low.z();
  });
  // A lower flight is as good as a floor.
  const auto is_foot = [&](const Eigen::Vector2d& place, double height) {
    for (std::size_t j = 0; j < labels.size(); ++j) {
      const LevelPolygon& foot = scene.polygons[j];
      if ((labels[j].label != Label::floor && labels[j].label != Label::stair) ||
          foot.attitude == Attitude::upright || !foot.covers(place))
        continue;
      const double below = height - foot.height_at(place);
      if (below > -params.max_rise && below < max_below) return true;
    }
    return false;
  };
  for (const std::size_t i : upwards) {
    const LevelPolygon& it = scene.polygons[i];
    const double slope = std::acos(std::clamp(it.plane.normal.z(), -1.0, 1.0));
    if (it.attitude != Attitude::slanted || slope < params.min_stair_slope ||
        slope > params.max_stair_slope || it.length < params.min_step_width ||
        it.area < params.min_level_area || it.high.z() - it.low.z() < 2 * params.min_rise)
      continue;
    // Downhill, before its lower edge.
    const Eigen::Vector2d down = it.plane.normal.head<2>().normalized();
    const Eigen::Vector2d middle = (it.low + it.high).head<2>() / 2;
    double edge = 0;
    for (const Eigen::Vector2d& p : it.plan.front()) edge = std::max(edge, down.dot(p - middle));
    for (const double away :
         {0.25, 0.5, 1.0, 1.5}) {  // its lowest steps may be polygons of their own
      const Eigen::Vector2d before = middle + (edge + away * params.neighbourhood) * down;
      if (is_foot(before, it.low.z())) labels[i] = {Label::stair, confidence};
    }
  }
}

}  // namespace planum
