#include "labeling/reflections.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "labeling/plan/plan_ring.hpp"
#include "meshing/plane_geometry.hpp"
#include "meshing/polygon_drafts.hpp"
#include "slam/core/error.hpp"

namespace planum {
namespace {

constexpr double upright = 0.26;  // sine of 15 degrees, of a normal's tilt from level

/// A vertical mirror.
struct Pane {
  Eigen::Vector3d middle, out;  ///< m; unit, level, away from its room

  double depth_of(const Eigen::Vector3d& p) const { return out.dot(p - middle); }
  Pane moved(double by) const { return {middle + by * out, out}; }
  Eigen::Vector3d image_of(const Eigen::Vector3d& p) const { return p - 2 * depth_of(p) * out; }
  Eigen::Vector3d turned(const Eigen::Vector3d& n) const { return n - 2 * out.dot(n) * out; }
};

/// A polygon with its rings in its own plane.
struct Surface {
  Surface(const PolygonMap& map, std::size_t which)
      : polygon(which), plane(map.polygons[which].plane), frame(plane) {
    std::vector<Ring> all{map.polygons[which].outer};
    all.insert(all.end(), map.polygons[which].holes.begin(), map.polygons[which].holes.end());
    rings = flat_rings(all, plane, map.vertices);
  }

  bool covers(const Eigen::Vector3d& p) const { return rings_contain(rings, frame.flat(p)); }

  /// A regular grid of points, at least one to the middle of a side.
  std::vector<Eigen::Vector3d> samples(double spacing) const {
    Eigen::Vector2d low = rings[0][0], high = low;
    for (const Eigen::Vector2d& p : rings[0]) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const Eigen::Vector2d size = high - low;
    const Eigen::Vector2i count = (size / spacing).array().ceil().max(1).cast<int>();
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < count.x(); ++i)
      for (int k = 0; k < count.y(); ++k) {
        const Eigen::Vector2d p = low + Eigen::Vector2d((i + 0.5) * size.x() / count.x(),
                                                        (k + 0.5) * size.y() / count.y());
        if (rings_contain(rings, p)) points.push_back(frame.raised(p));
      }
    return points;
  }

  std::size_t polygon;
  Plane plane;
  PlaneFrame frame;
  std::vector<Ring2d> rings;
};

/// What may be a mirror image.
struct Suspect {
  Surface surface;
  double area;                           ///< m^2
  std::vector<Eigen::Vector3d> samples;  ///< m
};

class ReflectionFinder {
 public:
  ReflectionFinder(const PolygonMap& map, const Labels& labels, const RoomMap& rooms,
                   const ReflectionParams& params)
      : map_(map), labels_(labels), rooms_(rooms), params_(params) {}

  /// Marks the images behind a window.
  void find(const Opening& window, std::vector<bool>& is_image) const {
    const Pane wall{window.position, window.across.normalized()};
    const double half = (window.thickness > 0 ? window.thickness : params_.usual_wall) / 2;
    const std::vector<Suspect> suspects = suspects_behind(wall);
    if (suspects.empty()) return;
    const std::vector<Surface> before = surfaces_before(wall);
    const double reach = half + params_.pane_reach;
    const int steps = static_cast<int>(std::ceil(reach / params_.pane_step));
    double most = 0;
    std::vector<std::size_t> best;
    for (int step = -steps; step <= steps; ++step) {
      const std::vector<std::size_t> found =
          images(suspects, before, wall.moved(step * params_.pane_step));
      double area = 0;
      for (const std::size_t s : found)
        if (std::abs(suspects[s].surface.plane.normal.z()) < upright) area += suspects[s].area;
      if (area < params_.min_area || area <= most) continue;
      most = area;
      best = found;
    }
    for (const std::size_t s : best) is_image[suspects[s].surface.polygon] = true;
  }

