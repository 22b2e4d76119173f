#include "labeling/rooms/level_surfaces.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "labeling/plan/grid_morphology.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
constexpr float split_gap = 0.08f;     // m between two surfaces in one column
constexpr double nearest_reach = 3.0;  // m
constexpr std::size_t cells_per_block = 1 << 12;

struct Sample {
  std::uint32_t cell;
  float up;  ///< m; the wanted surface is the one with the largest value
  bool operator<(const Sample& other) const {
    return cell != other.cell ? cell < other.cell : up > other.up;
  }
};

/// Sorted: by counting into cells, then within each, which hold few.
std::vector<Sample> by_cell(const std::vector<Sample>& samples, std::size_t cells) {
  std::vector<std::uint32_t> begin(cells + 1, 0);
  for (const Sample& sample : samples) ++begin[sample.cell + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Sample> sorted(samples.size());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (const Sample& sample : samples) sorted[next[sample.cell]++] = sample;
  parallel_for(cells, cells_per_block, [&](std::size_t first, std::size_t last) {
    for (std::size_t cell = first; cell < last; ++cell)
      std::sort(sorted.begin() + begin[cell], sorted.begin() + begin[cell + 1]);
  });
  return sorted;
}

/// Points of the wanted side, per cell, topmost first; floors are turned upside down.
std::vector<Sample> samples_of(const Cloud& plan, const FloorGrid& grid, LevelSide side,
                               const LevelSurface* floor, double min_clearance, double max_tilt) {
  const float sign = side == LevelSide::ceiling ? 1.0f : -1.0f;
  const auto min_normal = static_cast<float>(std::cos(max_tilt));
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    if (!(-sign * plan.normals[i].z() > min_normal)) continue;
    const Eigen::Vector3f& p = plan.points[i];
    const std::ptrdiff_t cell = grid.find(p.head<2>().cast<double>());
    if (cell < 0) continue;
    const auto c = static_cast<std::size_t>(cell);
    if (floor && double{p.z() - floor->nearest[c]} < min_clearance) continue;
    samples.push_back({static_cast<std::uint32_t>(cell), sign * p.z()});
  }
  return by_cell(samples, grid.size());
}

/// The topmost surface of one column: the first run without a gap that holds two points, else the
/// first; its median.
float top_of_column(const Sample* begin, const Sample* end) {
  const Sample* best_begin = begin;
  const Sample* best_end = begin + 1;
  for (const Sample* from = begin; from != end;) {
    const Sample* to = from + 1;
    while (to != end && (to - 1)->up - to->up < split_gap) ++to;
    if (to - from >= 2) {
      best_begin = from;
      best_end = to;
      break;
    }
    from = to;
  }
  return (best_begin + (best_end - best_begin) / 2)->up;
}

std::vector<float> topmost(const std::vector<Sample>& samples, std::size_t cells) {
  std::vector<float> up(cells, nothing);
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t end = i + 1;
    while (end < samples.size() && samples[end].cell == samples[i].cell) ++end;
    up[samples[i].cell] = top_of_column(&samples[i], samples.data() + end);
    i = end;
  }
  return up;
}

/// Grows patches of cells whose heights differ little and keeps those that are wide enough.
class PatchFilter {
 public:
  PatchFilter(const FloorGrid& grid, const std::vector<float>& up, const LevelSurfaceParams& params)
      : grid_(grid), up_(up), params_(params), visited_(up.size(), 0), kept_(up.size(), nothing) {}

  std::vector<float> run() {
    for (std::size_t seed = 0; seed < up_.size(); ++seed) {
      if (visited_[seed] || std::isnan(up_[seed])) continue;
      grow(seed);
      if (static_cast<double>(patch_.size()) * grid_.cell * grid_.cell >
          params_.min_half_width * params_.min_half_width)
        keep_if_wide();
    }
    return std::move(kept_);
  }

 private:
  void grow(std::size_t seed) {
    constexpr int reach = 2;  // cells; bridges a missing one
    patch_.assign(1, seed);
    visited_[seed] = 1;
    for (std::size_t k = 0; k < patch_.size(); ++k) {
      const std::size_t cell = patch_[k];
      const int column = grid_.column(cell), row = grid_.row(cell);
      for (int y = row - reach; y <= row + reach; ++y)
        for (int x = column - reach; x <= column + reach; ++x) {
          if (!grid_.contains(x, y)) continue;
          const std::size_t next = grid_.index(x, y);
          if (visited_[next] || !(double{std::abs(up_[next] - up_[cell])} < params_.max_step))
            continue;
          visited_[next] = 1;
          patch_.push_back(next);
        }
    }
  }

  void keep_if_wide() {
    int left = grid_.columns, right = 0, bottom = grid_.rows, top = 0;
    for (const std::size_t cell : patch_) {
      left = std::min(left, grid_.column(cell));
      right = std::max(right, grid_.column(cell));
      bottom = std::min(bottom, grid_.row(cell));
      top = std::max(top, grid_.row(cell));
    }
    const int columns = right - left + 1, rows = top - bottom + 1;
    const auto local = [&](std::size_t cell) {
      return static_cast<std::size_t>(grid_.row(cell) - bottom) *
                 static_cast<std::size_t>(columns) +
             static_cast<std::size_t>(grid_.column(cell) - left);
    };
    CellMask mask(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
    std::vector<std::int32_t> source(mask.size(), -1);
    for (const std::size_t cell : patch_) {
      mask[local(cell)] = 1;
      source[local(cell)] = static_cast<std::int32_t>(cell);
    }
    mask = closed(mask, columns, rows, params_.fill_radius / grid_.cell);
    const std::vector<float> inside = distance_to_unset(mask, columns, rows);
    const float widest = *std::max_element(inside.begin(), inside.end());
    if (double{widest} * grid_.cell < params_.min_half_width) return;
    spread_labels(source, mask, columns, rows, 8);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        const std::int32_t from =
            source[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(x)];
        if (from < 0) continue;
        const float value = up_[static_cast<std::size_t>(from)];
        float& slot = kept_[grid_.index(left + x, bottom + y)];
        if (std::isnan(slot) || value > slot) slot = value;
      }
  }

  const FloorGrid& grid_;
  const std::vector<float>& up_;
  const LevelSurfaceParams& params_;
  std::vector<std::uint8_t> visited_;
  std::vector<float> kept_;
  std::vector<std::size_t> patch_;
};

}  // namespace

LevelSurface find_level_surface(const Cloud& plan, const FloorGrid& grid, LevelSide side,
                                const LevelSurface* floor, double min_clearance,
                                const LevelSurfaceParams& params) {
  const std::vector<float> up =
      topmost(samples_of(plan, grid, side, floor, min_clearance, params.max_tilt), grid.size());
  LevelSurface surface;
  surface.height = PatchFilter(grid, up, params).run();
  const float sign = side == LevelSide::ceiling ? 1.0f : -1.0f;
  std::vector<std::int32_t> source(grid.size(), -1);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    surface.height[i] *= sign;
    if (!std::isnan(surface.height[i])) source[i] = static_cast<std::int32_t>(i);
  }
  spread_labels(source, CellMask(grid.size(), 1), grid.columns, grid.rows,
                static_cast<int>(nearest_reach / grid.cell));
  surface.nearest.assign(grid.size(), nothing);
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (source[i] >= 0) surface.nearest[i] = surface.height[static_cast<std::size_t>(source[i])];
  return surface;
}

}  // namespace planum
