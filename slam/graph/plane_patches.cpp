#include "slam/graph/plane_patches.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "slam/core/hash.hpp"
#include "slam/core/parallel.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/reduction.hpp"

namespace planum {
namespace {

constexpr std::size_t surfels_per_block = 4096;
/// A local plane thicker than this many times the noise of its scan spans an edge or clutter.
constexpr double most_thickness = 2.0;
/// m; local planes of lone, far scan lines are larger than a patch should be.
constexpr double most_reach = 0.5;
/// Blocks of surfels that are held out or not as a whole, in spacings.
constexpr double block_spacings = 3;
constexpr std::uint64_t one_in_so_many = 4;
/// rad, how far the plane of a seed may be tilted against that of its patch.
constexpr double seed_tilt = radians(1.5);

std::uint64_t cell_key(const Eigen::Vector3i& cell) {
  std::uint64_t key = 0;
  for (const int c : cell) key = (key << 21) | (static_cast<std::uint32_t>(c) & 0x1FFFFFu);
  return key;
}

Eigen::Vector3i cell_of(const Eigen::Vector3f& p, float edge) {
  return (p / edge).array().floor().cast<int>();
}

std::vector<Surfel> surfels_of(const MatchingScan& scan, std::uint32_t number, double spacing) {
  std::vector<Surfel> result;
  const double noise = std::max(scan.noise, least_noise);
  const auto block = static_cast<float>(block_spacings * spacing);
  for (const std::uint32_t i : voxel_grid(scan.points, spacing).representative) {
    const LocalPlane& plane = scan.planes[i];
    if (!plane.known() || plane.thickness > most_thickness * noise || plane.reach > most_reach)
      continue;
    const bool held_out = mixed(cell_key(cell_of(plane.mean, block))) % one_in_so_many == 0;
    result.push_back({.scan = number,
                      .point = plane.mean,
                      .normal = plane.normal,
                      .tilt_variance = plane.tilt_variance,
                      // An even disc of n points and this reach deviates by reach / 2 sideways.
                      .offset_variance = plane.tilt_variance * plane.reach * plane.reach / 4,
                      .held_out = held_out});
  }
  return result;
}

/// A surfel in the world, with all that is asked about it.
struct Placed {
  Eigen::Vector3f point, normal;
  std::uint32_t number = 0;
  std::uint32_t part = 0;
  bool held_out = false;
};

/// Grows patches one after another; surfels that are in one are taken out of the cells.
class PatchCover {
 public:
  PatchCover(std::span<const Surfel> surfels, std::span<const Pose> world_from_scan,
             std::span<const std::size_t> part_of_scan, const PatchParams& params)
      : params_(params),
        placed_(surfels.size()),
        is_free_(surfels.size(), true),
        may_be_seed_(surfels.size(), true) {
    parallel_for(surfels.size(), surfels_per_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Pose& pose = world_from_scan[surfels[i].scan];
        placed_[i] = {
            (pose * surfels[i].point.cast<double>()).cast<float>(),
            (pose.linear() * surfels[i].normal.cast<double>()).cast<float>(),
            static_cast<std::uint32_t>(i),
            part_of_scan.empty() ? 0 : static_cast<std::uint32_t>(part_of_scan[surfels[i].scan]),
            surfels[i].held_out};
      }
    });
    for (const Placed& p : placed_)
      cells_[cell_key(cell_of(p.point, static_cast<float>(params.radius)))].push_back(p);
  }

  std::vector<PlanePatch> patches(std::span<const std::uint32_t> seeds) {
    std::vector<PlanePatch> result;
    for (const std::uint32_t seed : seeds) {
      if (!is_free_[seed] || !may_be_seed_[seed]) continue;
      std::optional<PlanePatch> patch = grown(seed);
      if (!patch) continue;
      for (const std::uint32_t i : patch->surfels) is_free_[i] = false;
      for (std::vector<Placed>* cell : near_)
        std::erase_if(*cell, [&](const Placed& p) { return !is_free_[p.number]; });
      result.push_back(std::move(*patch));
    }
    return result;
  }

