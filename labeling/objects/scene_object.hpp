#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "labeling/objects/oriented_box.hpp"
#include "slam/core/pose.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// A model of a library in its place.
struct ModelMatch {
  std::string name;                                 ///< of the model
  Pose world_from_model = Pose::Identity();         ///< after the model was scaled
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< of the model along its axes
  double explained = 0;  ///< share of the object that lies on the surface of the model
  double seen = 0;       ///< share of the model's surface towards the scans that has points
  TriangleMesh surface;  ///< m, the model in the world

  double score() const { return std::min(explained, seen); }  ///< in [0, 1]
};

/// Something that stands or hangs in a room.
struct SceneObject {
  OrientedBox box;
  std::size_t room = 0;                 ///< position in RoomMap::rooms
  bool is_on_floor = false;             ///< the box then begins there
  std::vector<std::uint32_t> points;    ///< of the cloud, sorted by the cells they lie in
  std::vector<std::uint32_t> polygons;  ///< of the map, those that lie in the box
  std::optional<ModelMatch> model;      ///< what it looks like
};

}  // namespace planum
