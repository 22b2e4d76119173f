#include "tools/maps/navmesh.hpp"

#include <DetourNavMesh.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/pose.hpp"
#include "slam/io/atomic_file.hpp"
#include "tools/maps/navmesh_tile.hpp"

namespace planum {
namespace {

const double least_upright = std::cos(radians(30));  // of the normal of what a robot drives on
constexpr double threshold_margin = 0.15;            // m, how far a threshold goes into its rooms
constexpr double most_cells_high = 8191;             // that Recast counts
constexpr int reference_bits = 22;                   // of Detour, for tiles and their polygons
constexpr int most_tile_bits = 14;

using Triangle = std::array<std::int32_t, 3>;

void check(const TriangulatedMap& mesh, const LabelledMap& map, const NavmeshParams& params) {
  const std::size_t polygons = map.map.polygons.size(), triangles = mesh.mesh.triangles.size();
  if (map.labels.polygons.size() != polygons || mesh.polygon.size() != triangles)
    throw Error(fmt::format("{} polygons with {} labels, {} triangles of which {} are of a polygon",
                            polygons, map.labels.polygons.size(), triangles, mesh.polygon.size()));
  for (const std::uint32_t polygon : mesh.polygon)
    if (polygon != TriangulatedMap::rest && polygon >= polygons)
      throw Error(fmt::format("a triangle is of polygon {} of {}", polygon, polygons));
  if (!(params.cell > 0 && params.cell_height > 0))
    throw Error(fmt::format("cells cannot have {} x {} m", params.cell, params.cell_height));
  if (!(params.robot_height > params.robot_climb && params.robot_climb >= 0))
    throw Error(fmt::format("a robot cannot be {} m high and drive over {} m", params.robot_height,
                            params.robot_climb));
  if (!(params.robot_radius >= 0 && params.robot_radius < 100))
    throw Error(fmt::format("a robot cannot have a radius of {} m", params.robot_radius));
}

Eigen::Vector3f to_recast(const Eigen::Vector3d& p) {
  return Eigen::Vector3d(p.x(), p.z(), -p.y()).cast<float>();
}

/// Whether what has this label is driven on where it is level.
bool can_drive_on(Label label) {
  return label == Label::floor || label == Label::stair || label == Label::door;
}

/// The floor of a doorway, from room to room: who went through saw little of it.
void add_threshold(const Opening& opening, NavmeshScene& scene) {
  const Eigen::Vector3d bottom =
      opening.position - Eigen::Vector3d(0, 0, opening.height / 2 + opening.sill);
  const Eigen::Vector3d depth = (opening.thickness / 2 + threshold_margin) * opening.across;
  const Eigen::Vector3d side =
      opening.width / 2 * Eigen::Vector3d(-opening.across.y(), opening.across.x(), 0);
  const auto first = static_cast<std::int32_t>(scene.vertices.size());
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(bottom - depth - side), Eigen::Vector3d(bottom + depth - side),
        Eigen::Vector3d(bottom + depth + side), Eigen::Vector3d(bottom - depth + side)})
    scene.vertices.push_back(to_recast(corner));
  for (const Triangle& t : {Triangle{first, first + 1, first + 2}, {first, first + 2, first + 3}}) {
    scene.triangles.push_back(t);
    scene.can_drive.push_back(1);
  }
}

NavmeshScene scene_of(const TriangulatedMap& mesh, const LabelledMap& map) {
  NavmeshScene scene;
  for (const Eigen::Vector3f& v : mesh.mesh.vertices)
    scene.vertices.push_back(to_recast(v.cast<double>()));
  for (std::size_t i = 0; i < mesh.polygon.size(); ++i) {
    const auto& [a, b, c] = mesh.mesh.triangles[i];
    const std::uint32_t polygon = mesh.polygon[i];
    scene.triangles.push_back(
        {static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), static_cast<std::int32_t>(c)});
    scene.can_drive.push_back(polygon != TriangulatedMap::rest &&
                              can_drive_on(map.labels.polygons[polygon].label) &&
                              map.map.polygons[polygon].plane.normal.z() >= least_upright);
  }
  if (std::find(scene.can_drive.begin(), scene.can_drive.end(), 1) == scene.can_drive.end())
    throw Error("there is no floor for a robot");
  for (const Opening& opening : map.rooms.openings)
    if (opening.kind != OpeningKind::window) add_threshold(opening, scene);
  for (const Eigen::Vector3f& v : scene.vertices) {
    if (!v.allFinite()) throw Error("a vertex is not finite");
    scene.box.extend(v);
  }
  return scene;
}

struct TileGrid {
  int columns = 0, rows = 0;
  double size = 0;  ///< m, edge of a tile
  int tile_bits = 0;
};

