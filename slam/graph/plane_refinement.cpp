#include "slam/graph/plane_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/robust.hpp"
#include "slam/graph/plane_equations.hpp"
#include "slam/graph/plane_patches.hpp"
#include "slam/registration/icp.hpp"

namespace planum {
namespace {

constexpr std::size_t patches_per_block = 64;
constexpr double gate_per_noise_of_scans = 3;
/// An observation of a plane by fewer surfels says nothing.
constexpr std::size_t least_surfels_of_scan = 4;
/// Patches so many times as thick as the median are not flat.
constexpr double most_thickness_ratio = 3;

double env(const char* name, double value) {
  const char* text = std::getenv(name);
  return text ? std::atof(text) : value;
}

void check(std::span<const Pose> poses, std::span<const MatchingScan> scans,
           std::span<const std::size_t> part_of_scan, const PlaneRefinementParams& params) {
  const auto require = [](bool good, const char* option, auto value, const char* limit) {
    if (!good)
      throw Error(fmt::format("plane refinement: {} must be {}, got {}", option, limit, value));
  };
  require(poses.size() == scans.size(), "the number of poses", poses.size(), "that of the scans");
  require(part_of_scan.empty() || part_of_scan.size() == scans.size(), "the number of parts",
          part_of_scan.size(), "that of the scans, or 0");
  require(params.spacing > 0 && std::isfinite(params.spacing), "spacing", params.spacing, "> 0 m");
  require(params.patch_radius > 2 * params.spacing && std::isfinite(params.patch_radius),
          "patch_radius", params.patch_radius, "more than two spacings");
  require(params.gate >= 0 && std::isfinite(params.gate), "gate", params.gate, ">= 0 m");
  require(params.max_angle > 0 && params.max_angle < pi / 2, "max_angle", degrees(params.max_angle),
          "between 0 and 90 deg");
  require(params.weak_angle > 0 && params.weak_angle < pi / 2, "weak_angle",
          degrees(params.weak_angle), "between 0 and 90 deg");
  require(params.max_rounds > 0, "max_rounds", params.max_rounds, "> 0");
  require(params.max_iterations > 0, "max_iterations", params.max_iterations, "> 0");
  require(params.tolerance > 0, "tolerance", params.tolerance, "> 0");
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (!poses[i].matrix().allFinite())
      throw Error(fmt::format("plane refinement: pose {} is not finite", i));
}

/// The surfels of one scan in a patch: [begin, end) of its list.
struct Range {
  std::uint32_t scan;
  std::size_t begin, end;
};

std::vector<Range> by_scan(const PlanePatch& patch, std::span<const Surfel> surfels) {
  std::vector<Range> result;
  for (std::size_t k = 0; k < patch.surfels.size(); ++k) {
    const std::uint32_t scan = surfels[patch.surfels[k]].scan;
    if (result.empty() || result.back().scan != scan) result.push_back({scan, k, k});
    result.back().end = k + 1;
  }
  return result;
}

struct Thickness {
  double squared = 0;  ///< m^2, sum
  std::size_t count = 0;

  double rms() const { return count > 0 ? std::sqrt(squared / static_cast<double>(count)) : 0; }
};

/// The refinement while it runs. Poses are in the frame of the first scan, so that it does not
/// matter where the world has its origin.
class Refinement {
 public:
  Refinement(std::vector<Pose> poses, std::span<const MatchingScan> scans,
             std::span<const std::size_t> part_of_scan, const PlaneRefinementParams& params)
      : scans_(scans),
        part_of_scan_(part_of_scan),
        params_(params),
        prior_(poses),
        poses_(std::move(poses)),
        surfels_(surfels(scans, params.spacing)) {
    std::vector<double> noises;
    for (const MatchingScan& scan : scans) {
      noise_of_scan_.push_back(std::max(scan.noise, least_noise));
      radius_.push_back(std::max(scan.radius, params.spacing));
      if (scan.noise > 0) noises.push_back(noise_of_scan_.back());
    }
    noise_ = noises.empty() ? least_noise : upper_median(noises);
    gate_ = params.gate > 0 ? params.gate : gate_per_noise_of_scans * noise_;
    for (const double noise : noise_of_scan_)
      weight_of_scan_.push_back(noise_ * noise_ / (noise * noise));
  }

