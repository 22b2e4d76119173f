#include "meshing/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "meshing/block_corners.hpp"
#include "meshing/corner_values.hpp"
#include "meshing/surface_gaps.hpp"
#include "meshing/surface_patches.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t blocks_per_task = 8;
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

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
  for (std::size_t b = 0; b < patches.blocks.size(); ++b) {
    Eigen::Array3i low = Eigen::Array3i::Constant(cell_limit), high = -low;
    for (std::uint32_t k = patches.begin[b]; k < patches.begin[b + 1]; ++k) {
      const Eigen::Array3i cell = cell_of(patches.cells[k]).array();
      low = low.min(cell);
      high = high.max(cell);
    }
    low += 1 - patch_reach;
    high += patch_reach;
    const Eigen::Vector3i first = cell_of(block_of(cell_key(low.x(), low.y(), low.z())));
    for (int z = first.z(); z <= high.z(); z += block_width)
      for (int y = first.y(); y <= high.y(); y += block_width)
        for (int x = first.x(); x <= high.x(); x += block_width) keys.push_back(cell_key(x, y, z));
  }
  return BlockSet(std::move(keys));
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

}  // namespace

DistanceField distance_field(const Cloud& cloud, const SurfaceParams& params,
                             const Progress& progress) {
  check(cloud, params);
  SurfacePatches patches = without_strays(surface_patches(cloud, params.voxel));
  if (patches.patches.empty())
    throw Error(
        "mesh: no point has a normal: nowhere do points lie around each other on a surface (are "
        "they in metres, and more than a line of them?)",
        ErrorKind::no_result);
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
        for (std::size_t b = begin; b < end; ++b) {
          const std::span distance(field.distance.data() + b * block_cells, block_cells);
          corner_values(patches, field.blocks.key(b), float(params.radius), distance,
                        std::span(normals.data() + b * block_cells, block_cells));
          for (float& d : distance) d *= float(params.voxel);
        }
      },
      progress);
  parallel_for(field.blocks.size(), blocks_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) find_crossings(patches, normals, field, b);
  });
  return field;
}

}  // namespace planum
