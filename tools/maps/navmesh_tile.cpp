#include "tools/maps/navmesh_tile.hpp"

#include <DetourAlloc.h>
#include <DetourNavMesh.h>
#include <DetourNavMeshBuilder.h>
#include <Recast.h>
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

constexpr float border_error = 1.3F;        // cells, of simplified borders
constexpr double longest_edge = 12;         // m, of borders
constexpr int smallest_region = 8 * 8;      // cells, smaller islands are left out
constexpr int merged_region = 20 * 20;      // cells, smaller regions join their neighbours
constexpr double height_samples = 6;        // cells between them
constexpr unsigned char ground_area = 0;    // as in Recast's demo
constexpr unsigned short walk_flag = 0x01;  // as in Recast's demo

int cells_up_to(double length, double cell) {
  return static_cast<int>(std::ceil(length / cell - 1e-6));
}
int cells_within(double length, double cell) {
  return static_cast<int>(std::floor(length / cell + 1e-6));
}
int radius_cells(const NavmeshParams& params) {
  return cells_up_to(params.robot_radius, params.cell);
}
int border_cells(const NavmeshParams& params) { return radius_cells(params) + 3; }

void expect(bool worked, const char* what) {
  if (!worked) throw Error(fmt::format("Recast failed to make {}", what));
}

template <class T, void (*release)(T*)>
struct Release {
  void operator()(T* object) const { release(object); }
};
using Heightfield = std::unique_ptr<rcHeightfield, Release<rcHeightfield, rcFreeHeightField>>;
using OpenSpans =
    std::unique_ptr<rcCompactHeightfield, Release<rcCompactHeightfield, rcFreeCompactHeightfield>>;
using Contours = std::unique_ptr<rcContourSet, Release<rcContourSet, rcFreeContourSet>>;
using Polygons = std::unique_ptr<rcPolyMesh, Release<rcPolyMesh, rcFreePolyMesh>>;
using Heights = std::unique_ptr<rcPolyMeshDetail, Release<rcPolyMeshDetail, rcFreePolyMeshDetail>>;

/// The steps of Recast for one tile, each from what the one before made.
class TileMaker {
 public:
  TileMaker(const NavmeshScene& scene, const NavmeshParams& params)
      : scene_(scene),
        params_(params),
        height_(cells_up_to(params.robot_height, params.cell_height)),
        climb_(cells_within(params.robot_climb, params.cell_height)) {}

  OpenSpans open_spans(const std::vector<std::uint32_t>& triangles, int column, int row) {
    const int border = border_cells(params_), cells = navmesh_tile_cells + 2 * border;
    const auto cell = static_cast<float>(params_.cell);
    Eigen::Vector3f low = scene_.box.min(), high = scene_.box.max();
    low.x() += cell * static_cast<float>(column * navmesh_tile_cells - border);
    low.z() += cell * static_cast<float>(row * navmesh_tile_cells - border);
    high.x() = low.x() + cell * static_cast<float>(cells);
    high.z() = low.z() + cell * static_cast<float>(cells);
    const Heightfield solid(rcAllocHeightfield());
    expect(rcCreateHeightfield(&silent_, *solid, cells, cells, low.data(), high.data(), cell,
                               static_cast<float>(params_.cell_height)),
           "a height field");
    for (const std::uint32_t t : triangles) {
      const auto& [a, b, c] = scene_.triangles[t];
      expect(rcRasterizeTriangle(&silent_, corner(a), corner(b), corner(c),
                                 scene_.can_drive[t] ? RC_WALKABLE_AREA : RC_NULL_AREA, *solid,
                                 climb_),
             "cells of a triangle");
    }
    rcFilterLowHangingWalkableObstacles(&silent_, climb_, *solid);
    rcFilterLedgeSpans(&silent_, height_, climb_, *solid);
    rcFilterWalkableLowHeightSpans(&silent_, height_, *solid);
    OpenSpans open(rcAllocCompactHeightfield());
    expect(rcBuildCompactHeightfield(&silent_, height_, climb_, *solid, *open), "open cells");
    expect(rcErodeWalkableArea(&silent_, radius_cells(params_), *open), "a margin at walls");
    expect(rcBuildDistanceField(&silent_, *open), "distances to walls");
    expect(rcBuildRegions(&silent_, *open, border, smallest_region, merged_region), "regions");
    return open;
  }

