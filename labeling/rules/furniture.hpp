#pragma once

#include <vector>

#include "labeling/label_scene.hpp"
#include "labeling/labels.hpp"

namespace planum {

/// Tops: surfaces that look up, are no floor and no stair, and are between two heights above a
/// floor below or beside them. Undersides: surfaces that look down closely below a top, or far
/// below headroom. Needs the labels of floors and stairs.
void label_furniture_tops(const LabelScene& scene, const LabelParams& params,
                          std::vector<PolygonLabel>& labels);

/// Sides: upright surfaces that are no wall, begin near the floor or end at a top, and are no
/// higher than furniture. A narrow one between two walls is a reveal and stays `unknown`. Needs the
/// labels of tops and walls.
void label_furniture_sides(const LabelScene& scene, const LabelParams& params,
                           std::vector<PolygonLabel>& labels);

}  // namespace planum
