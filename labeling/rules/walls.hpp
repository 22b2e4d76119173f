#pragma once

#include <vector>

#include "labeling/label_scene.hpp"
#include "labeling/labels.hpp"

namespace planum {

/// Walls: upright polygons that end at a ceiling, continue one that does, hang above headroom, or
/// are large with nothing behind. All other upright polygons become `unknown`. Needs the labels of
/// floors and ceilings.
void label_walls(const LabelScene& scene, const LabelParams& params,
                 std::vector<PolygonLabel>& labels);

/// Ends of walls and reveals of openings: narrow upright polygons at the edges of two walls. Those
/// of doors and windows get their names when these are known (opening_parts.hpp). Needs the labels
/// of walls.
void label_wall_ends(const LabelScene& scene, const LabelParams& params,
                     std::vector<PolygonLabel>& labels);

/// Undersides of beams and lintels: narrow surfaces that look down above headroom, at the edge of a
/// wall, become wall. Needs the labels of floors and walls.
void label_soffits(const LabelScene& scene, const LabelParams& params,
                   std::vector<PolygonLabel>& labels);

}  // namespace planum
