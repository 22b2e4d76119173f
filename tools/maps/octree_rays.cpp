#include "tools/maps/octree_rays.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <octomap/octomap_types.h>

namespace planum {
namespace {

constexpr int middle_key = 32768;  // of the cell whose lower side is at 0

// As OctoMap computes them, to the bit.
std::uint16_t key_at(double coordinate, double cells_per_metre) {
  return static_cast<std::uint16_t>(static_cast<int>(std::floor(cells_per_metre * coordinate)) +
                                    middle_key);
}
double middle_of(std::uint16_t key, double cell) { return (double(key - middle_key) + 0.5) * cell; }

CellKey key_at(const Eigen::Vector3f& p, double cells_per_metre) {
  return {key_at(double(p.x()), cells_per_metre), key_at(double(p.y()), cells_per_metre),
          key_at(double(p.z()), cells_per_metre)};
}

/// The bricks of a box; each is made when first asked for.
class BrickBox {
 public:
  /// A cell as the sum of what each axis says of it: bricks in rows and layers, cells in a brick.
  using Place = std::size_t;

  BrickBox(const CellKey& low, const CellKey& high) {
    std::size_t stride = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int first = std::max(low[axis] / 8 - 1, 0);  // a ray may leave the box by a cell
      const int last = std::min(high[axis] / 8 + 1, 8191);
      low_[axis] = static_cast<std::uint16_t>(first);
      size_[axis] = static_cast<std::size_t>(last - first + 1);
      for (std::size_t i = 0; i < 8 * size_[axis]; ++i)
        places_[axis].push_back(i / 8 * stride * cells_per_brick + (spread(i % 8) << axis));
      stride *= size_[axis];
    }
    slots_.assign(stride, 0);
  }

  /// Precondition: the cell is in the box.
  Place place(std::size_t x, std::size_t y, std::size_t z) const {
    return places_[0][x - 8 * low_[0]] + places_[1][y - 8 * low_[1]] + places_[2][z - 8 * low_[2]];
  }

  /// The reference holds until the next brick is made.
  SeenBrick& brick_of(Place place) {
    std::uint32_t& slot = slots_[place / cells_per_brick];
    if (slot == 0) {
      bricks_.push_back({.key = key_of(place / cells_per_brick), .occupied = {}, .free = {}});
      slot = static_cast<std::uint32_t>(bricks_.size());
    }
    return bricks_[slot - 1];
  }

  std::vector<SeenBrick> taken() && { return std::move(bricks_); }

 private:
  BrickKey key_of(std::size_t brick) const {
    const auto key = [&](std::size_t axis, std::size_t in_box) {
      return static_cast<std::uint16_t>(low_[axis] + in_box);
    };
    return {key(0, brick % size_[0]), key(1, brick / size_[0] % size_[1]),
            key(2, brick / size_[0] / size_[1])};
  }

  BrickKey low_ = {};
  std::array<std::size_t, 3> size_ = {};
  std::array<std::vector<Place>, 3> places_;  // for each key from that of the lowest brick
  std::vector<std::uint32_t> slots_;          // for each brick 1 + its position, 0: not made
  std::vector<SeenBrick> bricks_;
};

/// Calls visit(x, y, z) for all cells from `from` up to the one before that of `end`.
template <class Visit>
void walk(const octomap::point3d& from, const CellKey& from_key, const CellKey& end, double cell,
          const Visit& visit) {
  if (from_key == end) return;
  const auto middle = [&](std::size_t axis) {
    return static_cast<float>(middle_of(end[axis], cell));
  };
  octomap::point3d direction = octomap::point3d(middle(0), middle(1), middle(2)) - from;
  const auto length = static_cast<double>(static_cast<float>(direction.norm()));
  direction /= static_cast<float>(length);

  // The key as one number, 16 bits an axis: a step adds to its part and never carries.
  const auto packed = [](const CellKey& key) {
    return std::uint64_t{key[0]} | std::uint64_t{key[1]} << 16 | std::uint64_t{key[2]} << 32;
  };
  std::uint64_t step[3];
  double next[3], between[3];  // m along the ray: to the next side of a cell, and from one to one
  for (unsigned axis = 0; axis < 3; ++axis) {
    const float d = direction(axis);
    step[axis] = std::uint64_t{1} << (16 * axis);
    if (d < 0) step[axis] = -step[axis];
    next[axis] = between[axis] = std::numeric_limits<double>::max();
    if (d == 0) continue;
    const double side = middle_of(from_key[axis], cell) +
                        static_cast<double>(static_cast<float>((d > 0 ? 1 : -1) * cell * 0.5));
    next[axis] = (side - double(from(axis))) / double(d);
    between[axis] = cell / std::abs(double(d));
  }
  const std::uint64_t last = packed(end);
  double a = next[0], b = next[1], c = next[2];
  for (std::uint64_t key = packed(from_key);;) {
    visit(key & 0xffff, key >> 16 & 0xffff, key >> 32);
    // Without branches: which side comes next cannot be foretold.
    const bool is_a = (a < b) & (a < c), is_b = !(a < b) & (b < c), is_c = !(is_a | is_b);
    key += (is_a ? step[0] : 0) + (is_b ? step[1] : 0) + (is_c ? step[2] : 0);
    a += is_a ? between[0] : 0.0;
    b += is_b ? between[1] : 0.0;
    c += is_c ? between[2] : 0.0;
    if (key == last || std::min(std::min(a, b), c) > length) return;
  }
}

}  // namespace

std::vector<SeenBrick> seen_cells(std::span<const Eigen::Vector3f> points,
                                  const Eigen::Vector3f& origin, double cell) {
  const double cells_per_metre = 1 / cell;
  const CellKey from = key_at(origin, cells_per_metre);
  std::vector<CellKey> ends;
  ends.reserve(points.size());
  for (const Eigen::Vector3f& p : points) ends.push_back(key_at(p, cells_per_metre));
  CellKey low = from, high = from;
  for (const CellKey& end : ends)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], end[axis]);
      high[axis] = std::max(high[axis], end[axis]);
    }
  BrickBox box(low, high);
  for (const CellKey& end : ends) {
    const BrickBox::Place place = box.place(end[0], end[1], end[2]);
    SeenBrick& brick = box.brick_of(place);
    if (brick.occupied.has(place % cells_per_brick)) continue;
    brick.occupied.add(place % cells_per_brick);
    walk({origin.x(), origin.y(), origin.z()}, from, end, cell,
         [&](std::size_t x, std::size_t y, std::size_t z) {
           const BrickBox::Place passed = box.place(x, y, z);
           box.brick_of(passed).free.add(passed % cells_per_brick);
         });
  }
  std::vector<SeenBrick> bricks = std::move(box).taken();
  for (SeenBrick& brick : bricks) brick.free.remove_all(brick.occupied);
  return bricks;
}

}  // namespace planum
