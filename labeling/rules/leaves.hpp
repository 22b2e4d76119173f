#pragma once

#include <vector>

#include "labeling/label_scene.hpp"
#include "labeling/labels.hpp"

namespace planum {

/// Closed doors and blind windows: upright surfaces set back into a wall, which goes on at their
/// sides and above them; from the floor up and as large as a door leaf (or a pair), or above a sill
/// with wall all around. Flush doors cannot be told from the wall. Needs the labels of floors and
/// walls.
void label_leaves(const LabelScene& scene, const LabelParams& params,
                  std::vector<PolygonLabel>& labels);

}  // namespace planum
