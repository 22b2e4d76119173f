#pragma once

#include <span>
#include <vector>

#include "labeling/rooms/free_space.hpp"
#include "labeling/rooms/level_surfaces.hpp"
#include "labeling/rooms/wall_faces.hpp"

namespace planum {

/// Where a wall was seen around an opening; left is at smaller values along the tangent.
struct OpeningFrame {
  bool left = false, right = false, above = false;
  bool complete() const { return left && right && above; }
};

/// A hole in a wall face as an image of the face shows it: limits to about a cell.
struct FaceOpening {
  std::size_t face = 0;
  double begin = 0, end = 0;   ///< m along the face's tangent
  double bottom = 0, top = 0;  ///< m, z
  double floor = 0;            ///< m, z of the floor in front of the face
  double ceiling = 0;          ///< m, z of the ceiling in front of the face
  double parapet = 0;          ///< share of the columns that show a wall below
  OpeningFrame frame;
};

struct OpeningSearchParams {
  double cell = 0.05;         ///< m, of the image of a face
  double fill_radius = 0.10;  ///< m, narrower gaps between rays are closed
  double min_width = 0.40;    ///< m
  double min_height = 0.40;   ///< m
  double min_fill = 0.5;      ///< of the cells of its rectangle
  double frame_reach = 0.20;  ///< m beside and above an opening where the wall must be
  double min_frame = 0.3;     ///< of the rows (columns) that show a wall there
};

/// The holes of each face that rays went through; in order of the faces. Adan & Huber, 3D
/// Reconstruction of Interior Wall Surfaces under Occlusion and Clutter, 3DIMPVT 2011, look for
/// openings in an image of the wall in the same way.
std::vector<FaceOpening> find_face_openings(const std::vector<WallFace>& faces,
                                            const FaceSamples& samples, const FloorGrid& grid,
                                            const LevelSurface& floor, const LevelSurface& ceiling,
                                            const OpeningSearchParams& params = {});

}  // namespace planum
