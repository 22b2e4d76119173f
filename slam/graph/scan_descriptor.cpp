#include "slam/graph/scan_descriptor.hpp"

#include <algorithm>
#include <cmath>

#include <flann/flann.hpp>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/graph/scan_plan.hpp"

namespace planum {
namespace {

constexpr float least_parallel = 0.97f;  ///< cosine of 14 degrees
constexpr float most_wall_tilt = 0.3f;   ///< sine of a wall's normal against the horizontal

struct Surface {
  Eigen::Vector3f point, normal;  ///< levelled
  bool is_wall() const { return std::abs(normal.z()) < most_wall_tilt; }
  bool is_level() const { return std::abs(normal.z()) > least_parallel; }
};

/// A part of a descriptor: a histogram whose entries are shared between the two nearest bins.
class Histogram {
 public:
  Histogram(float* bins, std::size_t size, float width) : bins_(bins), size_(size), width_(width) {}

  void add(float value, float weight = 1) {
    const float place = value / width_ - 0.5f;
    const float low = std::floor(place);
    add_to(static_cast<std::ptrdiff_t>(low), weight * (low + 1 - place));
    add_to(static_cast<std::ptrdiff_t>(low) + 1, weight * (place - low));
  }

  /// Square roots of shares (Hellinger): many entries of one kind do not drown the others.
  void finish(float length) {
    float sum = 0;
    for (std::size_t i = 0; i < size_; ++i) sum += bins_[i];
    if (sum <= 0) return;
    for (std::size_t i = 0; i < size_; ++i) bins_[i] = length * std::sqrt(bins_[i] / sum);
  }

 private:
  void add_to(std::ptrdiff_t bin, float weight) {
    if (bin >= 0 && bin < static_cast<std::ptrdiff_t>(size_)) bins_[bin] += weight;
  }

  float* bins_;
  std::size_t size_;
  float width_;
};

/// The height of the largest surface that faces up.
float floor_height(const std::vector<Surface>& surfaces) {
  std::vector<float> heights;
  for (const Surface& s : surfaces)
    if (s.normal.z() > least_parallel) heights.push_back(s.point.z());
  std::sort(heights.begin(), heights.end());
  constexpr float thick = 0.1f;
  float best = 0;
  std::size_t most = 0;
  for (std::size_t low = 0, high = 0; low < heights.size(); ++low) {
    while (high < heights.size() && heights[high] < heights[low] + thick) ++high;
    if (high - low <= most) continue;
    most = high - low;
    best = heights[low + (high - low) / 2];
  }
  return best;
}

}  // namespace

ScanDescriptor scan_descriptor(const MatchingScan& scan, const ScanDescriptorParams& params) {
  if (params.samples < 2)
    throw Error(fmt::format("scan descriptor: samples must be >= 2, got {}", params.samples));
  const Eigen::Matrix3f level = level_from_scan(scan).cast<float>();
  std::vector<Surface> surfaces;
  for (const std::uint32_t i : scan.selection(params.samples))
    if (scan.planes[i].known())
      surfaces.push_back({level * scan.smoothed(i), level * scan.planes[i].normal});
  ScanDescriptor result;
  float* next = result.values.data();
  const auto part = [&](std::size_t size, float width) {
    Histogram histogram(next, size, width);
    next += size;
    return histogram;
  };
  Histogram across = part(ScanDescriptor::across, 0.2f),
            beside = part(ScanDescriptor::beside, 0.2f);
  Histogram up = part(ScanDescriptor::heights, 0.1f), down = part(ScanDescriptor::heights, 0.1f);
  std::array<Histogram, 3> ranges = {part(ScanDescriptor::ranges, 0.5f),
                                     part(ScanDescriptor::ranges, 0.5f),
                                     part(ScanDescriptor::ranges, 0.5f)};
  const float floor = floor_height(surfaces);
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const Surface& a = surfaces[i];
    if (a.is_level()) (a.normal.z() > 0 ? up : down).add(a.point.z() - floor + 0.5f);
    for (std::size_t k = i + 1; k < surfaces.size(); ++k) {
      const Surface& b = surfaces[k];
      const Eigen::Vector3f between = b.point - a.point;
      const float cosine = a.normal.dot(b.normal);
      ranges[cosine > 0.5f ? 0 : cosine > -0.5f ? 1 : 2].add(between.norm());
      if (!a.is_wall() || !b.is_wall() || std::abs(cosine) < least_parallel) continue;
      const float apart = std::abs(a.normal.dot(between));
      if (cosine < 0)
        across.add(apart);
      else if (apart > 0.15f)
        beside.add(apart);
    }
  }
  across.finish(1);
  beside.finish(0.7f);
  up.finish(0.7f);
  down.finish(1);
  for (Histogram& histogram : ranges) histogram.finish(0.5f);
  return result;
}

std::vector<std::vector<SimilarScan>> similar_scans(std::span<const ScanDescriptor> descriptors,
                                                    std::size_t count) {
  std::vector<std::vector<SimilarScan>> result(descriptors.size());
  count = std::min(count, descriptors.empty() ? 0 : descriptors.size() - 1);
  if (count == 0) return result;
  std::vector<float> values;
  for (const ScanDescriptor& d : descriptors)
    values.insert(values.end(), d.values.begin(), d.values.end());
  const flann::Matrix<float> matrix(values.data(), descriptors.size(), ScanDescriptor::size);
  flann::KDTreeSingleIndex<flann::L2<float>> tree(matrix, flann::KDTreeSingleIndexParams(10));
  tree.buildIndex();
  const std::size_t asked = count + 1;  // each one finds itself
  parallel_for(descriptors.size(), 16, [&](std::size_t begin, std::size_t end) {
    std::vector<int> indices(asked);
    std::vector<float> squared(asked);
    for (std::size_t i = begin; i < end; ++i) {
      flann::Matrix<int> index_row(indices.data(), 1, asked);
      flann::Matrix<float> distance_row(squared.data(), 1, asked);
      flann::SearchParams search(flann::FLANN_CHECKS_UNLIMITED);
      search.cores = 1;
      tree.knnSearch(
          flann::Matrix<float>(values.data() + i * ScanDescriptor::size, 1, ScanDescriptor::size),
          index_row, distance_row, asked, search);
      for (std::size_t k = 0; k < asked && result[i].size() < count; ++k)
        if (const auto other = static_cast<std::size_t>(indices[k]); other != i)
          result[i].push_back({other, std::sqrt(static_cast<double>(squared[k]))});
    }
  });
  return result;
}

}  // namespace planum
