#include "tools/maps/label_colours.hpp"

namespace planum {

Colour colour_of(Label label) {
  switch (label) {
    case Label::floor:
      return {230, 159, 0};  // orange
    case Label::ceiling:
      return {86, 180, 233};  // sky blue
    case Label::wall:
      return {0, 158, 115};  // bluish green
    case Label::door:
      return {213, 94, 0};  // vermillion
    case Label::window:
      return {0, 114, 178};  // blue
    case Label::stair:
      return {240, 228, 66};  // yellow
    case Label::furniture_horizontal:
      return {204, 121, 167};  // reddish purple
    case Label::furniture_vertical:
      return {142, 84, 117};  // the same, darker
    case Label::unknown:
      break;
  }
  return {60, 60, 60};  // near black
}

Colour colour_of_rest() { return {150, 150, 150}; }

}  // namespace planum
