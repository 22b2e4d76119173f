#include "meshing/corner_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace planum {
namespace {

constexpr std::size_t most_sheets = 3;

/// A patch as the corners of one block see it: lengths in cells from the block's first corner.
struct LocalPatch {
  Eigen::Vector3f centre, normal;
  float count;
  std::array<int, 3> lowest, highest;  ///< corners within reach
};

/// The planes around a corner that belong to one sheet of surface.
struct Sheet {
  int patch = -1;  ///< the one nearest to the corner decides what belongs here; -1: no sheet
  float nearest = std::numeric_limits<float>::infinity();  ///< squared distance to it
  float at_nearest = 0;  ///< distance of the corner from its plane
  float weight = 0;
  float distance = 0;                                ///< weighted sum
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< weighted sum
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< sum over points, relative to the corner
  float points = 0;
};
using CornerSheets = std::array<Sheet, block_cells>;

/// A patch seen from a corner.
struct View {
  Eigen::Vector3f to_corner;
  float across;         ///< distance of the corner from the plane
  float squared_along;  ///< squared distance along the plane
};

void patches_near(const SurfacePatches& all, CellKey block, std::vector<LocalPatch>& near) {
  near.clear();
  const Eigen::Vector3i corner = cell_of(block);
  const Eigen::Vector3d start = corner.cast<double>();
  for (const std::uint32_t neighbour : all.blocks.neighbourhood(block)) {
    if (neighbour == no_block) continue;
    for (std::uint32_t k = all.begin[neighbour]; k < all.begin[neighbour + 1]; ++k) {
      const Eigen::Array3i at = (cell_of(all.cells[k]) - corner).array();
      if ((at < -patch_reach).any() || (at >= block_width + patch_reach - 1).any()) continue;
      LocalPatch& patch = near.emplace_back();
      patch.centre = (all.patches[k].centre / all.lattice.size - start).cast<float>();
      patch.normal = all.patches[k].normal;
      patch.count = all.patches[k].count;
      for (int axis = 0; axis < 3; ++axis) {
        patch.lowest[std::size_t(axis)] = std::max(at[axis] + 1 - patch_reach, 0);
        patch.highest[std::size_t(axis)] = std::min(at[axis] + patch_reach, block_width - 1);
      }
    }
  }
}

/// Calls visit(corner, view) for the corners within reach of a patch.
template <class Visit>
void for_corners(const LocalPatch& patch, const Visit& visit) {
  View view;
  for (int z = patch.lowest[2]; z <= patch.highest[2]; ++z)
    for (int y = patch.lowest[1]; y <= patch.highest[1]; ++y)
      for (int x = patch.lowest[0]; x <= patch.highest[0]; ++x) {
        view.to_corner = Eigen::Vector3f(float(x), float(y), float(z)) - patch.centre;
        view.across = patch.normal.dot(view.to_corner);
        view.squared_along = view.to_corner.squaredNorm() - view.across * view.across;
        visit(std::size_t((z * block_width + y) * block_width + x), view);
      }
}

/// Makes a patch the nearest of its sheet if it is. Distances count from a small disc.
void offer(const View& view, std::size_t patch, Sheet& sheet) {
  constexpr float squared_disc = 0.25f;
  const float squared =
      view.across * view.across + std::max(0.0f, view.squared_along - squared_disc);
  if (squared >= sheet.nearest) return;
  sheet.nearest = squared;
  sheet.at_nearest = view.across;
  sheet.patch = int(patch);
}

/// Finds the sheets of the corners of one block, one after the other.
class SheetSearch {
 public:
  void run(const SurfacePatches& patches, CellKey block, float radius) {
    patches_near(patches, block, near_);
    squared_radius_ = radius * radius;
    for (CornerSheets& sheets : levels_) sheets.fill(Sheet{});
    for (std::size_t p = 0; p < near_.size(); ++p)
      for_corners(near_[p],
                  [&](std::size_t c, const View& view) { offer(view, p, levels_[0][c]); });
    bool more = add_to_first();
    for (std::size_t level = 1; more && level < most_sheets; ++level) more = add_to(level);
  }

