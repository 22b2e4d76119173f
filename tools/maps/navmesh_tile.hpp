#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tools/maps/navmesh.hpp"

namespace planum {

/// What a robot may drive on and what is in its way, in Recast's coordinates: y is up.
struct NavmeshScene {
  std::vector<Eigen::Vector3f> vertices;  ///< m
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::uint8_t> can_drive;  ///< for each triangle
  Eigen::AlignedBox3f box;              ///< m, around all vertices
};

/// Edge of a tile in cells.
inline constexpr int navmesh_tile_cells = 128;

/// The data of one tile of the grid of tiles that begins at the low corner of the scene, as Detour
/// keeps it; empty where a robot cannot stand. `triangles` are those that may reach the tile.
/// Throws Error if the tile has more corners than Detour's 16 bits count.
std::vector<std::byte> navmesh_tile(const NavmeshScene& scene,
                                    const std::vector<std::uint32_t>& triangles, int column,
                                    int row, const NavmeshParams& params);

/// How far around a tile triangles have to be known, m.
double navmesh_tile_border(const NavmeshParams& params);

}  // namespace planum
