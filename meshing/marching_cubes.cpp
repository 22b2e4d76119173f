#include "meshing/marching_cubes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "meshing/block_corners.hpp"
#include "meshing/cell_loops.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t blocks_per_task = 16;
constexpr int width = block_width;
/// Where the corners of a cell are among those of its block, relative to its lowest.
constexpr std::array<std::size_t, 8> make_cell_corners() {
  std::array<std::size_t, 8> result{};
  for (int k = 0; k < 8; ++k) result[std::size_t(k)] = corner_index(k & 1, k >> 1 & 1, k >> 2);
  return result;
}
constexpr std::array<std::size_t, 8> cell_corners = make_cell_corners();

/// What is known at the corners of a block's cells.
struct BlockCorners {
  std::array<float, block_corners> distance;
  std::array<std::uint8_t, block_corners> crossings;

  void read(const DistanceField& field, CellKey block) {
    read_corners(field.blocks, field.distance, block, std::numeric_limits<float>::quiet_NaN(),
                 distance);
    read_corners(field.blocks, field.crossings, block, std::uint8_t{0}, crossings);
  }
};

/// The crossed edges of the cell with this lowest corner, bit e for edge e; 0 if the surface does
/// not run through it.
int crossed_edges(const BlockCorners& corners, std::size_t lowest) {
  int inside = 0;
  for (const std::size_t k : cell_corners) {
    const float d = corners.distance[lowest + k];
    if (std::isnan(d)) return 0;
    inside += d < 0;
  }
  if (inside == 0 || inside == 8) return 0;
  int edges = 0, crossed = 0, near_data = 0;
  for (int edge = 0; edge < 12; ++edge) {
    const auto [a, b] = corners_of_edge(edge);
    const std::size_t i = lowest + cell_corners[std::size_t(a)];
    const std::size_t j = lowest + cell_corners[std::size_t(b)];
    if ((corners.distance[i] < 0) == (corners.distance[j] < 0)) continue;
    const int found = corners.crossings[i] >> (edge / 4);
    if ((found & crossing) == 0) return 0;
    edges |= 1 << edge;
    ++crossed;
    near_data += (found & crossing_near_data) == crossing_near_data;
  }
  // One without data is a gap in the surface, more are its border.
  return 4 * (crossed - near_data) <= crossed ? edges : 0;
}

/// A set of edges of a block's corners (3 * corner + axis), with the number of those before each.
struct EdgeSet {
  static constexpr std::size_t words = 3 * block_cells / 64;
  std::array<std::uint64_t, words> bits{};
  std::array<std::uint32_t, words> before{};  ///< numbers of vertices, over all blocks

  void insert(std::size_t edge) { bits[edge / 64] |= std::uint64_t{1} << (edge % 64); }
  std::uint32_t number(std::size_t edge) const {
    const std::uint64_t lower = (std::uint64_t{1} << (edge % 64)) - 1;
    return before[edge / 64] + std::uint32_t(std::popcount(bits[edge / 64] & lower));
  }
  std::uint32_t count_from(std::uint32_t number) {
    for (std::size_t w = 0; w < words; ++w) {
      before[w] = number;
      number += std::uint32_t(std::popcount(bits[w]));
    }
    return number;
  }
};

/// A cell with surface in it: its place in its block, and which of its edges are crossed.
struct SurfaceCell {
  std::uint16_t cell;
  std::uint16_t edges;
};
using Cells = std::vector<SurfaceCell>;

/// Which block owns an edge of a cell, as bits x y z of corner_blocks, and the edge's number in it.
struct EdgePlace {
  std::size_t owner, edge;
};

EdgePlace place_of(std::uint16_t cell, int edge) {
  const int first = corners_of_edge(edge)[0];
  const int x = cell % width + (first & 1), y = cell / width % width + (first >> 1 & 1),
            z = cell / (width * width) + (first >> 2);
  return {std::size_t(x / width | y / width << 1 | z / width << 2),
          3 * std::size_t(((z % width) * width + y % width) * width + x % width) +
              std::size_t(edge / 4)};
}

std::array<float, 8> distances_of(const BlockCorners& corners, std::uint16_t cell) {
  std::array<float, 8> result;
  for (std::size_t k = 0; k < 8; ++k)
    result[k] = corners.distance[corner_of_cell(cell) + cell_corners[k]];
  return result;
}

class Extraction {
 public:
  explicit Extraction(const DistanceField& field)
      : field_(field), cells_(field.blocks.size()), edges_(field.blocks.size()) {}

  TriangleMesh run() {
    find_cells();
    number_vertices();
    TriangleMesh mesh;
    write_vertices(mesh);
    write_triangles(mesh);
    return mesh;
  }

 private:
  template <class Body>
  void for_blocks(const Body& body) {
    parallel_for(field_.blocks.size(), blocks_per_task, [&](std::size_t begin, std::size_t end) {
      BlockCorners corners;
      for (std::size_t b = begin; b < end; ++b) body(b, corners);
    });
  }

  void find_cells() {
    for_blocks([&](std::size_t b, BlockCorners& corners) {
      corners.read(field_, field_.blocks.key(b));
      for (std::size_t cell = 0; cell < block_cells; ++cell)
        if (const int edges = crossed_edges(corners, corner_of_cell(cell)))
          cells_[b].push_back({std::uint16_t(cell), std::uint16_t(edges)});
    });
  }

