#pragma once

#include <vector>

namespace planum {

/// Limits of an opening in its wall: u along the wall, z up.
struct OpeningRectangle {
  double left = 0, right = 0;  ///< m, u
  double bottom = 0, top = 0;  ///< m, z
  double width() const { return right - left; }
  double height() const { return top - bottom; }
};

/// A place in the frame of an opening; normals are unit or zero.
struct OpeningSample {
  double u = 0, z = 0;                ///< m
  double normal_u = 0, normal_z = 0;  ///< of reveal points: components of the normal
};

/// What the scans show around an opening.
struct OpeningEvidence {
  std::vector<OpeningSample> crossings;  ///< rays through the wall's faces
  std::vector<OpeningSample> hits;       ///< points on the wall's faces
  std::vector<OpeningSample> reveal;     ///< points between the faces: jambs, lintel, sill
};

struct OpeningEdgeParams {
  double window = 0.15;          ///< m around a rough edge where the fine one is looked for
  double reveal_spread = 0.025;  ///< m, points of a jamb lie this near their median
  int min_reveal_points = 20;
  double max_disagreement = 0.05;  ///< m between jamb and faces; else the faces count
};

/// The value that parts `below` from `above` with the fewest on the wrong side, within `window` of
/// `guess`; in the middle of the widest gap where several are as good.
double parting_value(std::vector<double> below, std::vector<double> above, double guess,
                     double window);

/// The edges of an opening from points on its jambs and its lintel, and where there are too few,
/// from where the rays through the wall end and the points on it begin. The bottom is refined where
/// `has_sill`.
OpeningRectangle refined(const OpeningRectangle& rough, const OpeningEvidence& evidence,
                         bool has_sill, const OpeningEdgeParams& params = {});

}  // namespace planum
