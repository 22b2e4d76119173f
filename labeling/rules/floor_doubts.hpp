#pragma once

#include <vector>

#include "labeling/label_scene.hpp"

namespace planum {

/// For each polygon how far it is from being a floor, by what lies beside and above it: the share
/// of it that is raised above a surface beside it or has too little headroom; 1 for what does not
/// look up. Ceilings are the floors of the scene upside down.
std::vector<double> floor_doubts(const LabelScene& scene, const LabelParams& params);

}  // namespace planum
