#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "labeling/rooms/opening_edges.hpp"
#include "labeling/rooms/opening_search.hpp"

namespace planum {

/// A hole in a wall with one or two faces. u runs along the tangent of the first face from
/// `centre`, which lies on that face; depth runs into the wall.
struct WallHole {
  FaceOpening front;
  std::optional<FaceOpening> back;
  Eigen::Vector2d centre, tangent, inwards;
  double thickness = 0;  ///< m; 0 where the back is not known
  OpeningRectangle rectangle;
  OpeningFrame frame;  ///< as either side shows it; left and right in u
  bool has_sill = false;
  std::array<std::int32_t, 2> regions{-1, -1};  ///< in front and behind, or -1

  double u_of(const Eigen::Vector2d& p) const { return tangent.dot(p - centre); }
  double depth_of(const Eigen::Vector2d& p) const { return inwards.dot(p - centre); }
};

/// Joins the holes that were found from both sides of a wall no thicker than `max_thickness`, in
/// the order of the holes.
std::vector<WallHole> wall_holes(const std::vector<WallFace>& faces,
                                 const std::vector<FaceOpening>& holes, double max_thickness);

}  // namespace planum
