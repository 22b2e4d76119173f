#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "slam/core/pose.hpp"

namespace planum {

/// A box with upright sides.
struct OrientedBox {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();  ///< unit, horizontal, of its length
  Eigen::Vector3d size = Eigen::Vector3d::Zero();    ///< m: length >= width, height

  double base() const { return centre.z() - size.z() / 2; }  ///< m, height of its underside

  /// From the box's frame, whose origin is the middle of its underside and whose x is its length.
  Pose world_from_box() const {
    Pose pose = Pose::Identity();
    pose.linear().col(0) = along;
    pose.linear().col(1) = Eigen::Vector3d::UnitZ().cross(along);
    pose.translation() = Eigen::Vector3d(centre.x(), centre.y(), base());
    return pose;
  }
};

/// Corners of the convex hull, counter-clockwise, without those on its edges (Andrew, Another
/// efficient algorithm for convex hulls in two dimensions, 1979).
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

/// rad, the direction of a side of a rectangle round points, of which a share `max_stray` may be
/// outside of each side. One side of the smallest lies along an edge of the hull (Freeman &
/// Shapira, CACM 18(7), 1975); of those hardly larger it is the one whose sides are nearest to the
/// points, turned a little until they are nearest of all: two sides of a block, which are all that
/// is seen of it from one place, have many rectangles of one area. 0 for fewer than two places.
double direction_of_rectangle(const std::vector<Eigen::Vector2d>& points, double max_stray = 0);

}  // namespace planum
