#pragma once

#include "labeling/labels.hpp"
#include "labeling/rooms/rooms.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

struct ReflectionParams {
  double max_distance = 0.05;   ///< m, between a mirror image and the surface it is one of
  double max_angle = 0.17;      ///< rad, between their normals
  double min_share = 0.6;       ///< of the image, on such surfaces
  double min_area = 0.3;        ///< m^2 of upright images behind a pane, or it is no mirror
  double pane_reach = 0.05;     ///< m, a pane may lie so far before and behind its wall
  double pane_step = 0.01;      ///< m, places of the pane that are tried
  double usual_wall = 0.30;     ///< m, where the thickness of the wall is not known
  double sample_spacing = 0.1;  ///< m, on the images
};

/// Labels without what laser light brought that a window pane threw back: a polygon in no room,
/// behind a window that joins no other room, becomes `unknown` where its mirror image in the pane
/// lies on surfaces of the map before it. Level images (the floor of a terrace may go on that of
/// its room) count only behind panes with upright ones. A real wing of the building that is the
/// exact mirror image of another in one of its windows, and that nobody entered, is `unknown` too.
/// The map must be level. Throws Error if labels or rooms are not those of the map.
Labels without_reflections(const PolygonMap& map, Labels labels, const RoomMap& rooms,
                           const ReflectionParams& params = {});

}  // namespace planum
