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
  double reveal_spread = 0.025;  ///< m, points of a jamb lie this near their mean
  int min_reveal_points = 12;
  double max_disagreement =
      0.03;  ///< m of a jamb outside of what the faces leave open; else they count
};

/// Between which values an edge lies.
struct EdgeInterval {
  double low = 0, high = 0;
  double middle() const { return 0.5 * (low + high); }
};

/// Where `below` and `above` are parted with the fewest values on the wrong side, within `window`
/// of `guess`: the widest gap where several are as good.
EdgeInterval parting_interval(std::vector<double> below, std::vector<double> above, double guess,
                              double window);

/// The edges of an opening from points on its jambs and its lintel, and where there are too few,
/// from where the rays through the wall end and the points on it begin. The bottom is refined where
/// `has_sill`.
OpeningRectangle refined(const OpeningRectangle& rough, const OpeningEvidence& evidence,
                         bool has_sill, const OpeningEdgeParams& params = {});

}  // namespace planum