  void run(const Progress& progress, PlaneRefinement& result) {
    find_patches();
    const std::vector<PlanePatch> first_patches = patches_;
    const double most = limit(observed_once(first_patches, prior_), prior_);
    result.thickness_before = thickness(first_patches, prior_, most).rms();
    for (int round = 0; round < params_.max_rounds && !result.converged; ++round) {
      if (round > 0) find_patches();
      if (patches_.empty()) break;
      result.converged = iterate(progress, result) <= 1;
    }
    result.thickness_after = thickness(first_patches, poses_, most).rms();
  }

  const std::vector<Pose>& poses() const { return poses_; }

  /// m, how far the points of a scan went, rms.
  double moved(std::size_t scan) const {
    const Pose motion = prior_[scan].inverse() * poses_[scan];
    return std::hypot(motion.translation().norm(), rotation_angle(motion) * radius_[scan]);
  }

 private:
  void find_patches() {
    patches_ = plane_patches(
        surfels_, poses_, part_of_scan_,
        {.radius = params_.patch_radius, .gate = gate_, .max_angle = params_.max_angle});
    std::erase_if(patches_,
                  [&](const PlanePatch& patch) { return by_scan(patch, surfels_).size() < 2; });
  }

  Eigen::Vector3d in_world(std::uint32_t surfel, std::span<const Pose> poses) const {
    return poses[surfels_[surfel].scan] * surfels_[surfel].point.cast<double>();
  }

  /// The limit of the biweight from the distances of all surfels from the planes of their patches.
  double limit(std::span<const PlanePatch> patches, std::span<const Pose> poses) const {
    std::vector<double> distances;
    for (const PlanePatch& patch : patches)
      for (const std::uint32_t i : patch.surfels)
        if (!surfels_[i].held_out)
          distances.push_back(std::abs(patch.plane.signed_distance(in_world(i, poses))));
    if (distances.empty()) return gate_;
    return std::clamp(biweight_limit(distances), least_noise, gate_);
  }

  /// The sums over the surfels of a patch, held-out ones left out, weighted by how well they suit
  /// its plane. Empty if fewer than two scans see it.
  SharedPlane observed(const PlanePatch& patch, std::span<const Pose> poses, double limit) const {
    const double n0 = env("N0", 0);
    SharedPlane result;
    for (const Range& range : by_scan(patch, surfels_)) {
      PlaneObservation observation{.scan = range.scan, .moments = {}};
      std::size_t count = 0;
      for (std::size_t k = range.begin; k < range.end; ++k) {
        const std::uint32_t i = patch.surfels[k];
        if (surfels_[i].held_out) continue;
        const double weight = weight_of_scan_[range.scan] *
                              biweight(patch.plane.signed_distance(in_world(i, poses)), limit);
        if (weight == 0) continue;
        const Eigen::Vector3d point = surfels_[i].point.cast<double>();
        if (count++ == 0) observation.origin = point;
        observation.moments.add(point - observation.origin, weight);
      }
      if (n0 > 0 && count > 0) {
        const double f = n0 / (n0 + static_cast<double>(count));
        observation.moments.count *= f;
        observation.moments.sum *= f;
        observation.moments.squares *= f;
      }
      if (count >= least_surfels_of_scan) result.push_back(observation);
    }
    return result;
  }

  /// Weighted sums of all patches, and their planes fitted anew.
  std::vector<SharedPlane> observed(std::vector<PlanePatch>& patches,
                                    std::span<const Pose> poses) const {
    const double most = limit(patches, poses);
    std::vector<SharedPlane> planes(patches.size());
    parallel_for(patches.size(), patches_per_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        planes[p] = observed(patches[p], poses, most);
        if (const std::optional<PlaneFit> fit = fitted(planes[p], poses))
          patches[p].plane = facing(fit->plane, patches[p].plane.normal);
        else
          planes[p].clear();
      }
    });
    return planes;
  }