TileGrid grid_of(const NavmeshScene& scene, const NavmeshParams& params) {
  const Eigen::Vector3d size = scene.box.sizes().cast<double>();
  const double tile = params.cell * navmesh_tile_cells;
  const double tiles = std::ceil(size.x() / tile) * std::ceil(size.z() / tile);
  if (tiles > 1 << most_tile_bits || size.y() / params.cell_height > most_cells_high)
    throw Error(
        fmt::format("a map of {:.0f} x {:.0f} x {:.0f} m has too many cells of {} m for "
                    "Recast and Detour",
                    size.x(), size.z(), size.y(), params.cell));
  TileGrid grid{.columns = std::max(1, static_cast<int>(std::ceil(size.x() / tile))),
                .rows = std::max(1, static_cast<int>(std::ceil(size.z() / tile))),
                .size = tile};
  grid.tile_bits =
      static_cast<int>(std::bit_width(static_cast<unsigned>(grid.columns * grid.rows - 1)));
  return grid;
}

/// For each tile, row by row, the triangles that reach into it or its border.
std::vector<std::vector<std::uint32_t>> triangles_of_tiles(const NavmeshScene& scene,
                                                           const TileGrid& grid, double border) {
  std::vector<std::vector<std::uint32_t>> result(
      static_cast<std::size_t>(grid.columns * grid.rows));
  const auto tile = [&](double length, int count) {
    return std::clamp(static_cast<int>(std::floor(length / grid.size)), 0, count - 1);
  };
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    Eigen::AlignedBox3f box;
    for (const std::int32_t v : scene.triangles[i])
      box.extend(scene.vertices[static_cast<std::size_t>(v)]);
    const Eigen::Vector3d low = (box.min() - scene.box.min()).cast<double>();
    const Eigen::Vector3d high = (box.max() - scene.box.min()).cast<double>();
    for (int row = tile(low.z() - border, grid.rows); row <= tile(high.z() + border, grid.rows);
         ++row)
      for (int column = tile(low.x() - border, grid.columns);
           column <= tile(high.x() + border, grid.columns); ++column)
        result[static_cast<std::size_t>(row * grid.columns + column)].push_back(
            static_cast<std::uint32_t>(i));
  }
  return result;
}

std::vector<std::vector<std::byte>> tiles_of(const NavmeshScene& scene, const TileGrid& grid,
                                             const NavmeshParams& params) {
  const auto triangles = triangles_of_tiles(scene, grid, navmesh_tile_border(params));
  std::vector<std::vector<std::byte>> tiles(triangles.size());
  parallel_for(tiles.size(), 1, [&](std::size_t i, std::size_t) {
    const int tile = static_cast<int>(i);
    tiles[i] = navmesh_tile(scene, triangles[i], tile % grid.columns, tile / grid.columns, params);
  });
  std::erase_if(tiles, [](const auto& tile) { return tile.empty(); });
  if (tiles.empty()) throw Error("no floor is wide and high enough for the robot");
  return tiles;
}

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// The head and the tiles as Recast's demo saves them.
std::string file_of(const NavmeshScene& scene, const TileGrid& grid,
                    std::vector<std::vector<std::byte>> tiles) {
  dtNavMeshParams params = {};
  std::copy_n(scene.box.min().data(), 3, params.orig);
  params.tileWidth = params.tileHeight = static_cast<float>(grid.size);
  params.maxTiles = 1 << grid.tile_bits;
  params.maxPolys = 1 << (reference_bits - grid.tile_bits);
  const std::unique_ptr<dtNavMesh, void (*)(dtNavMesh*)> mesh(dtAllocNavMesh(), dtFreeNavMesh);
  if (dtStatusFailed(mesh->init(&params))) throw Error("Detour cannot make a mesh for the map");
  std::string bytes;
  append(bytes, std::int32_t{'M' << 24 | 'S' << 16 | 'E' << 8 | 'T'});
  append(bytes, std::int32_t{1});
  append(bytes, static_cast<std::int32_t>(tiles.size()));
  append(bytes, params);
  for (std::vector<std::byte>& tile : tiles) {
    const auto size = static_cast<std::int32_t>(tile.size());
    dtTileRef reference = 0;
    if (dtStatusFailed(
            mesh->addTile(reinterpret_cast<unsigned char*>(tile.data()), size, 0, 0, &reference)))
      throw Error("Detour does not take a tile");
    append(bytes, reference);
    append(bytes, size);
    bytes.append(reinterpret_cast<const char*>(tile.data()), tile.size());
  }
  return bytes;
}

}  // namespace

void write_navmesh(const std::filesystem::path& path, const TriangulatedMap& mesh,
                   const LabelledMap& map, const NavmeshParams& params) {
  try {
    check(mesh, map, params);
    const NavmeshScene scene = scene_of(mesh, map);
    const TileGrid grid = grid_of(scene, params);
    const std::string file = file_of(scene, grid, tiles_of(scene, grid, params));
    write_file_atomically(path, file);
  } catch (Error& error) {
    if (error.kind() != ErrorKind::environment) error.add_context(path.string());
    throw;
  }
}

}  // namespace planum
