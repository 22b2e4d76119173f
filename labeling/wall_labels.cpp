#include "labeling/wall_labels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

namespace planum {
namespace {

constexpr double min_width = 0.1;               // m, of a wall that ends at a ceiling
constexpr double in_front[] = {0.1, 0.4, 0.8};  // m, where the ceiling over a wall is looked for
constexpr double behind_gap = 0.05, behind_reach = 1.2;  // m, what stands before a wall
constexpr double same_plane = 0.1;                       // m
const double same_direction = std::cos(radians(8));
constexpr double ceiling_search = 3;  // m

class WallSearch {
 public:
  WallSearch(const PolygonMap& map, const LabelScene& scene, const LabelParams& params,
             std::vector<PolygonLabel>& labels)
      : map_(map), scene_(scene), params_(params), labels_(labels) {}

  void run() {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < scene_.polygons.size(); ++i) {
      if (scene_.polygons[i].attitude != Attitude::upright) continue;
      if (ends_at_ceiling(i))
        give(i, Label::wall, 0.95);
      else
        open.push_back(i);
    }
    const std::vector<PolygonLabel> sure = labels_;
    for (const std::size_t i : open) judge(i, sure);
  }

 private:
  const LevelPolygon& polygon(std::size_t i) const { return scene_.polygons[i]; }

  void give(std::size_t i, Label label, double confidence) {
    // A leaning wall is less of a wall.
    const double lean = 1 - 0.5 * polygon(i).tilt / params_.max_tilt;
    labels_[i] = {label, label == Label::unknown ? confidence : confidence * lean};
  }

  Eigen::Vector2d along(const LevelPolygon& p) const {
    return Eigen::Vector2d(-p.plane.normal.y(), p.plane.normal.x()).normalized();
  }

  /// Its extent along its horizontal direction.
  std::pair<double, double> extent(const LevelPolygon& p, const Eigen::Vector2d& direction) const {
    std::pair<double, double> range{std::numeric_limits<double>::infinity(),
                                    -std::numeric_limits<double>::infinity()};
    for (const Eigen::Vector2d& q : p.plan.front()) {
      range.first = std::min(range.first, direction.dot(q));
      range.second = std::max(range.second, direction.dot(q));
    }
    return range;
  }

  double width(const LevelPolygon& p) const {
    const auto [from, to] = extent(p, along(p));
    return to - from;
  }

  /// The height of the ceiling in front of a place on a wall, above `height`; if none is there, of
  /// the nearest one.
  std::optional<double> ceiling_over(const LevelPolygon& wall, double height) const {
    const Eigen::Vector2d normal = wall.plane.normal.head<2>().normalized(), run = along(wall);
    const auto [from, to] = extent(wall, run);
    const double off = normal.dot(wall.plan.front().front());
    std::optional<double> lowest;
    for (int k = 0; k < 5; ++k)
      for (const double distance : in_front) {
        const Eigen::Vector2d place =
            (from + (to - from) * (k + 0.5) / 5) * run + (off + distance) * normal;
        for (std::size_t c = 0; c < labels_.size(); ++c) {
          if (labels_[c].label != Label::ceiling || !polygon(c).covers(place)) continue;
          const double z = polygon(c).height_at(place);
          if (z > height && (!lowest || z < *lowest)) lowest = z;
        }
      }
    return lowest ? lowest : nearest_ceiling(wall, height);
  }

  std::optional<double> nearest_ceiling(const LevelPolygon& wall, double height) const {
    std::optional<double> best;
    double nearest = ceiling_search;
    for (std::size_t c = 0; c < labels_.size(); ++c) {
      if (labels_[c].label != Label::ceiling || polygon(c).high.z() <= height) continue;
      const Eigen::Vector2d gap =
          (polygon(c).low - wall.high).cwiseMax(wall.low - polygon(c).high).cwiseMax(0).head<2>();
      if (gap.norm() >= nearest) continue;
      nearest = gap.norm();
      best = polygon(c).middle_height();
    }
    return best;
  }

