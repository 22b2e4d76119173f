#include "meshing/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "meshing/block_corners.hpp"
#include "meshing/surface_gaps.hpp"
#include "meshing/surface_patches.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t blocks_per_task = 8;
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr int reach = 2;  ///< cells around a corner whose patches may matter

void check(const Cloud& cloud, const SurfaceParams& params) {
  if (!(params.voxel > 0))
    throw Error("mesh: voxel must be above 0, is " + std::to_string(params.voxel));
  if (cloud.points.empty()) throw Error("mesh: the cloud has no points");
  if (cloud.normals.size() != cloud.points.size())
    throw Error("mesh: " + std::to_string(cloud.points.size()) + " points, but " +
                std::to_string(cloud.normals.size()) + " normals");
}

/// Blocks with a corner within reach of a patch.
BlockSet blocks_near(const SurfacePatches& patches) {
  std::vector<CellKey> keys;
  CellKey last = no_cell;
  for (const CellKey key : patches.cells) {
    if (key == last) continue;
    last = key;
    const Eigen::Vector3i cell = cell_of(key);
    for (int corner = 0; corner < 8; ++corner) {
      const CellKey near = block_of(cell_key(cell.x() + (corner & 1 ? reach : 1 - reach),
                                             cell.y() + (corner & 2 ? reach : 1 - reach),
                                             cell.z() + (corner & 4 ? reach : 1 - reach)));
      if (keys.empty() || keys.back() != near) keys.push_back(near);
    }
  }
  return BlockSet(std::move(keys));
}

/// A patch as the corners of one block see it: lengths in voxels from the block's first corner.
struct LocalPatch {
  Eigen::Vector3f centre, normal;
  float count;
  Eigen::Array3i lowest, highest;  ///< corners within reach
};

void patches_near(const SurfacePatches& all, CellKey block, std::vector<LocalPatch>& near) {
  near.clear();
  const Eigen::Vector3i corner = cell_of(block);
  const Eigen::Vector3d start = corner.cast<double>();
  for (const std::uint32_t neighbour : all.blocks.neighbourhood(block)) {
    if (neighbour == no_block) continue;
    for (std::uint32_t k = all.begin[neighbour]; k < all.begin[neighbour + 1]; ++k) {
      const Eigen::Array3i at = (cell_of(all.cells[k]) - corner).array();
      if ((at < -reach).any() || (at >= block_width + reach - 1).any()) continue;
      const SurfacePatch& patch = all.patches[k];
      near.push_back({.centre = (patch.centre / all.lattice.size - start).cast<float>(),
                      .normal = patch.normal,
                      .count = patch.count,
                      .lowest = (at + (1 - reach)).max(0),
                      .highest = (at + reach).min(block_width - 1)});
    }
  }
}

template <class Visit>
void for_corners(const LocalPatch& patch, const Visit& visit) {
  for (int z = patch.lowest.z(); z <= patch.highest.z(); ++z)
    for (int y = patch.lowest.y(); y <= patch.highest.y(); ++y)
      for (int x = patch.lowest.x(); x <= patch.highest.x(); ++x)
        visit(std::size_t((z * block_width + y) * block_width + x),
              Eigen::Vector3f(float(x), float(y), float(z)));
}

/// The planes around a corner that belong to one sheet of surface, averaged.
struct Sheet {
  int patch =
      -1;  ///< the patch nearest to the corner, which says what belongs to the sheet; -1: none
  float nearest = std::numeric_limits<float>::infinity();  ///< squared distance to it
  float weight = 0;
  float distance = 0;                                ///< weighted sum
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< weighted sum
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< sum over points, relative to the corner
  float points = 0;
};

constexpr std::size_t most_sheets = 3;
using Sheets = std::array<Sheet, most_sheets>;

/// Squared distance to a small disc in the patch's plane.
float squared_distance(const LocalPatch& patch, const Eigen::Vector3f& corner) {
  constexpr float disc = 0.5f;
  const Eigen::Vector3f d = corner - patch.centre;
  const float across = d.dot(patch.normal);
  const float along = std::sqrt(std::max(0.0f, d.squaredNorm() - across * across));
  const float beyond = std::max(0.0f, along - disc);
  return across * across + beyond * beyond;
}

/// Whether two patches may be parts of one smooth surface, as seen from a corner.
bool same_sheet(const LocalPatch& a, const LocalPatch& b, const Eigen::Vector3f& at) {
  constexpr float same_direction = 0.7f;  // cosine, about 45 degrees
  constexpr float same_layer = 0.6f;      // voxels
  return a.normal.dot(b.normal) >= same_direction &&
         std::abs(a.normal.dot(at - a.centre) - b.normal.dot(at - b.centre)) <= same_layer;
}

