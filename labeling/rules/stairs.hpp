#pragma once

#include <vector>

#include "labeling/label_scene.hpp"
#include "labeling/labels.hpp"

namespace planum {

/// Stairs: level surfaces as deep as steps that follow each other upwards, each beside the one
/// before and higher by a rise, from floor to floor as far as it was seen; two rises at least. Then
/// the upright surfaces between them, and those between two floors as low as two steps. The top of
/// a single step is too alike to a box. Needs the labels of floors.
void label_stairs(const LabelScene& scene, const LabelParams& params,
                  std::vector<PolygonLabel>& labels);

/// Flights whose steps ran together into one slanted surface, because few points were on each: as
/// steep as stairs are, with a floor below at their foot. It may be a ramp: confidence 0.5. Needs
/// the labels of floors.
void label_flights(const LabelScene& scene, const LabelParams& params,
                   std::vector<PolygonLabel>& labels);

}  // namespace planum
