#pragma once

#include <vector>

#include "labeling/rooms/free_space.hpp"
#include "labeling/rooms/wall_hole.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

/// Points in and around the wall of a hole: u, height, depth, and the normal in these directions.
struct PointInWall {
  OpeningSample sample;
  double depth, normal_depth;
};

/// The points around each hole, up to the greatest thickness behind its front. `plan` is a cloud
/// with normals in the plan frame.
std::vector<std::vector<PointInWall>> points_in_walls(const Cloud& plan, const FloorGrid& grid,
                                                      const std::vector<WallHole>& holes,
                                                      double max_thickness);

/// The thickness of a wall whose back has no face of its own: points beside or above the opening
/// that look away from the front, nearest to it. 0 where there are none.
double thickness_behind(const WallHole& hole, const std::vector<PointInWall>& points,
                        double max_thickness);

/// The thickness of a wall by how deep its jambs and its lintel are; 0 where they were not seen.
double thickness_of_reveals(const OpeningRectangle& rectangle,
                            const std::vector<PointInWall>& points, double max_thickness);

/// Which of the edges of an opening show a jamb or the underside of a lintel.
OpeningFrame frame_of_reveals(const OpeningRectangle& rectangle,
                              const std::vector<OpeningSample>& reveal);

/// What shows the edges of a hole.
OpeningEvidence evidence_of(const WallHole& hole, const std::vector<WallFace>& faces,
                            const FaceSamples& samples, const std::vector<PointInWall>& points);

}  // namespace planum