void add_patch(const LocalPatch& patch, const LocalPatch& nearest, const Eigen::Vector3f& at,
               float radius, Sheet& sheet) {
  const Eigen::Vector3f d = at - patch.centre;
  sheet.centre -= patch.count * d;
  sheet.points += patch.count;
  const float across = nearest.normal.dot(d);
  const float along = (d.squaredNorm() - across * across) / (radius * radius);
  if (along >= 1) return;
  const float weight = (1 - along) * (1 - along) * patch.count;
  sheet.weight += weight;
  sheet.distance += weight * patch.normal.dot(d);
  sheet.normal += weight * patch.normal;
}

/// Finds for each corner its sheet number `level`: that of the nearest patch that is not on the
/// sheets before. Returns whether there is any.
bool find_sheets(const std::vector<LocalPatch>& near, std::size_t level, float radius,
                 std::vector<Sheets>& corners) {
  bool any = false;
  for (std::size_t p = 0; p < near.size(); ++p)
    for_corners(near[p], [&](std::size_t c, const Eigen::Vector3f& at) {
      Sheets& sheets = corners[c];
      for (std::size_t k = 0; k < level; ++k)
        if (sheets[k].patch < 0 || same_sheet(near[p], near[std::size_t(sheets[k].patch)], at))
          return;
      const float squared = squared_distance(near[p], at);
      if (squared >= sheets[level].nearest) return;
      sheets[level].nearest = squared;
      sheets[level].patch = int(p);
      any = true;
    });
  if (!any) return false;
  for (const LocalPatch& patch : near)
    for_corners(patch, [&](std::size_t c, const Eigen::Vector3f& at) {
      Sheet& sheet = corners[c][level];
      if (sheet.patch < 0) return;
      const LocalPatch& nearest = near[std::size_t(sheet.patch)];
      if (same_sheet(patch, nearest, at)) add_patch(patch, nearest, at, radius, sheet);
    });
  return true;
}

/// Signed distance and its direction at one corner, in voxels.
struct Value {
  float distance = unknown;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};

/// How two sheets meet: free space is in front of both (+1, as in the corner of a room), in front
/// of either (-1, as at the edge of a table), or they do not meet (0).
int relation(const Sheet& a, const Sheet& b) {
  constexpr float clear = 0.15f;  // voxels
  const Eigen::Vector3f from_a_to_b = b.centre - a.centre;
  const float ahead_of_a = a.normal.dot(from_a_to_b), ahead_of_b = -b.normal.dot(from_a_to_b);
  if (ahead_of_a > clear && ahead_of_b > clear) return 1;
  if (ahead_of_a < -clear && ahead_of_b < -clear) return -1;
  return 0;
}

Value joined(const Value& a, const Value& b, int how) {
  if (how == 0) return a;
  return (how > 0) == (a.distance < b.distance) ? a : b;
}

/// Joins the sheets around a corner; the first is the nearest.
Value value_of(Sheets& sheets) {
  std::array<Value, most_sheets> values;
  std::size_t count = 0;
  for (Sheet& sheet : sheets) {
    if (sheet.patch < 0 || sheet.weight <= 0) break;
    sheet.normal.normalize();
    sheet.centre /= sheet.points;
    values[count++] = {sheet.distance / sheet.weight, sheet.normal};
  }
  if (count == 0) return {};
  const int first_second = count > 1 ? relation(sheets[0], sheets[1]) : 0;
  if (count < 3) return joined(values[0], values[1], first_second);
  const int first_third = relation(sheets[0], sheets[2]);
  const int second_third = relation(sheets[1], sheets[2]);
  // The sheet that meets the other two in the same way is joined last.
  if (first_second == second_third)
    return joined(joined(values[0], values[2], first_third), values[1], first_second);
  if (first_third == second_third)
    return joined(joined(values[0], values[1], first_second), values[2], first_third);
  return joined(values[0], joined(values[1], values[2], second_third), first_second);
}

/// Parts of cells that hold points, around a block.
class PartMap {
 public:
  /// How far (in parts) data may be from a place of the surface.
  static constexpr int range = 2;

  void read(const SurfacePatches& patches, CellKey block) {
    surrounding_cells(patches.blocks, patches.begin, patches.cells, block, 1, first_);
    patches_ = &patches;
  }

