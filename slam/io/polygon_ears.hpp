#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace planum {

/// Cuts a simple polygon, convex or not, into corners.size() - 2 triangles of the same orientation
/// by clipping ears (Meisters, Polygons have ears, American Mathematical Monthly 82, 1975). Corners
/// are indices into vertices; they should lie about in one plane. A polygon that crosses itself
/// gives as many triangles, of no use. At least three corners.
std::vector<std::array<std::uint32_t, 3>> triangulated_polygon(
    std::span<const Eigen::Vector3f> vertices, std::span<const std::uint32_t> corners);

}  // namespace planum
