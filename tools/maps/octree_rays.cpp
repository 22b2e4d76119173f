#include "tools/maps/octree_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

/// A cell of a box as one number, 16 bits an axis: what a step adds to one never reaches another.
using PackedKey = std::int64_t;

/// Where each cell of a brick is in a BrickSet, by the last three bits of x, of y and of z.
constexpr std::array<std::uint16_t, cells_per_brick> morton_places() {
  std::array<std::uint16_t, cells_per_brick> result = {};
  for (std::size_t i = 0; i < cells_per_brick; ++i)
    result[i] =
        static_cast<std::uint16_t>(spread(i & 7) | spread(i >> 3 & 7) << 1 | spread(i >> 6) << 2);
  return result;
}
constexpr std::array<std::uint16_t, cells_per_brick> morton_place = morton_places();

/// The bricks of a box; each is made when first asked for.
class BrickBox {
 public:
  BrickBox(const CellKey& low, const CellKey& high) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int first = std::max(low[axis] / 8 - 1, 0);  // a ray may leave the box by a cell
      const int last = std::min(high[axis] / 8 + 1, 8191);
      low_[axis] = static_cast<std::uint16_t>(first);
      size_[axis] = last - first + 1;
    }
    slots_.assign(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]), 0);
  }

  PackedKey packed(const CellKey& key) const {
    return PackedKey{key[0] - 8 * low_[0]} | PackedKey{key[1] - 8 * low_[1]} << 16 |
           PackedKey{key[2] - 8 * low_[2]} << 32;
  }

  /// The brick of a cell, or of each of some, and which cell of it it is.
  template <class Keys>
  void locate(const Keys& keys, Keys& bricks, Keys& cells) const {
    bricks = (keys >> 3 & 0x1fff) + (keys >> 19 & 0x1fff) * size_[0] +
             (keys >> 35) * (size_[0] * size_[1]);
    cells = (keys & 7) | (keys >> 13 & 0x38) | (keys >> 26 & 0x1c0);
  }

  /// The reference holds until the next brick is made.
  SeenBrick& at(PackedKey brick) {
    std::uint32_t& slot = slots_[static_cast<std::size_t>(brick)];
    if (slot == 0) {
      bricks_.push_back({.key = key_of(brick), .occupied = {}, .free = {}});
      slot = static_cast<std::uint32_t>(bricks_.size());
    }
    return bricks_[slot - 1];
  }

  std::vector<SeenBrick> taken() && { return std::move(bricks_); }

 private:
  BrickKey key_of(PackedKey brick) const {
    const auto key = [&](std::size_t axis, PackedKey in_box) {
      return static_cast<std::uint16_t>(low_[axis] + in_box);
    };
    return {key(0, brick % size_[0]), key(1, brick / size_[0] % size_[1]),
            key(2, brick / size_[0] / size_[1])};
  }

  BrickKey low_ = {};
  std::array<PackedKey, 3> size_ = {};
  std::vector<std::uint32_t> slots_;  // for each brick 1 + its position, 0: not made
  std::vector<SeenBrick> bricks_;
};

/// A ray on its way from cell to cell.
struct Ray {
  PackedKey cell = 0, last = 0;        ///< where it is, where it ends
  double length = 0;                   ///< m
  std::array<PackedKey, 3> step = {};  ///< what a step along each axis adds to `cell`
  std::array<double, 3> next = {};     ///< m along it, to the next side on each axis
  std::array<double, 3> between = {};  ///< m along it, from side to side
};

Ray ray_between(const Eigen::Vector3f& from, const CellKey& from_key, const CellKey& end,
                const BrickBox& box, double cell) {
  Ray ray;
  ray.cell = box.packed(from_key);
  ray.last = box.packed(end);
  const auto middle = [&](std::size_t axis) {
    return static_cast<float>(middle_of(end[axis], cell));
  };
  const Eigen::Vector3f way = Eigen::Vector3f(middle(0), middle(1), middle(2)) - from;
  const float squared = way.x() * way.x() + way.y() * way.y() + way.z() * way.z();
  const auto length = static_cast<float>(std::sqrt(static_cast<double>(squared)));
  ray.length = static_cast<double>(length);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float d = way[Eigen::Index(axis)] / length;
    ray.step[axis] = (d < 0 ? -1 : 1) * (PackedKey{1} << (16 * axis));
    ray.next[axis] = ray.between[axis] = std::numeric_limits<double>::max();
    if (d == 0) continue;
    const double side = middle_of(from_key[axis], cell) +
                        static_cast<double>(static_cast<float>((d > 0 ? 1 : -1) * cell * 0.5));
    ray.next[axis] =
        (side - static_cast<double>(from[Eigen::Index(axis)])) / static_cast<double>(d);
    ray.between[axis] = cell / std::abs(static_cast<double>(d));
  }
  return ray;
}

