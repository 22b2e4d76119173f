#pragma once

#include <vector>

#include <Eigen/Core>

#include "labeling/labels.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// Where the texture of a polygon lies in its plane: u to the right, v up, a picture from 0 to 1.
struct TextureFrame {
  Eigen::Vector3d u = Eigen::Vector3d::Zero(), v = Eigen::Vector3d::Zero();  ///< pictures a metre

  Eigen::Vector2d at(const Eigen::Vector3d& place) const { return {u.dot(place), v.dot(place)}; }
};

/// A frame for each polygon; a picture is as large as texture_size(label) says. Seen from free
/// space, u of upright and slanting polygons goes level to the right; all level ones have the same
/// frame, along the walls, so that the boards of neighbouring floors continue each other. Throws
/// Error if there is not one label a polygon.
std::vector<TextureFrame> texture_frames(const PolygonMap& map, const Labels& labels);

}  // namespace planum