 private:
  /// Free surfels around a seed that face as it does.
  void find_candidates(std::uint32_t seed) {
    const Placed& s = placed_[seed];
    const auto radius = static_cast<float>(params_.radius);
    const auto least_cosine = static_cast<float>(std::cos(params_.max_angle));
    const Eigen::Vector3i centre = cell_of(s.point, radius);
    near_.clear();
    candidates_.clear();
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = cells_.find(cell_key(centre + Eigen::Vector3i(x, y, z)));
          if (found == cells_.end()) continue;
          near_.push_back(&found->second);
          for (const Placed& p : found->second)
            if ((p.point - s.point).squaredNorm() <= radius * radius &&
                p.normal.dot(s.normal) >= least_cosine && p.part == s.part)
              candidates_.push_back(p);
        }
  }

  std::optional<PlanePatch> grown(std::uint32_t seed) {
    find_candidates(seed);
    const Placed& s = placed_[seed];
    const Eigen::Vector3d origin = s.point.cast<double>();
    Plane plane{s.normal.cast<double>(), 0};  // relative to the seed
    double slope = std::tan(seed_tilt);
    const double least_cosine = std::cos(params_.max_angle);
    const auto belongs = [&](const Placed& p) {
      const Eigen::Vector3d q = p.point.cast<double>() - origin;
      return std::abs(plane.signed_distance(q)) <= params_.gate + slope * q.norm() &&
             plane.normal.dot(p.normal.cast<double>()) >= least_cosine;
    };
    for (int pass = 0; pass < 3; ++pass) {
      PointMoments moments;
      for (const Placed& p : candidates_)
        if (!p.held_out && belongs(p)) moments.add(p.point.cast<double>() - origin);
      const std::optional<PlaneFit> fit = fit_plane(moments);
      if (!fit || moments.count < static_cast<double>(params_.least_surfels) ||
          fit->variances[1] < params_.least_width * params_.least_width) {
        give_up(seed, belongs);
        return std::nullopt;
      }
      plane = facing(fit->plane, s.normal.cast<double>());
      slope = 0;
    }
    PlanePatch patch;
    for (const Placed& p : candidates_)
      if (belongs(p)) patch.surfels.push_back(p.number);
    std::sort(patch.surfels.begin(), patch.surfels.end());
    patch.plane = {plane.normal, plane.offset + plane.normal.dot(origin)};
    may_be_seed_[seed] = false;
    return patch;
  }

  /// Where a seed makes no patch, its nearest neighbours on the same plane would not either.
  template <class Belongs>
  void give_up(std::uint32_t seed, const Belongs& belongs) {
    const auto near = static_cast<float>(params_.radius / 3);
    may_be_seed_[seed] = false;
    for (const Placed& p : candidates_)
      if ((p.point - placed_[seed].point).squaredNorm() < near * near && belongs(p))
        may_be_seed_[p.number] = false;
  }

  const PatchParams& params_;
  std::vector<Placed> placed_;
  std::vector<bool> is_free_, may_be_seed_;
  std::unordered_map<std::uint64_t, std::vector<Placed>> cells_;  ///< edges of a radius
  std::vector<std::vector<Placed>*> near_;                        ///< cells around the seed
  std::vector<Placed> candidates_;                                ///< around the seed
};

}  // namespace

std::vector<Surfel> surfels(std::span<const MatchingScan> scans, double spacing) {
  std::vector<std::vector<Surfel>> of_scan(scans.size());
  parallel_for(scans.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      of_scan[i] = surfels_of(scans[i], static_cast<std::uint32_t>(i), spacing);
  });
  std::vector<Surfel> result;
  for (const std::vector<Surfel>& some : of_scan)
    result.insert(result.end(), some.begin(), some.end());
  return result;
}

std::vector<std::uint32_t> surest_first(std::span<const Surfel> surfels) {
  std::vector<std::pair<float, std::uint32_t>> order;
  for (std::uint32_t i = 0; i < surfels.size(); ++i)
    if (!surfels[i].held_out) order.emplace_back(surfels[i].tilt_variance, i);
  // What decides between equal ones is not the order of the scans either.
  const auto rank = [&](const std::pair<float, std::uint32_t>& s) {
    const Eigen::Vector3f& p = surfels[s.second].point;
    return std::tuple(s.first, p.x(), p.y(), p.z(), s.second);
  };
  std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : rank(a) < rank(b);
  });
  std::vector<std::uint32_t> result;
  for (const auto& [variance, i] : order) result.push_back(i);
  return result;
}

std::vector<PlanePatch> plane_patches(std::span<const Surfel> surfels,
                                      std::span<const std::uint32_t> seeds,
                                      std::span<const Pose> world_from_scan,
                                      std::span<const std::size_t> part_of_scan,
                                      const PatchParams& params) {
  return PatchCover(surfels, world_from_scan, part_of_scan, params).patches(seeds);
}

}  // namespace planum
