#include "meshing/range_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float unseen = 0;

/// Pixels of a face of the finest map, about 0.7 degrees each; coarser ones have half as many.
constexpr int most_pixels = 128, least_pixels = 32;
/// Of the nine pixels around a direction so many must have returns.
constexpr int least_returns = 5;
/// A map is fine enough if the nine pixels around a return have so many on average.
constexpr double usual_returns = 6;
/// Maps that are held at a time.
constexpr std::size_t maps_at_once = 32;

bool is_flat(const Eigen::Vector3f& normal, const Eigen::Vector3f& way, float range,
             double max_tilt) {
  return !normal.isZero(0) &&
         std::abs(normal.dot(way)) < static_cast<float>(std::cos(max_tilt)) * range;
}

float margin_at(float range, const SightParams& params) {
  return static_cast<float>(params.margin + params.margin_per_metre * range);
}

/// For each scan the positions of its points.
std::vector<std::vector<std::uint32_t>> points_of_scans(const Cloud& cloud, std::size_t scans) {
  std::vector<std::vector<std::uint32_t>> result(scans);
  if (cloud.scan.empty() && scans == 1) {
    result.front().resize(cloud.points.size());
    std::iota(result.front().begin(), result.front().end(), 0u);
  }
  for (std::uint32_t i = 0; i < cloud.scan.size(); ++i) result[cloud.scan[i]].push_back(i);
  return result;
}

}  // namespace

RangeMap::Pixel RangeMap::pixel_of(const Eigen::Vector3f& direction, int pixels) {
  int axis = 0;
  const Eigen::Vector3f size = direction.cwiseAbs();
  size.maxCoeff(&axis);
  const float scale = 0.5f * static_cast<float>(pixels) / size[axis];
  const auto place = [&](float along) {
    const int at = static_cast<int>(along * scale + 0.5f * static_cast<float>(pixels));
    return std::clamp(at, 0, pixels - 1);
  };
  return {2 * axis + (direction[axis] > 0), place(direction[(axis + 1) % 3]),
          place(direction[(axis + 2) % 3])};
}

RangeMap::RangeMap(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> own,
                   const Eigen::Vector3d& origin)
    : origin_(origin.cast<float>()) {
  for (pixels_ = most_pixels;; pixels_ /= 2) {
    fill(points, own);
    if (widen() >= usual_returns || pixels_ == least_pixels) return;
  }
}

bool RangeMap::looks_through(const Eigen::Vector3f& place, const Eigen::Vector3f& normal,
                             const SightParams& params) const {
  const Eigen::Vector3f way = place - origin_;
  const float squared = way.squaredNorm();
  if (squared >= farthest_ * farthest_ || squared == 0) return false;
  const float free = widened_[at(pixel_of(way, pixels_))], range = std::sqrt(squared);
  if (free == unseen || free <= range + margin_at(range, params)) return false;
  return !is_flat(normal, way, range, params.max_tilt);
}

Sight RangeMap::sight(const Eigen::Vector3f& place, const Eigen::Vector3f& normal,
                      const SightParams& params) const {
  const Eigen::Vector3f way = place - origin_;
  const float range = way.norm(), height = std::abs(normal.dot(way));
  if (range == 0 || height == 0 || range > farthest_) return Sight::nothing;
  const Pixel pixel = pixel_of(way, pixels_);
  const float nearest = nearest_[at(pixel)];
  if (nearest == infinite) return is_empty_around(pixel) ? Sight::lost : Sight::nothing;
  // Along a surface that is seen at a flat angle, ranges within one pixel differ.
  const float width = 2 * range / static_cast<float>(pixels_);
  const float margin = margin_at(range, params) + width * range / height;
  if (nearest < range - margin) return Sight::before;
  if (is_flat(normal, way, range, params.max_tilt)) return Sight::nothing;
  return nearest > range + margin ? Sight::through : Sight::at;
}

bool RangeMap::is_empty_around(const Pixel& p) const {
  for (int r = std::max(p.row - 1, 0); r <= std::min(p.row + 1, pixels_ - 1); ++r)
    for (int c = std::max(p.column - 1, 0); c <= std::min(p.column + 1, pixels_ - 1); ++c)
      if (nearest_[at({p.face, r, c})] < infinite) return false;
  return true;
}

std::size_t RangeMap::at(const Pixel& p) const {
  return static_cast<std::size_t>((p.face * pixels_ + p.row) * pixels_ + p.column);
}

/// The nearest return of each pixel.
void RangeMap::fill(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> own) {
  nearest_.assign(static_cast<std::size_t>(6 * pixels_ * pixels_), infinite);
  farthest_ = 0;
  for (const std::uint32_t i : own) {
    const Eigen::Vector3f way = points[i] - origin_;
    const float range = way.norm();
    if (!(range > 0)) continue;
    float& nearest = nearest_[at(pixel_of(way, pixels_))];
    nearest = std::min(nearest, range);
    farthest_ = std::max(farthest_, range);
  }
}

/// Gives each pixel the nearest return of the nine around it; at the rims of faces, where not all
/// nine are at hand, nothing is known. Returns how many returns these have on average.
double RangeMap::widen() {
  widened_.assign(nearest_.size(), unseen);
  std::size_t returns = 0, centres = 0;
  for (int face = 0; face < 6; ++face)
    for (int row = 1; row + 1 < pixels_; ++row)
      for (int column = 1; column + 1 < pixels_; ++column) {
        float nearest = infinite;
        int count = 0;
        for (int r = row - 1; r <= row + 1; ++r)
          for (int c = column - 1; c <= column + 1; ++c) {
            const float range = nearest_[at({face, r, c})];
            nearest = std::min(nearest, range);
            count += range < infinite;
          }
        const std::size_t here = at({face, row, column});
        if (count >= least_returns) widened_[here] = nearest;
        if (nearest_[here] == infinite) continue;
        returns += static_cast<std::size_t>(count);
        ++centres;
      }
  return centres == 0 ? 0 : static_cast<double>(returns) / static_cast<double>(centres);
}

void visit_range_maps(const Cloud& cloud, std::span<const Eigen::Vector3d> origins,
                      const std::function<void(std::span<const RangeMap>)>& visit) {
  const auto own = points_of_scans(cloud, origins.size());
  for (std::size_t first = 0; first < origins.size(); first += maps_at_once) {
    std::vector<RangeMap> maps(std::min(maps_at_once, origins.size() - first));
    parallel_for(maps.size(), 1, [&](std::size_t k, std::size_t) {
      maps[k] = RangeMap(cloud.points, own[first + k], origins[first + k]);
    });
    visit(maps);
  }
}

}  // namespace planum
