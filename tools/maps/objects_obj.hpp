#pragma once

#include <filesystem>
#include <span>

#include "labeling/objects/scene_object.hpp"

namespace planum {

/// Writes the models of objects in their places, each a group `object_ID_NAME` with the object's
/// position in the list. Throws Error if no object has a model.
void write_objects_obj(const std::filesystem::path& path, std::span<const SceneObject> objects);

}  // namespace planum
