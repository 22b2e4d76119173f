#include "labeling/rules/walls.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>

#include "labeling/rules/upright.hpp"

namespace planum {
namespace {

constexpr double min_width = 0.1;               // m, of a wall that ends at a ceiling
constexpr double in_front[] = {0.1, 0.4, 0.8};  // m, where the ceiling over a wall is looked for
constexpr double behind_gap = 0.05, behind_reach = 1.2;  // m, what stands before a wall
constexpr double same_plane = 0.1;                       // m
constexpr double thickness_of_walls[] = {0.06, 0.3};     // m, of those known by their faces
const double opposite = std::cos(radians(8));
constexpr double ceiling_search = 3;  // m

class WallSearch {
 public:
  WallSearch(const LabelScene& scene, const LabelParams& params, std::vector<PolygonLabel>& labels)
      : scene_(scene), params_(params), labels_(labels) {}

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
    if (continues_a_wall(i, sure, 2)) return give(i, Label::wall, 0.85);
    if (stands_before_another(i)) return give(i, Label::unknown, 0.8);
    if (continues_a_wall(i, sure, 0)) return give(i, Label::wall, 0.8);
    if (is_other_face_of_wall(i, sure)) return give(i, Label::wall, 0.7);
    if (is_beam(i)) return give(i, Label::wall, 0.6);
    if (is_parapet(i)) return give(i, Label::wall, 0.55);
    const double height = it.high.z() - it.low.z();
    if (height < params_.min_wall_height || it.area < params_.min_wall_area)
      return give(i, Label::unknown, 0.5);
    give(i, Label::wall, ceiling_over(it, it.middle_height()) ? 0.55 : 0.75);
  }

  /// Whether its upper edge is also the edge of a surface that looks up and is no floor: furniture.
  bool ends_at_top_surface(std::size_t i) const {
    std::set<std::uint32_t> top;
    const double limit = polygon(i).high.z() - params_.same_level;
    const Ring& outer = polygon(i).outer;
    for (std::size_t k = 0; k < outer.size(); ++k)
      if (polygon(i).rings.front()[k].z() > limit) top.insert(outer[k]);
    for (std::size_t j = 0; j < scene_.polygons.size(); ++j) {
      if (polygon(j).attitude != Attitude::facing_up || labels_[j].label == Label::floor) continue;
      if (std::abs(polygon(j).middle_height() - polygon(i).high.z()) > params_.same_level) continue;
      const auto shared = std::count_if(polygon(j).outer.begin(), polygon(j).outer.end(),
                                        [&](std::uint32_t v) { return top.contains(v); });
      if (shared >= 2) return true;
    }
    return false;
  }

  /// A higher upright surface closely behind, facing the same way: this one is furniture.
  bool stands_before_another(std::size_t i) const {
    for (std::size_t j = 0; j < scene_.polygons.size(); ++j) {
      if (j == i || !faces_like(polygon(i), polygon(j))) continue;
      const double behind = -in_front_of(polygon(i), polygon(j));
      if (behind < behind_gap || behind > behind_reach) continue;
      if (polygon(j).high.z() > polygon(i).high.z() + params_.ceiling_gap &&
          overlap(polygon(i), polygon(j)) > 0.5)
        return true;
    }
    return false;
  }

  /// Whether a wall is in its plane, with which it has so many vertices in common.
  bool continues_a_wall(std::size_t i, const std::vector<PolygonLabel>& sure,
                        std::size_t min_shared) const {
    for (std::size_t j = 0; j < scene_.polygons.size(); ++j)
      if (j != i && sure[j].label == Label::wall && faces_like(polygon(i), polygon(j)) &&
          std::abs(in_front_of(polygon(i), polygon(j))) < same_plane &&
          std::abs(in_front_of(polygon(j), polygon(i))) < same_plane &&
          shared_vertices(polygon(i), polygon(j)) >= min_shared)
        return true;
    return false;
  }

