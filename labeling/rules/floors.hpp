#pragma once

#include <vector>

#include "labeling/label_scene.hpp"
#include "labeling/labels.hpp"

namespace planum {

/// Floors: level surfaces that look up, with no lower surface beside most of them and headroom
/// above, large or at the level of a large one. Gives each polygon that looks up its label or
/// `unknown`.
void label_floors(const LabelScene& scene, const LabelParams& params,
                  std::vector<PolygonLabel>& labels);

/// Ceilings: the floors of the scene upside down, if they are wider than a beam.
void label_ceilings(const LabelScene& scene, const LabelParams& params,
                    std::vector<PolygonLabel>& labels);

/// Undersides of pitched roofs: slanted surfaces that look down with headroom above a floor and
/// nothing else between. Needs the labels of floors.
void label_roofs(const LabelScene& scene, const LabelParams& params,
                 std::vector<PolygonLabel>& labels);

}  // namespace planum
