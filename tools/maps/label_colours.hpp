#pragma once

#include "labeling/labels.hpp"
#include "slam/io/ply.hpp"

namespace planum {

/// The colour a label is drawn in everywhere: maps, pictures, reports. Chosen from Okabe & Ito's
/// palette, so that they stay apart for colour-blind readers.
Colour colour_of(Label label);

/// The colour of surfaces that are no polygon.
Colour colour_of_rest();

}  // namespace planum
