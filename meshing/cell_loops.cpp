#include "meshing/cell_loops.hpp"

#include <limits>

namespace planum {
namespace {

constexpr int edge_between(int corner_a, int corner_b) {
  const int low = corner_a < corner_b ? corner_a : corner_b;
  const int axis = (corner_a ^ corner_b) == 1 ? 0 : (corner_a ^ corner_b) == 2 ? 1 : 2;
  const int x = low & 1, y = low >> 1 & 1, z = low >> 2;
  return 4 * axis + (axis == 0 ? y + 2 * z : axis == 1 ? x + 2 * z : x + 2 * y);
}

/// Corners of a face, counter-clockwise seen from outside, and the edges between them.
struct Face {
  std::array<int, 4> corners{};
  std::array<int, 4> edges{};  ///< edge k is between corners k and k + 1
};

constexpr std::array<Face, 6> make_faces() {
  std::array<Face, 6> faces{};
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      Face& face = faces[std::size_t(2 * axis + side)];
      const int b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3, base = side << axis;
      face.corners = {base, base | b, base | b | c, base | c};
      if (side == 0) face.corners = {base, base | c, base | b | c, base | b};
      for (std::size_t k = 0; k < 4; ++k)
        face.edges[k] = edge_between(face.corners[k], face.corners[(k + 1) % 4]);
    }
  return faces;
}
constexpr std::array<Face, 6> faces = make_faces();

/// Bit f: the edge is one of face f.
constexpr std::array<int, 12> make_faces_of_edges() {
  std::array<int, 12> result{};
  for (int f = 0; f < 6; ++f)
    for (const int edge : faces[std::size_t(f)].edges) result[std::size_t(edge)] |= 1 << f;
  return result;
}
constexpr std::array<int, 12> faces_of_edges = make_faces_of_edges();

constexpr int none = -1;

/// Notes for each crossed edge of a face the edge that follows it on its curve, if that lies on
/// this face.
void follow_face(const Face& face, const std::array<float, 8>& distance,
                 std::array<int, 12>& next) {
  std::array<bool, 4> inside{};
  int crossed = 0;
  for (std::size_t k = 0; k < 4; ++k) inside[k] = distance[std::size_t(face.corners[k])] < 0;
  for (std::size_t k = 0; k < 4; ++k) crossed += inside[k] != inside[(k + 1) % 4];
  if (crossed == 0) return;
  bool cut_inside = true;  // a curve goes around each run of corners inside, else each run outside
  if (crossed == 4) {
    const auto d = [&](std::size_t k) { return distance[std::size_t(face.corners[k])]; };
    const float even = d(0) * d(2), odd = d(1) * d(3);
    cut_inside = inside[0] ? even <= odd : odd <= even;
  }
  // Walking around the face, a run of inside corners begins at a crossing and ends at another; the
  // curve leaves the cell's face at the end of the run, having come in at its beginning.
  for (std::size_t k = 0; k < 4; ++k) {
    const bool begins = !inside[k] && inside[(k + 1) % 4];
    if (!begins) continue;
    std::size_t end = k;
    if (cut_inside) do
        end = (end + 1) % 4;
      while (!(inside[end] && !inside[(end + 1) % 4]));
    else
      do end = (end + 3) % 4;
      while (!(inside[end] && !inside[(end + 1) % 4]));
    next[std::size_t(face.edges[k])] = face.edges[end];
  }
}

}  // namespace

bool in_one_face(int edge_a, int edge_b) {
  return (faces_of_edges[std::size_t(edge_a)] & faces_of_edges[std::size_t(edge_b)]) != 0;
}

namespace {

/// Twice the middle of an edge in the unit cell.
std::array<int, 3> doubled_middle(int edge) {
  const auto [a, b] = corners_of_edge(edge);
  return {(a & 1) + (b & 1), (a >> 1 & 1) + (b >> 1 & 1), (a >> 2) + (b >> 2)};
}

constexpr int forbidden = 1000;

/// What it costs to join two edges inside the cell: the squared length, forbidden in a face.
int cost(int edge_a, int edge_b) {
  const auto a = doubled_middle(edge_a), b = doubled_middle(edge_b);
  int sum = in_one_face(edge_a, edge_b) ? forbidden : 0;
  for (std::size_t k = 0; k < 3; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

}  // namespace

CellLoops cell_loops(const std::array<float, 8>& distance) {
  std::array<int, 12> next;
  next.fill(none);
  for (const Face& face : faces) follow_face(face, distance, next);
  CellLoops loops;
  for (std::size_t start = 0; start < 12; ++start) {
    if (next[start] == none) continue;
    const auto loop = std::size_t(loops.count++);
    for (std::size_t edge = start; next[edge] != none;) {
      loops.edges[loop][std::size_t(loops.length[loop]++)] = std::uint8_t(edge);
      const auto following = std::size_t(next[edge]);
      next[edge] = none;
      edge = following;
    }
  }
  return loops;
}

LoopTriangles triangulate_loop(const std::uint8_t* edges, int n) {
  LoopTriangles triangles;
  const auto add = [&](int i, int j, std::uint8_t k) {
    triangles.corners[std::size_t(triangles.count++)] = {std::uint8_t(i), std::uint8_t(j), k};
  };
  // Least total cost of the diagonals over all triangulations, by the polygon from i to j.
  std::array<std::array<int, 12>, 12> least{}, middle{};
  for (int width = 2; width < n; ++width)
    for (int i = 0; i + width < n; ++i) {
      const auto from = std::size_t(i), to = std::size_t(i + width);
      int best = std::numeric_limits<int>::max();
      for (std::size_t k = from + 1; k < to; ++k) {
        const int sum = least[from][k] + least[k][to];
        if (sum < best) best = sum, middle[from][to] = int(k);
      }
      const bool outline = width == n - 1;
      least[from][to] = best + (outline ? 0 : cost(edges[from], edges[to]));
    }
  if (least[0][std::size_t(n - 1)] >= forbidden) {
    for (int i = 0; i < n; ++i) add(i, (i + 1) % n, centre_of_loop);
    return triangles;
  }
  int waiting = 1;
  std::array<std::array<int, 2>, 12> stack{};
  stack[0] = {0, n - 1};
  while (waiting > 0) {
    const auto [i, j] = stack[std::size_t(--waiting)];
    if (j - i < 2) continue;
    const int k = middle[std::size_t(i)][std::size_t(j)];
    add(i, k, std::uint8_t(j));
    stack[std::size_t(waiting++)] = {i, k};
    stack[std::size_t(waiting++)] = {k, j};
  }
  return triangles;
}

}  // namespace planum