 private:
  std::vector<Suspect> suspects_behind(const Pane& wall) const {
    std::vector<Suspect> suspects;
    for (std::size_t i = 0; i < map_.polygons.size(); ++i) {
      const Label label = labels_.polygons[i].label;
      if (rooms_.room_of_polygon[i] >= 0 || label == Label::unknown || label == Label::window)
        continue;
      const auto& outer = map_.polygons[i].outer;
      if (!std::all_of(outer.begin(), outer.end(),
                       [&](std::uint32_t v) { return wall.depth_of(map_.vertices[v]) > 0; }))
        continue;
      // Light came through the window, so that it faces there.
      if (map_.polygons[i].plane.signed_distance(wall.middle) <= 0) continue;
      Surface surface(map_, i);
      std::vector<Eigen::Vector3d> samples = surface.samples(params_.sample_spacing);
      if (!samples.empty())
        suspects.push_back({std::move(surface), map_.polygons[i].area, std::move(samples)});
    }
    return suspects;
  }

  std::vector<Surface> surfaces_before(const Pane& wall) const {
    std::vector<Surface> before;
    for (std::size_t i = 0; i < map_.polygons.size(); ++i) {
      const auto& outer = map_.polygons[i].outer;
      if (std::any_of(outer.begin(), outer.end(),
                      [&](std::uint32_t v) { return wall.depth_of(map_.vertices[v]) < 0; }))
        before.emplace_back(map_, i);
    }
    return before;
  }

  /// The suspects whose images in the pane lie on surfaces before it.
  std::vector<std::size_t> images(const std::vector<Suspect>& suspects,
                                  const std::vector<Surface>& before, const Pane& pane) const {
    std::vector<std::size_t> found;
    for (std::size_t s = 0; s < suspects.size(); ++s) {
      const Eigen::Vector3d normal = pane.turned(suspects[s].surface.plane.normal);
      std::vector<const Surface*> alike;
      for (const Surface& surface : before)
        if (surface.polygon != suspects[s].surface.polygon &&
            surface.plane.normal.dot(normal) > std::cos(params_.max_angle))
          alike.push_back(&surface);
      const auto is_on_one = [&](const Eigen::Vector3d& p) {
        const Eigen::Vector3d image = pane.image_of(p);
        return std::any_of(alike.begin(), alike.end(), [&](const Surface* surface) {
          return std::abs(surface->plane.signed_distance(image)) < params_.max_distance &&
                 surface->covers(image);
        });
      };
      const auto& samples = suspects[s].samples;
      const auto on = std::count_if(samples.begin(), samples.end(), is_on_one);
      if (static_cast<double>(on) >= params_.min_share * static_cast<double>(samples.size()))
        found.push_back(s);
    }
    return found;
  }

  const PolygonMap& map_;
  const Labels& labels_;
  const RoomMap& rooms_;
  const ReflectionParams& params_;
};

void check(const PolygonMap& map, const Labels& labels, const RoomMap& rooms) {
  const std::size_t count = map.polygons.size();
  if (labels.polygons.size() != count || rooms.room_of_polygon.size() != count)
    throw Error("reflections: " + std::to_string(count) + " polygons with " +
                std::to_string(labels.polygons.size()) + " labels, and rooms of " +
                std::to_string(rooms.room_of_polygon.size()));
}

}  // namespace

Labels without_reflections(const PolygonMap& map, Labels labels, const RoomMap& rooms,
                           const ReflectionParams& params) {
  check(map, labels, rooms);
  const ReflectionFinder finder(map, labels, rooms, params);
  std::vector<bool> is_image(map.polygons.size(), false);
  for (const Opening& opening : rooms.openings)
    if (opening.kind == OpeningKind::window && opening.rooms.size() == 1)
      finder.find(opening, is_image);
  for (std::size_t i = 0; i < is_image.size(); ++i)
    if (is_image[i]) labels.polygons[i] = {Label::unknown, params.min_share};
  return labels;
}

}  // namespace planum