  /// Whether the other face of a wall is behind; upright enough not to be a skirting or a radiator.
  bool is_other_face_of_wall(std::size_t i, const std::vector<PolygonLabel>& sure) const {
    if (polygon(i).high.z() - polygon(i).low.z() < params_.min_wall_height) return false;
    for (std::size_t j = 0; j < scene_.polygons.size(); ++j) {
      if (sure[j].label != Label::wall ||
          polygon(i).plane.normal.dot(polygon(j).plane.normal) > -opposite)
        continue;
      const double thickness =
          -polygon(j).plane.signed_distance((polygon(i).low + polygon(i).high) / 2);
      if (thickness > thickness_of_walls[0] && thickness < thickness_of_walls[1] &&
          overlap(polygon(i), polygon(j)) > 0.5)
        return true;
    }
    return false;
  }

  /// Long, above headroom, and no ceiling above: the side of a beam or the wall above an opening.
  bool is_beam(std::size_t i) const {
    const LevelPolygon& it = polygon(i);
    if (width(it) < params_.min_beam_length || ceiling_over(it, it.middle_height())) return false;
    const Eigen::Vector2d before =
        (it.low + it.high).head<2>() / 2 + in_front[1] * it.plane.normal.head<2>();
    const auto floor = height_of_floor_below(scene_, labels_, before, it.low.z());
    return floor && it.low.z() - *floor >= params_.min_headroom;
  }

  /// Long, from the floor up, and the floor ends there: low walls below windows.
  bool is_parapet(std::size_t i) const {
    const LevelPolygon& it = polygon(i);
    const Extent reach = extent(it, along(it));
    if (reach.length() < params_.min_beam_length) return false;
    const Eigen::Vector2d normal = it.plane.normal.head<2>().normalized();
    const double off = normal.dot(it.plan.front().front());
    constexpr int places = 10;
    int bounds = 0;
    for (int k = 0; k < places; ++k) {
      const Eigen::Vector2d foot =
          (reach.from + reach.length() * (k + 0.5) / places) * along(it) + off * normal;
      const auto floor_at = [&](double distance, double highest) {
        const auto floor =
            height_of_floor_below(scene_, labels_, foot + distance * normal, highest);
        return floor && it.low.z() - *floor < params_.same_level;
      };
      const bool ends = std::none_of(std::begin(in_front), std::end(in_front), [&](double d) {
        return floor_at(-d, it.high.z() + params_.same_level);
      });
      bounds += ends && floor_at(in_front[0], it.low.z() + params_.same_level);
    }
    return bounds >= 0.8 * places;
  }

  const LabelScene& scene_;
  const LabelParams& params_;
  std::vector<PolygonLabel>& labels_;
};

}  // namespace

void label_walls(const LabelScene& scene, const LabelParams& params,
                 std::vector<PolygonLabel>& labels) {
  WallSearch(scene, params, labels).run();
}

void label_wall_ends(const LabelScene& scene, const LabelParams& params,
                     std::vector<PolygonLabel>& labels) {
  constexpr double end_confidence = 0.6, max_width = 0.45;  // m, as thick as walls are
  const std::vector<PolygonLabel> before = labels;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const LevelPolygon& it = scene.polygons[i];
    if (it.attitude != Attitude::upright || before[i].label != Label::unknown ||
        width(it) > max_width || it.high.z() - it.low.z() < params.min_wall_height)
      continue;
    int walls = 0;
    for (std::size_t j = 0; j < labels.size(); ++j)
      walls += before[j].label == Label::wall && scene.polygons[j].attitude == Attitude::upright &&
               shared_vertices(it, scene.polygons[j]) >= 2;
    if (walls >= 2) labels[i] = {Label::wall, end_confidence};
  }
}

void label_soffits(const LabelScene& scene, const LabelParams& params,
                   std::vector<PolygonLabel>& labels) {
  constexpr double soffit_confidence = 0.6;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const LevelPolygon& it = scene.polygons[i];
    if (it.attitude != Attitude::facing_down || labels[i].label != Label::unknown ||
        it.mean_width() >= params.min_ceiling_width)
      continue;
    const auto floor =
        height_of_floor_below(scene, labels, (it.low + it.high).head<2>() / 2, it.low.z());
    if (!floor || it.low.z() - *floor < params.min_headroom) continue;
    for (std::size_t j = 0; j < labels.size(); ++j)
      if (scene.polygons[j].attitude == Attitude::upright && labels[j].label == Label::wall &&
          shared_vertices(it, scene.polygons[j]) >= 2)
        labels[i] = {Label::wall, soffit_confidence};
  }
}

}  // namespace planum
