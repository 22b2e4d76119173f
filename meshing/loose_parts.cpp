#include "meshing/loose_parts.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include "meshing/voxel_blocks.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Which vertices hang together (union-find, the lowest vertex stands for all).
class Parts {
 public:
  explicit Parts(const TriangleMesh& mesh) : parent_(mesh.vertices.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    for (const auto& [a, b, c] : mesh.triangles) {
      join(a, b);
      join(b, c);
    }
  }

  std::uint32_t of(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }

 private:
  void join(std::uint32_t a, std::uint32_t b) {
    a = of(a);
    b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  std::vector<std::uint32_t> parent_;
};

double area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Eigen::Vector3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                        &c = mesh.vertices[t[2]];
  return 0.5 * static_cast<double>((b - a).cross(c - a).norm());
}

/// Per vertex whether it stands for a part that has to show its points.
std::vector<std::uint8_t> doubtful(const std::vector<double>& areas,
                                   const LoosePartParams& params) {
  std::vector<std::uint8_t> result(areas.size());
  for (std::size_t v = 0; v < areas.size(); ++v)
    result[v] = areas[v] >= params.min_area && areas[v] < params.sure_area;
  return result;
}

/// The cells that doubtful parts pass through; of two parts in one cell, the first has it.
class PartCells {
 public:
  PartCells(const TriangleMesh& mesh, Parts& parts, const std::vector<std::uint8_t>& is_doubtful,
            double cell)
      : lattice_(lattice_around(mesh.vertices, cell)) {
    std::vector<CellKey> keys;
    std::vector<std::uint32_t> owners;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t part = parts.of(a);
      if (!is_doubtful[part]) continue;
      const Eigen::Vector3f &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
      for (const Eigen::Vector3f& place : {p, q, r, Eigen::Vector3f((p + q + r) / 3)}) {
        const CellKey key = lattice_.key(place.cast<double>());
        if (key == no_cell) continue;
        keys.push_back(key);
        owners.push_back(part);
      }
    }
    std::vector<CellKey> blocks(keys.size());
    std::transform(keys.begin(), keys.end(), blocks.begin(), block_of);
    blocks_ = BlockSet(std::move(blocks));
    owner_.assign(blocks_.size() * block_cells, none);
    for (std::size_t i = 0; i < keys.size(); ++i) {
      std::uint32_t& owner = owner_[place(blocks_.find(block_of(keys[i])), keys[i])];
      owner = std::min(owner, owners[i]);
    }
  }

  /// The part at a point, or none.
  std::uint32_t at(const Eigen::Vector3f& point) const {
    const CellKey key = lattice_.key(point.cast<double>());
    if (key == no_cell) return none;
    const std::uint32_t block = blocks_.find(block_of(key));
    return block == no_block ? none : owner_[place(block, key)];
  }

 private:
  static std::size_t place(std::uint32_t block, CellKey key) {
    return std::size_t{block} * block_cells + std::size_t(cell_in_block(key));
  }

  Lattice lattice_;
  BlockSet blocks_;
  std::vector<std::uint32_t> owner_;
};

/// Per vertex that stands for a doubtful part, how many points with normals it holds.
std::vector<std::uint32_t> points_of(const PartCells& cells, std::size_t vertices,
                                     const Cloud& cloud) {
  std::vector<std::uint32_t> count(vertices, 0);
  parallel_for(cloud.points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (cloud.normals[i].isZero()) continue;
      const std::uint32_t part = cells.at(cloud.points[i]);
      if (part != none) std::atomic_ref(count[part]).fetch_add(1, std::memory_order_relaxed);
    }
  });
  return count;
}

TriangleMesh selected(const TriangleMesh& mesh, Parts& parts,
                      const std::vector<std::uint8_t>& is_kept) {
  std::vector<std::uint32_t> name(mesh.vertices.size(), none);
  std::vector<bool> is_used(mesh.vertices.size(), false);
  TriangleMesh result;
  for (const auto& t : mesh.triangles) {
    if (!is_kept[parts.of(t[0])]) continue;
    for (const std::uint32_t v : t) is_used[v] = true;
    result.triangles.push_back(t);
  }
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!is_used[v]) continue;
    name[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(mesh.vertices[v]);
  }
  for (auto& t : result.triangles)
    for (std::uint32_t& v : t) v = name[v];
  return result;
}

}  // namespace

TriangleMesh without_loose_parts(const TriangleMesh& mesh, const Cloud& cloud,
                                 const LoosePartParams& params) {
  if (cloud.normals.size() != cloud.points.size())
    throw Error("mesh: loose parts are judged by points that have normals, and there are none");
  Parts parts(mesh);
  std::vector<double> areas(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles) areas[parts.of(t[0])] += area(mesh, t);
  std::vector<std::uint8_t> is_kept(areas.size());
  for (std::size_t v = 0; v < areas.size(); ++v) is_kept[v] = areas[v] >= params.min_area;
  const std::vector<std::uint8_t> is_doubtful = doubtful(areas, params);
  if (params.min_density > 0 && std::count(is_doubtful.begin(), is_doubtful.end(), 1) > 0) {
    const PartCells cells(mesh, parts, is_doubtful, params.cell);
    const std::vector<std::uint32_t> points = points_of(cells, areas.size(), cloud);
    for (std::size_t v = 0; v < areas.size(); ++v)
      if (is_doubtful[v] && points[v] < params.min_density * areas[v]) is_kept[v] = 0;
  }
  return selected(mesh, parts, is_kept);
}

}  // namespace planum