  std::array<Sheet, most_sheets> at(std::size_t corner) const {
    return {levels_[0][corner], levels_[1][corner], levels_[2][corner]};
  }

 private:
  bool belongs(const LocalPatch& patch, const View& view, const Sheet& sheet) const {
    constexpr float same_direction = 0.7f;  // cosine, about 45 degrees
    constexpr float same_layer = 0.6f;      // cells
    return std::abs(view.across - sheet.at_nearest) <= same_layer &&
           patch.normal.dot(near_[std::size_t(sheet.patch)].normal) >= same_direction;
  }

  void add(const LocalPatch& patch, const View& view, Sheet& sheet) const {
    const float nearness = 1 - view.squared_along / squared_radius_;
    if (nearness <= 0) return;
    const float weight = nearness * nearness * patch.count;
    sheet.weight += weight;
    sheet.distance += weight * view.across;
    sheet.normal += weight * patch.normal;
  }

  static void add_centre(const LocalPatch& patch, const View& view, Sheet& sheet) {
    sheet.centre -= patch.count * view.to_corner;
    sheet.points += patch.count;
  }

  /// Most corners have one sheet only: the middles of sheets are left for later.
  bool add_to_first() {
    bool more = false;
    for (std::size_t p = 0; p < near_.size(); ++p)
      for_corners(near_[p], [&](std::size_t c, const View& view) {
        Sheet& sheet = levels_[0][c];
        if (belongs(near_[p], view, sheet)) return add(near_[p], view, sheet);
        offer(view, p, levels_[1][c]);
        more = true;
      });
    return more;
  }

  bool add_to(std::size_t level) {
    bool more = false;
    for (std::size_t p = 0; p < near_.size(); ++p)
      for_corners(near_[p], [&](std::size_t c, const View& view) {
        if (levels_[level][c].patch < 0) return;
        for (std::size_t k = 0; k <= level; ++k) {
          Sheet& sheet = levels_[k][c];
          if (!belongs(near_[p], view, sheet)) continue;
          if (k == level) add(near_[p], view, sheet);
          if (k == level || level == 1) add_centre(near_[p], view, sheet);
          return;
        }
        if (level + 1 == most_sheets) return;
        offer(view, p, levels_[level + 1][c]);
        more = true;
      });
    return more;
  }

  std::vector<LocalPatch> near_;
  std::array<CornerSheets, most_sheets> levels_;
  float squared_radius_ = 1;
};

/// Signed distance and its direction at one corner, in cells.
struct Value {
  float distance = std::numeric_limits<float>::quiet_NaN();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};

/// How two sheets meet: each has the other in front of it (+1, as in the corner of a room) or
/// behind it (-1, as at the edge of a table); else they do not meet (0).
int relation(const Sheet& a, const Sheet& b) {
  constexpr float clear = 0.15f;  // cells
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
Value value_of(std::array<Sheet, most_sheets> sheets) {
  std::array<Value, most_sheets> values;
  std::size_t count = 0;
  for (Sheet& sheet : sheets) {
    if (sheet.patch < 0 || sheet.weight <= 0) break;
    sheet.normal.normalize();
    if (sheet.points > 0) sheet.centre /= sheet.points;
    values[count++] = {sheet.distance / sheet.weight, sheet.normal};
  }
  if (count < 2) return values[0];
  const int first_second = relation(sheets[0], sheets[1]);
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

}  // namespace

void corner_values(const SurfacePatches& patches, CellKey block, float radius,
                   std::span<float> distance, std::span<Eigen::Vector3f> normal) {
  thread_local SheetSearch search;
  search.run(patches, block, radius);
  for (std::size_t c = 0; c < block_cells; ++c) {
    const Value value = value_of(search.at(c));
    distance[c] = value.distance;
    normal[c] = value.normal;
  }
}

}  // namespace planum
