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
    case Label::unknown:
      break;
  }
  return {204, 121, 167};  // reddish purple
}

Colour colour_of_rest() { return {150, 150, 150}; }

}  // namespace planum