  /// Whether there are points near a place, in voxels from the block's first corner.
  bool has_data(const Eigen::Vector3f& at) const {
    const Eigen::Vector3f parts = at * float(parts_of_cell);
    const Eigen::Array3i middle = parts.array().floor().cast<int>();
    for (int z = -range; z <= range; ++z)
      for (int y = -range; y <= range; ++y)
        for (int x = -range; x <= range; ++x) {
          const Eigen::Array3i part = middle + Eigen::Array3i(x, y, z);
          const Eigen::Vector3f d = (part.cast<float>() + 0.5f).matrix() - parts;
          if (d.squaredNorm() <= farthest * farthest && occupied(part)) return true;
        }
    return false;
  }

 private:
  static constexpr float farthest = 2.4f;  // parts: 0.6 voxels

  bool occupied(const Eigen::Array3i& part) const {
    const Eigen::Array3i shifted = part + parts_of_cell;
    const Eigen::Array3i cell = shifted / parts_of_cell, rest = shifted - cell * parts_of_cell;
    constexpr int width = block_width + 2;
    const std::uint32_t patch =
        first_[std::size_t((cell.z() * width + cell.y()) * width + cell.x())];
    if (patch == no_thing) return false;
    return patches_->occupied[patch] >>
               (rest.x() + parts_of_cell * (rest.y() + parts_of_cell * rest.z())) &
           1;
  }

  std::vector<std::uint32_t> first_;
  const SurfacePatches* patches_ = nullptr;
};

/// Marks where the distance passes zero, in the direction of the normals, and near data.
void find_crossings(const SurfacePatches& patches, const std::vector<Eigen::Vector3f>& normals,
                    DistanceField& field, std::size_t block) {
  constexpr float most_jump = 0.7f;  // voxels
  thread_local PartMap parts;
  thread_local std::array<float, block_corners> distance;
  thread_local std::array<Eigen::Vector3f, block_corners> normal;
  const CellKey key = field.blocks.key(block);
  read_corners(field.blocks, field.distance, key, unknown, distance);
  read_corners(field.blocks, normals, key, Eigen::Vector3f(0, 0, 0), normal);
  parts.read(patches, key);
  for (std::size_t cell = 0; cell < block_cells; ++cell) {
    const std::size_t i = corner_of_cell(cell);
    if (std::isnan(distance[i])) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t j = i + corner_step[axis];
      if (std::isnan(distance[j]) || (distance[i] < 0) == (distance[j] < 0)) continue;
      const float grows = 0.5f * (normal[i][Eigen::Index(axis)] + normal[j][Eigen::Index(axis)]);
      const float jump = (distance[j] - distance[i]) / float(field.lattice.size) - grows;
      if (std::abs(jump) > most_jump) continue;
      Eigen::Vector3f at(float(cell % block_width), float(cell / block_width % block_width),
                         float(cell / (block_width * block_width)));
      at[Eigen::Index(axis)] += distance[i] / (distance[i] - distance[j]);
      field.crossings[block * block_cells + cell] |=
          std::uint8_t((parts.has_data(at) ? crossing_near_data : crossing) << axis);
    }
  }
}

void compute_block(const SurfacePatches& patches, CellKey block, const SurfaceParams& params,
                   float* distance, Eigen::Vector3f* normal) {
  thread_local std::vector<LocalPatch> near;
  thread_local std::vector<Sheets> corners;
  patches_near(patches, block, near);
  corners.assign(block_cells, Sheets{});
  for (std::size_t level = 0; level < most_sheets; ++level)
    if (!find_sheets(near, level, float(params.radius), corners)) break;
  for (std::size_t c = 0; c < block_cells; ++c) {
    const Value value = value_of(corners[c]);
    distance[c] = value.distance * float(params.voxel);
    normal[c] = value.normal;
  }
}

}  // namespace

DistanceField distance_field(const Cloud& cloud, const SurfaceParams& params,
                             const Progress& progress) {
  check(cloud, params);
  SurfacePatches patches = without_strays(surface_patches(cloud, params.voxel));
  if (patches.patches.empty()) throw Error("mesh: no point has a normal", ErrorKind::no_result);
  patches = with_gaps_filled(std::move(patches), params.gap_reach);
  DistanceField field;
  field.lattice = patches.lattice;
  field.blocks = blocks_near(patches);
  field.distance.resize(field.blocks.size() * block_cells);
  field.crossings.assign(field.blocks.size() * block_cells, 0);
  std::vector<Eigen::Vector3f> normals(field.distance.size());
  parallel_for(
      field.blocks.size(), blocks_per_task,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b)
          compute_block(patches, field.blocks.key(b), params,
                        field.distance.data() + b * block_cells, normals.data() + b * block_cells);
      },
      progress);
  parallel_for(field.blocks.size(), blocks_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) find_crossings(patches, normals, field, b);
  });
  return field;
}

}  // namespace planum
