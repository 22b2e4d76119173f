#include "labeling/rules/floor_doubts.hpp"

#include <cmath>

#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr int samples = 200;            // of a polygon
constexpr int directions = 12;          // around a sample
constexpr int steps = 4;                // to the end of the neighbourhood
constexpr double above_surface = 0.05;  // m, where the way to the neighbourhood is looked at

/// What is around a surface that may be a floor.
class FloorSearch {
 public:
  FloorSearch(const LabelScene& scene, const LevelPolygon& polygon, const LabelParams& params)
      : polygon_(polygon), params_(params) {
    const double height = polygon.high.z() + above_surface;
    for (const LevelPolygon& other : scene.polygons) {
      if (!is_near(other)) continue;
      if (other.attitude == Attitude::facing_up) ups_.push_back(&other);
      if (other.attitude == Attitude::facing_down) downs_.push_back(&other);
      if (other.attitude != Attitude::upright) continue;
      for (const PlanSegment& segment : cross_section(other, height)) obstacles_.push_back(segment);
    }
  }

  double doubt() const {
    const std::vector<Eigen::Vector2d> places = plan_samples(polygon_, samples);
    if (places.empty()) return 1;
    int bad = 0;
    for (const Eigen::Vector2d& place : places) bad += has_no_headroom(place) || is_raised(place);
    return bad / static_cast<double>(places.size());
  }

 private:
  bool is_near(const LevelPolygon& other) const {
    const double reach = params_.neighbourhood;
    return (other.low.head<2>().array() <= polygon_.high.head<2>().array() + reach).all() &&
           (other.high.head<2>().array() >= polygon_.low.head<2>().array() - reach).all();
  }

  bool has_no_headroom(const Eigen::Vector2d& place) const {
    const double height = polygon_.height_at(place);
    for (const LevelPolygon* down : downs_) {
      if (!down->covers(place)) continue;
      const double headroom = down->height_at(place) - height;
      if (headroom > params_.same_level && headroom < params_.min_headroom) return true;
    }
    return false;
  }

  /// Whether a lower surface is beside a place, with no wall between.
  bool is_raised(const Eigen::Vector2d& place) const {
    for (int d = 0; d < directions; ++d) {
      const double angle = 2 * pi * d / directions;
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      for (int s = 1; s <= steps; ++s) {
        const Eigen::Vector2d there = place + params_.neighbourhood * s / steps * direction;
        if (is_lower_surface(there, polygon_.height_at(place)) && !is_blocked({place, there}))
          return true;
      }
    }
    return false;
  }

  bool is_lower_surface(const Eigen::Vector2d& place, double height) const {
    for (const LevelPolygon* up : ups_) {
      if (!up->covers(place)) continue;
      const double below = height - up->height_at(place);
      if (below > params_.same_level && below < params_.max_raise) return true;
    }
    return false;
  }

  bool is_blocked(const PlanSegment& way) const {
    for (const PlanSegment& obstacle : obstacles_)
      if (segments_cross(way, obstacle)) return true;
    return false;
  }

  const LevelPolygon& polygon_;
  const LabelParams& params_;
  std::vector<const LevelPolygon*> ups_, downs_;
  std::vector<PlanSegment> obstacles_;
};

}  // namespace

std::vector<double> floor_doubts(const LabelScene& scene, const LabelParams& params) {
  std::vector<double> doubts(scene.polygons.size(), 1);
  parallel_for(doubts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (scene.polygons[i].attitude == Attitude::facing_up)
        doubts[i] = FloorSearch(scene, scene.polygons[i], params).doubt();
  });
  return doubts;
}

}  // namespace planum
