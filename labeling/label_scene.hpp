#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "labeling/labels.hpp"
#include "meshing/plane_geometry.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// How a polygon lies.
enum class Attitude { facing_up, facing_down, upright, slanted };

/// A polygon in a frame with z up whose x axis looks along the largest wall's normal: what is found
/// there does not depend on how the scene was turned.
struct LevelPolygon {
  Attitude attitude = Attitude::slanted;
  double tilt = 0;  ///< rad, from level or upright, whichever is nearer
  double area = 0;  ///< m^2
  Plane plane;
  std::vector<std::vector<Eigen::Vector3d>> rings;  ///< the outer one first
  std::vector<Ring2d> plan;                         ///< rings seen from above
  std::vector<std::uint32_t> outer;                 ///< vertices of the map, of the outer ring
  Eigen::Vector3d low, high;                        ///< m, corners of the bounding box
  double length = 0;                                ///< m, the greatest extent seen from above

  double middle_height() const { return (low.z() + high.z()) / 2; }
  double mean_width() const { return length > 0 ? area / length : 0; }  ///< m, of level ones
  bool covers(const Eigen::Vector2d& p) const;                          ///< seen from above
  /// Height of the plane above a place seen from above; not for upright ones.
  double height_at(const Eigen::Vector2d& p) const;
};

struct LabelScene {
  std::vector<LevelPolygon> polygons;  ///< in the order of the map
};

LabelScene label_scene(const PolygonMap& map, const Eigen::Vector3d& up, double max_tilt);

/// The scene upside down: ceilings become floors.
LabelScene upside_down(const LabelScene& scene);

/// Height of the highest floor at or below a place, or nothing.
std::optional<double> height_of_floor_below(const LabelScene& scene,
                                            const std::vector<PolygonLabel>& labels,
                                            const Eigen::Vector2d& place, double height);

/// A line seen from above.
struct PlanSegment {
  Eigen::Vector2d a, b;  ///< m
};

/// Where an upright polygon is at a height.
std::vector<PlanSegment> cross_section(const LevelPolygon& polygon, double height);

bool segments_cross(const PlanSegment& s, const PlanSegment& t);

/// Points of a regular grid inside a polygon seen from above: about `count`, at least its middle
/// if that is inside.
std::vector<Eigen::Vector2d> plan_samples(const LevelPolygon& polygon, int count);

}  // namespace planum
