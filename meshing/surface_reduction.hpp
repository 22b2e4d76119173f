#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace planum {

/// Fewer triangles for the same surface: vertices inside of it are taken out one by one, the least
/// missed first (quadrics of Garland & Heckbert, SIGGRAPH 1997), each by moving it into one of its
/// neighbours. No vertex is new and none is moved, so borders and `fixed` vertices stay as they
/// are. Every vertex that was taken out lies within max_error (m) of the triangles in its place;
/// none of these is turned by more than 60 degrees, and where the surface is a manifold it stays
/// one. Triangles come out in the order of those they were made from.
std::vector<std::array<std::uint32_t, 3>> reduced_surface(
    std::span<const Eigen::Vector3d> points,
    std::span<const std::array<std::uint32_t, 3>> triangles, const std::vector<bool>& fixed,
    double max_error);

}  // namespace planum
