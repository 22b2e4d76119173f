#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "labeling/objects/scene_object.hpp"
#include "slam/core/cloud.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// A kind of object. Its frame is that of a box: z up, the origin in the middle of the underside.
struct ObjectModel {
  std::string name;
  TriangleMesh mesh;                                    ///< m, counter-clockwise seen from outside
  Eigen::Vector3d min_scale = Eigen::Vector3d::Ones();  ///< along the axes of the mesh; an object's
  Eigen::Vector3d max_scale = Eigen::Vector3d::Ones();  ///< box says which scale between
};

struct MatchParams {
  double tolerance = 0.05;  ///< m, what is nearer to a surface lies on it
  double min_score = 0.6;   ///< in [0, 1], models that fit worse are no match
  double spacing = 0.03;    ///< m, of points on models and of the objects' points
  double first_gate = 0.3;  ///< m, points farther from the model do not count at first
  int max_iterations = 20;  ///< of ICP from each of four directions
};

/// The objects with the models that suit them best, where one suits. Models stand upright on the
/// floor: point-to-plane ICP finds place and direction, from the four directions of the box.
/// Objects that hang have no model. `scan_origins` are what `scan` of the cloud points to: what of
/// a model could not be seen from the scans that saw the object is not missed. Throws Error for
/// parameters out of range, for a cloud without scan indices and for a model without surface.
std::vector<SceneObject> with_models(std::vector<SceneObject> objects, const Cloud& cloud,
                                     std::span<const Eigen::Vector3d> scan_origins,
                                     std::span<const ObjectModel> models,
                                     const MatchParams& params = {});

}  // namespace planum