  /// Moves all poses until they rest; how often it took.
  int iterate(const Progress& progress, PlaneRefinement& result) {
    for (int i = 1; i <= params_.max_iterations; ++i) {
      std::vector<SharedPlane> planes = observed(patches_, poses_);
      std::erase_if(planes, [](const SharedPlane& plane) { return plane.size() < 2; });
      result.planes = planes.size();
      result.observations = 0;
      for (const SharedPlane& plane : planes) result.observations += plane.size();
      PlaneSystem system(planes, poses_.size());
      system.linearize(planes, poses_, prior_, radius_, std::pow(std::sin(params_.weak_angle), 2));
      const std::optional<std::vector<Vector6d>> motions = system.solved();
      progress.report(static_cast<std::size_t>(++result.iterations), 0);
      if (!motions) return i;
      if (move(*motions) < params_.tolerance * noise_) return i;
    }
    return params_.max_iterations + 1;
  }

  /// m, how far the points of the scan that moved most went, rms.
  double move(const std::vector<Vector6d>& motions) {
    double largest = 0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Pose moved = orthonormalized(exp_se3(motions[i]) * poses_[i]);
      largest = std::max(largest, std::hypot((moved.translation() - poses_[i].translation()).norm(),
                                             motions[i].tail<3>().norm() * radius_[i]));
      poses_[i] = moved;
    }
    return largest;
  }

  /// How far held-out surfels are from the planes that the others make of their patches.
  std::vector<PlanePatch> observed_once(std::vector<PlanePatch> patches, std::span<const Pose> poses) const {
    observed(patches, poses);
    return patches;
  }

  Thickness thickness(std::vector<PlanePatch> patches, std::span<const Pose> poses, double most) const {
    Thickness result;
    for (int pass = 0; pass < 2; ++pass) observed(patches, poses);
    const std::vector<SharedPlane> planes = observed(patches, poses);
    for (std::size_t p = 0; p < patches.size(); ++p) {
      if (planes[p].size() < 2) continue;
      for (const std::uint32_t i : patches[p].surfels) {
        if (!surfels_[i].held_out) continue;
        const double distance = patches[p].plane.signed_distance(in_world(i, poses));
        result.squared += std::min(distance * distance, most * most);
        ++result.count;
      }
    }
    return result;
  }

  std::span<const MatchingScan> scans_;
  std::span<const std::size_t> part_of_scan_;
  const PlaneRefinementParams& params_;
  const std::vector<Pose> prior_;
  std::vector<Pose> poses_;
  std::vector<Surfel> surfels_;
  std::vector<double> noise_of_scan_, weight_of_scan_, radius_;
  double noise_ = 0, gate_ = 0;
  std::vector<PlanePatch> patches_;
};

}  // namespace

PlaneRefinement refine_planes(std::span<const Pose> world_from_scan,
                              std::span<const MatchingScan> scans,
                              std::span<const std::size_t> part_of_scan,
                              const PlaneRefinementParams& params, const Progress& progress) {
  check(world_from_scan, scans, part_of_scan, params);
  PlaneRefinement result{.poses = {world_from_scan.begin(), world_from_scan.end()}};
  if (scans.empty()) {
    result.converged = true;
    result.reason = "there are no scans";
    return result;
  }
  const Pose world_from_first = world_from_scan.front(),
             first_from_world = world_from_first.inverse();
  std::vector<Pose> poses;
  for (const Pose& pose : world_from_scan) poses.push_back(first_from_world * pose);
  Refinement refinement(std::move(poses), scans, part_of_scan, params);
  refinement.run(progress, result);
  if (result.planes == 0) {
    result.converged = true;
    result.reason = "no planes are shared";
    return result;
  }
  if (env("GUARD", 1) > 0 && !(result.thickness_after < result.thickness_before)) {
    result.reason = fmt::format("planes would be {:.3f} mm thick instead of {:.3f} mm",
                                1000 * result.thickness_after, 1000 * result.thickness_before);
    return result;
  }
  result.improved = true;
  double squared = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    result.poses[i] = orthonormalized(world_from_first * refinement.poses()[i]);
    const double moved = refinement.moved(i);
    squared += moved * moved;
    result.moved_most = std::max(result.moved_most, moved);
  }
  result.moved_rms = std::sqrt(squared / static_cast<double>(scans.size()));
  return result;
}

}  // namespace planum
