#pragma once

#include <string>

#include "labeling/labels.hpp"

namespace planum {

/// What surfaces of a label are often made of: boards for floors, plaster for walls, panels for
/// ceilings, glass for windows ... A picture of 16 colours that fits onto itself on all sides, as a
/// .png file; made by formulas, the same in every run.
std::string texture_png(Label label);

/// m, what one picture covers in width and in height.
double texture_size(Label label);

}  // namespace planum
