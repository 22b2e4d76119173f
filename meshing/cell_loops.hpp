#pragma once

#include <array>
#include <cstdint>

namespace planum {

/// Corner i of a cell is at (i & 1, i >> 1 & 1, i >> 2); edge 4 a + b runs along axis a, and b
/// holds the places of its corners along the other two axes (the lower axis in the low bit).
constexpr std::array<int, 2> corners_of_edge(int edge) {
  const int axis = edge / 4, low = edge & 1, high = edge >> 1 & 1;
  const int first = axis == 0   ? low << 1 | high << 2
                    : axis == 1 ? low | high << 2
                                : low | high << 1;
  return {first, first | 1 << axis};
}

/// Whether two edges of a cell are edges of one of its faces.
bool in_one_face(int edge_a, int edge_b);

/// The closed curves in which a surface meets the faces of one cell, as the edges they cross; seen
/// from the positive side they run counter-clockwise.
struct CellLoops {
  int count = 0;
  std::array<int, 4> length{};
  std::array<std::array<std::uint8_t, 12>, 4> edges{};
};

/// Curves that follow from the signs at the corners; where a face has two diagonal corners of each
/// sign, the bilinear interpolation on it decides what is joined (asymptotic decider, Nielson and
/// Hamann 1991), so that both cells at a face agree, and no cracks open.
CellLoops cell_loops(const std::array<float, 8>& distance);

/// Triangles that fill a curve, as positions in it; `centre_of_loop` stands for a vertex of their
/// own in the middle of the curve, which those few need that cannot do without inner edges in a
/// face of the cell, where edges of the next cell's triangles might lie too.
struct LoopTriangles {
  int count = 0;
  std::array<std::array<std::uint8_t, 3>, 12> corners{};
};
inline constexpr std::uint8_t centre_of_loop = 255;
LoopTriangles triangulate_loop(const std::uint8_t* edges, int n);

}  // namespace planum