  bool ends_at_ceiling(std::size_t i) const {
    const LevelPolygon& wall = polygon(i);
    if (width(wall) < min_width) return false;
    const auto ceiling = ceiling_over(wall, wall.middle_height());
    return ceiling && wall.high.z() >= *ceiling - params_.ceiling_gap;
  }

  void judge(std::size_t i, const std::vector<PolygonLabel>& sure) {
    const LevelPolygon& it = polygon(i);
    if (width(it) < 2.5 * min_width) return give(i, Label::unknown, 0.7);
    if (ends_at_top_surface(i)) return give(i, Label::unknown, 0.9);
    if (stands_before_another(i)) return give(i, Label::unknown, 0.8);
    if (continues_a_wall(i, sure)) return give(i, Label::wall, 0.85);
    const double height = it.high.z() - it.low.z();
    if (height < params_.min_wall_height || it.area < params_.min_wall_area)
      return give(i, Label::unknown, 0.5);
    give(i, Label::wall, ceiling_over(it, it.middle_height()) ? 0.55 : 0.75);
  }

  /// Whether its upper edge is also the edge of a surface that looks up and is no floor: furniture.
  bool ends_at_top_surface(std::size_t i) const {
    std::set<std::uint32_t> top;
    const double limit = polygon(i).high.z() - params_.same_level;
    const Ring& outer = map_.polygons[i].outer;
    for (std::size_t k = 0; k < outer.size(); ++k)
      if (polygon(i).rings.front()[k].z() > limit) top.insert(outer[k]);
    for (std::size_t j = 0; j < scene_.polygons.size(); ++j) {
      if (polygon(j).attitude != Attitude::facing_up || labels_[j].label == Label::floor) continue;
      if (std::abs(polygon(j).middle_height() - polygon(i).high.z()) > params_.same_level) continue;
      const auto shared =
          std::count_if(map_.polygons[j].outer.begin(), map_.polygons[j].outer.end(),
                        [&](std::uint32_t v) { return top.contains(v); });
      if (shared >= 2) return true;
    }
    return false;
  }

  /// Share of polygon i's width that polygon j covers too, seen along the normal of i.
  double overlap(std::size_t i, std::size_t j) const {
    const Eigen::Vector2d run = along(polygon(i));
    const auto [a, b] = extent(polygon(i), run);
    const auto [c, d] = extent(polygon(j), run);
    return (std::min(b, d) - std::max(a, c)) / std::max(b - a, 1e-9);
  }

  /// How far polygon j is in front of polygon i's plane, at the middle of j.
  double in_front_of(std::size_t i, std::size_t j) const {
    return polygon(i).plane.signed_distance((polygon(j).low + polygon(j).high) / 2);
  }

  bool faces_like(std::size_t i, std::size_t j) const {
    return j != i && polygon(j).attitude == Attitude::upright &&
           polygon(i).plane.normal.dot(polygon(j).plane.normal) > same_direction;
  }

  /// A higher upright surface closely behind, facing the same way: this one is furniture.
  bool stands_before_another(std::size_t i) const {
    for (std::size_t j = 0; j < scene_.polygons.size(); ++j) {
      if (!faces_like(i, j)) continue;
      const double behind = -in_front_of(i, j);
      if (behind < behind_gap || behind > behind_reach) continue;
      if (polygon(j).high.z() > polygon(i).high.z() + params_.ceiling_gap && overlap(i, j) > 0.5)
        return true;
    }
    return false;
  }

  bool continues_a_wall(std::size_t i, const std::vector<PolygonLabel>& sure) const {
    for (std::size_t j = 0; j < scene_.polygons.size(); ++j)
      if (sure[j].label == Label::wall && faces_like(i, j) &&
          std::abs(in_front_of(i, j)) < same_plane && std::abs(in_front_of(j, i)) < same_plane)
        return true;
    return false;
  }

  const PolygonMap& map_;
  const LabelScene& scene_;
  const LabelParams& params_;
  std::vector<PolygonLabel>& labels_;
};

}  // namespace

void label_walls(const PolygonMap& map, const LabelScene& scene, const LabelParams& params,
                 std::vector<PolygonLabel>& labels) {
  WallSearch(map, scene, params, labels).run();
}

}  // namespace planum