  /// An edge belongs to the block of its lower corner; cells of that block and of those below it
  /// may use it.
  void number_vertices() {
    for_blocks([&](std::size_t b, BlockCorners&) {
      const auto below = octant_blocks(field_.blocks, field_.blocks.key(b), -width);
      for (std::size_t k = 0; k < 8; ++k) {
        if (below[k] == no_block) continue;
        for (const SurfaceCell& cell : cells_[below[k]])
          for (int edge = 0; edge < 12; ++edge) {
            if ((cell.edges >> edge & 1) == 0) continue;
            const EdgePlace place = place_of(cell.cell, edge);
            if (place.owner == k) edges_[b].insert(place.edge);
          }
      }
    });
    for (EdgeSet& edges : edges_) vertices_ = edges.count_from(vertices_);
  }

  void write_vertices(TriangleMesh& mesh) {
    mesh.vertices.resize(vertices_);
    for_blocks([&](std::size_t b, BlockCorners& corners) {
      corners.read(field_, field_.blocks.key(b));
      const Eigen::Vector3d start = cell_of(field_.blocks.key(b)).cast<double>();
      for (std::size_t edge = 0; edge < 3 * block_cells; ++edge) {
        if ((edges_[b].bits[edge / 64] >> (edge % 64) & 1) == 0) continue;
        const auto corner = std::uint16_t(edge / 3);
        const auto axis = Eigen::Index(edge % 3);
        const std::size_t i = corner_of_cell(corner);
        const std::size_t j = i + corner_step[std::size_t(axis)];
        Eigen::Vector3d at = start + Eigen::Vector3d(corner % width, corner / width % width,
                                                     corner / (width * width));
        at[axis] += crossing(corners.distance[i], corners.distance[j]);
        mesh.vertices[edges_[b].number(edge)] =
            (field_.lattice.origin + field_.lattice.size * at).cast<float>();
      }
    });
  }

  /// Where between two values of different sign zero is; kept off the corners, where triangles
  /// would have no area.
  static double crossing(float from, float to) {
    constexpr double margin = 0.02;
    const double at = double(from) / (double(from) - double(to));
    return std::clamp(at, margin, 1 - margin);
  }

  /// What one block adds to the mesh; vertices of its own are numbered from `own_vertex`.
  struct BlockMesh {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Eigen::Vector3f> centres;
  };
  static constexpr std::uint32_t own_vertex = 0x80000000u;

  void write_triangles(TriangleMesh& mesh) {
    std::vector<BlockMesh> parts(field_.blocks.size());
    for_blocks([&](std::size_t b, BlockCorners& corners) {
      if (cells_[b].empty()) return;
      corners.read(field_, field_.blocks.key(b));
      const auto owners = octant_blocks(field_.blocks, field_.blocks.key(b), width);
      for (const SurfaceCell& found : cells_[b]) {
        const std::uint16_t cell = found.cell;
        const CellLoops loops = cell_loops(distances_of(corners, cell));
        for (std::size_t loop = 0; loop < std::size_t(loops.count); ++loop) {
          std::array<std::uint32_t, 12> ring;
          for (std::size_t k = 0; k < std::size_t(loops.length[loop]); ++k) {
            const EdgePlace place = place_of(cell, loops.edges[loop][k]);
            ring[k] = edges_[owners[place.owner]].number(place.edge);
          }
          const std::span inner(ring.data(), std::size_t(loops.length[loop]));
          fill_ring(mesh, inner, loops.edges[loop].data(), parts[b]);
        }
      }
    });
    for (const BlockMesh& part : parts) {
      const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
      for (auto triangle : part.triangles) {
        for (std::uint32_t& vertex : triangle)
          if (vertex >= own_vertex) vertex = vertex - own_vertex + offset;
        mesh.triangles.push_back(triangle);
      }
      mesh.vertices.insert(mesh.vertices.end(), part.centres.begin(), part.centres.end());
    }
  }

  static void fill_ring(const TriangleMesh& mesh, std::span<const std::uint32_t> ring,
                        const std::uint8_t* edges, BlockMesh& part) {
    const LoopTriangles filling = triangulate_loop(edges, int(ring.size()));
    const std::uint32_t centre = own_vertex + static_cast<std::uint32_t>(part.centres.size());
    bool has_centre = false;
    for (std::size_t t = 0; t < std::size_t(filling.count); ++t) {
      std::array<std::uint32_t, 3> triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint8_t corner = filling.corners[t][k];
        has_centre = has_centre || corner == centre_of_loop;
        triangle[k] = corner == centre_of_loop ? centre : ring[corner];
      }
      part.triangles.push_back(triangle);
    }
    if (!has_centre) return;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const std::uint32_t vertex : ring) sum += mesh.vertices[vertex];
    part.centres.push_back(sum / float(ring.size()));
  }

  const DistanceField& field_;
  std::vector<Cells> cells_;    ///< per block
  std::vector<EdgeSet> edges_;  ///< per block
  std::uint32_t vertices_ = 0;
};

}  // namespace

TriangleMesh marching_cubes(const DistanceField& field) { return Extraction(field).run(); }

}  // namespace planum