/// Rays that walk side by side, a lane of the processor each: on its own a ray would wait for each
/// step, as which side comes next cannot be foretold.
class Walkers {
 public:
  static constexpr std::size_t count = 8;

  /// All rest at `start`, where all rays begin.
  explicit Walkers(PackedKey start) : start_(start) {
    for (std::size_t lane = 0; lane < count; ++lane) rest(lane);
  }

  void begin(std::size_t lane, const Ray& ray) {
    cell_[lane] = ray.cell;
    last_[lane] = ray.last;
    length_[lane] = ray.length;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      step_[axis][lane] = ray.step[axis];
      next_[axis][lane] = ray.next[axis];
      between_[axis][lane] = ray.between[axis];
    }
  }

  /// Stays at the start from now on.
  void rest(std::size_t lane) {
    cell_[lane] = start_;
    last_[lane] = -1;
    length_[lane] = HUGE_VAL;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      step_[axis][lane] = 0;
      next_[axis][lane] = between_[axis][lane] = 0;
    }
  }

  void mark_free(BrickBox& box) const {
    Keys bricks, cells;
    box.locate(cell_, bricks, cells);
    for (std::size_t lane = 0; lane < count; ++lane)
      box.at(bricks[lane]).free.add(morton_place[static_cast<std::size_t>(cells[lane])]);
  }

  /// Goes on to the next cell; returns whether a ray arrived.
  bool step() {
    const Keys a = (next_[0] < next_[1]) & (next_[0] < next_[2]);
    const Keys b = ~(next_[0] < next_[1]) & (next_[1] < next_[2]);
    const Keys c = ~(a | b);
    cell_ += (a & step_[0]) + (b & step_[1]) + (c & step_[2]);
    const Lengths none = {};
    next_[0] += a ? between_[0] : none;
    next_[1] += b ? between_[1] : none;
    next_[2] += c ? between_[2] : none;
    has_arrived_ =
        (cell_ == last_) | ((next_[0] > length_) & (next_[1] > length_) & (next_[2] > length_));
    std::int64_t any = 0;
    for (std::size_t lane = 0; lane < count; ++lane) any |= has_arrived_[lane];
    return any != 0;
  }

  bool has_arrived(std::size_t lane) const { return has_arrived_[lane] != 0; }

 private:
  using Keys = PackedKey __attribute__((vector_size(8 * count)));
  using Lengths = double __attribute__((vector_size(8 * count)));

  PackedKey start_;
  Keys cell_ = {}, last_ = {}, step_[3] = {}, has_arrived_ = {};
  Lengths length_ = {}, next_[3] = {}, between_[3] = {};
};

/// All cells from `from` up to the ones before the ends are free.
void mark_rays(const Eigen::Vector3f& from, const CellKey& from_key, std::span<const CellKey> ends,
               double cell, BrickBox& box) {
  std::size_t begun = 0, walking = 0;
  const auto next_ray = [&] { return ray_between(from, from_key, ends[begun++], box, cell); };
  Walkers walkers(box.packed(from_key));
  for (; walking < Walkers::count && begun < ends.size(); ++walking)
    walkers.begin(walking, next_ray());
  while (walking > 0) {
    walkers.mark_free(box);
    if (!walkers.step()) continue;
    for (std::size_t lane = 0; lane < Walkers::count; ++lane) {
      if (!walkers.has_arrived(lane)) continue;
      if (begun < ends.size()) {
        walkers.begin(lane, next_ray());
      } else {
        walkers.rest(lane);
        --walking;
      }
    }
  }
}

}  // namespace

std::vector<SeenBrick> seen_cells(std::span<const Eigen::Vector3f> points,
                                  const Eigen::Vector3f& origin, double cell) {
  const double cells_per_metre = 1 / cell;
  const CellKey from = key_at(origin, cells_per_metre);
  std::vector<CellKey> keys;
  keys.reserve(points.size());
  CellKey low = from, high = from;
  for (const Eigen::Vector3f& p : points) {
    keys.push_back(key_at(p, cells_per_metre));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], keys.back()[axis]);
      high[axis] = std::max(high[axis], keys.back()[axis]);
    }
  }
  BrickBox box(low, high);
  std::vector<CellKey> ends;
  for (const CellKey& key : keys) {
    PackedKey brick = 0, cell_in_brick = 0;
    box.locate(box.packed(key), brick, cell_in_brick);
    BrickSet& occupied = box.at(brick).occupied;
    const std::size_t place = morton_place[static_cast<std::size_t>(cell_in_brick)];
    if (occupied.has(place)) continue;
    occupied.add(place);
    if (key != from) ends.push_back(key);
  }
  mark_rays(origin, from, ends, cell, box);
  std::vector<SeenBrick> bricks = std::move(box).taken();
  for (SeenBrick& brick : bricks) brick.free.remove_all(brick.occupied);
  return bricks;
}

}  // namespace planum