  Polygons polygons(rcCompactHeightfield& open) {
    const Contours contours(rcAllocContourSet());
    expect(rcBuildContours(&silent_, open, border_error, cells_within(longest_edge, params_.cell),
                           *contours),
           "contours");
    Polygons mesh(rcAllocPolyMesh());
    expect(rcBuildPolyMesh(&silent_, *contours, DT_VERTS_PER_POLYGON, *mesh), "polygons");
    for (int i = 0; i < mesh->npolys; ++i) {
      mesh->areas[i] = ground_area;
      mesh->flags[i] = walk_flag;
    }
    return mesh;
  }

  Heights heights(const rcPolyMesh& mesh, const rcCompactHeightfield& open) {
    Heights heights(rcAllocPolyMeshDetail());
    expect(rcBuildPolyMeshDetail(&silent_, mesh, open,
                                 static_cast<float>(height_samples * params_.cell),
                                 static_cast<float>(params_.cell_height), *heights),
           "heights");
    return heights;
  }

 private:
  const float* corner(std::int32_t vertex) const {
    return scene_.vertices[static_cast<std::size_t>(vertex)].data();
  }

  const NavmeshScene& scene_;
  const NavmeshParams& params_;
  int height_, climb_;  // of the robot, in cells
  rcContext silent_{false};
};

std::vector<std::byte> tile_data(const rcPolyMesh& mesh, const rcPolyMeshDetail& heights,
                                 int column, int row, const NavmeshParams& params) {
  dtNavMeshCreateParams tile = {};
  tile.verts = mesh.verts;
  tile.vertCount = mesh.nverts;
  tile.polys = mesh.polys;
  tile.polyAreas = mesh.areas;
  tile.polyFlags = mesh.flags;
  tile.polyCount = mesh.npolys;
  tile.nvp = mesh.nvp;
  tile.detailMeshes = heights.meshes;
  tile.detailVerts = heights.verts;
  tile.detailVertsCount = heights.nverts;
  tile.detailTris = heights.tris;
  tile.detailTriCount = heights.ntris;
  tile.walkableHeight = static_cast<float>(params.robot_height);
  tile.walkableRadius = static_cast<float>(params.robot_radius);
  tile.walkableClimb = static_cast<float>(params.robot_climb);
  tile.tileX = column;
  tile.tileY = row;
  std::copy_n(mesh.bmin, 3, tile.bmin);
  std::copy_n(mesh.bmax, 3, tile.bmax);
  tile.cs = mesh.cs;
  tile.ch = mesh.ch;
  tile.buildBvTree = true;
  unsigned char* data = nullptr;
  int size = 0;
  if (!dtCreateNavMeshData(&tile, &data, &size))
    throw Error(
        fmt::format("Detour cannot take {} corners and {} polygons in one tile: larger "
                    "cells make fewer",
                    mesh.nverts, mesh.npolys));
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(
      data, [](unsigned char* bytes) { dtFree(bytes); });
  const auto* begin = reinterpret_cast<const std::byte*>(data);
  return {begin, begin + size};
}

}  // namespace

double navmesh_tile_border(const NavmeshParams& params) {
  return params.cell * border_cells(params);
}

std::vector<std::byte> navmesh_tile(const NavmeshScene& scene,
                                    const std::vector<std::uint32_t>& triangles, int column,
                                    int row, const NavmeshParams& params) {
  TileMaker maker(scene, params);
  const OpenSpans open = maker.open_spans(triangles, column, row);
  const Polygons mesh = maker.polygons(*open);
  if (mesh->npolys == 0) return {};
  const Heights heights = maker.heights(*mesh, *open);
  return tile_data(*mesh, *heights, column, row, params);
}

}  // namespace planum
