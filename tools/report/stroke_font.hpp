#pragma once

#include <string_view>

namespace planum {

/// A letter as polylines: points are two digits (x 0 to 4 from the left, y 0 to 8 from below; the
/// base line is 2, high letters reach 8), polylines are parted by a space. Capitals are drawn as
/// small letters; what the font does not have is a box.
std::string_view strokes_of(char letter);

}  // namespace planum
