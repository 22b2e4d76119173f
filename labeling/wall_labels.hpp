#pragma once

#include <vector>

#include "labeling/label_scene.hpp"

namespace planum {

/// Labels the upright polygons among those that have labels for floors and ceilings already.
void label_walls(const PolygonMap& map, const LabelScene& scene, const LabelParams& params,
                 std::vector<PolygonLabel>& labels);

}  // namespace planum
