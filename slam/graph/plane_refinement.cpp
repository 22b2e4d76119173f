#include "slam/graph/plane_refinement.hpp"

#include <algorithm>
#include <cmath>
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
/// Patches stay as they are while no scan moves more than this much of the gate.
constexpr double same_patches = 0.2;
/// Weights follow the distances for so long.
constexpr int iterations_of_weights = 4;
/// Standard errors; a smaller gain may be chance.
constexpr double least_gain = 2;
/// Distances may be so many times what the noise of the surfels makes before they count as bends.
constexpr double usual_excess = 1.5;
/// Enough to know the median.
constexpr std::size_t one_of_so_many = 4;

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

/// What one scan sees of a patch.
struct ScanPart {
  std::uint32_t scan = 0;
  std::vector<Eigen::Vector3f> points;  ///< m, scanner frame
};

void add(std::vector<ScanPart>& parts, const Surfel& surfel) {
  if (parts.empty() || parts.back().scan != surfel.scan) parts.push_back({surfel.scan, {}});
  parts.back().points.push_back(surfel.point);
}

/// A patch while poses move: the surfels that make its plane, and those held out, which judge it.
struct WorkingPatch {
  Plane plane;  ///< in the world, as the poses are now
  std::vector<ScanPart> makers, judges;
};

WorkingPatch working(const PlanePatch& patch, std::span<const Surfel> surfels) {
  WorkingPatch result{.plane = patch.plane, .makers = {}, .judges = {}};
  for (const std::uint32_t i : patch.surfels)
    add(surfels[i].held_out ? result.judges : result.makers, surfels[i]);
  std::erase_if(result.makers,
                [](const ScanPart& part) { return part.points.size() < least_surfels_of_scan; });
  return result;
}

/// The same plane in the frame of a scan.
Plane seen_from(const Pose& world_from_scan, const Plane& plane) {
  return {world_from_scan.linear().transpose() * plane.normal,
          plane.offset - plane.normal.dot(world_from_scan.translation())};
}

/// m, summed over points.
struct SummedDistance {
  double sum = 0, count = 0;
};

double mean(std::span<const SummedDistance> distances) {
  SummedDistance all;
  for (const SummedDistance& d : distances) all.sum += d.sum, all.count += d.count;
  return all.count > 0 ? all.sum / all.count : 0;
}

/// How much smaller distances are after than before, in standard errors over the patches.
double gain(std::span<const SummedDistance> before, std::span<const SummedDistance> after) {
  double sum = 0, squares = 0;
  for (std::size_t p = 0; p < before.size(); ++p) {
    const double difference = before[p].sum - after[p].sum;
    sum += difference;
    squares += difference * difference;
  }
  return squares > 0 ? sum / std::sqrt(squares) : 0;
}

/// The refinement while it runs. Poses are in the frame of the first scan, so that it does not
/// matter where the world has its origin.
class Refinement {
 public:
  Refinement(std::vector<Pose> poses, std::span<const MatchingScan> scans,
             std::span<const std::size_t> part_of_scan, const PlaneRefinementParams& params)
      : part_of_scan_(part_of_scan),
        params_(params),
        prior_(poses),
        poses_(std::move(poses)),
        surfels_(surfels(scans, params.spacing)),
        seeds_(surest_first(surfels_)) {
    std::vector<double> noises;
    for (const MatchingScan& scan : scans) {
      noises.push_back(std::max(scan.noise, least_noise));
      radius_.push_back(std::max(scan.radius, params.spacing));
    }
    const std::vector<double> noise_of_scan = noises;
    noise_ = upper_median(noises);
    for (const double noise : noise_of_scan)
      weight_of_scan_.push_back(noise_ * noise_ / (noise * noise));
    gate_ = params.gate > 0 ? params.gate : gate_per_noise_of_scans * noise_;
  }

  void run(const Progress& progress, PlaneRefinement& result) {
    find_patches();
    const std::vector<WorkingPatch> first_patches = patches_;
    int rounds = 0;
    while (rounds < params_.max_rounds && !result.converged) {
      if (rounds++ > 0) find_patches();
      const std::vector<Pose> found_at = poses_;
      const bool rests = iterate(progress, result);
      result.converged = rests && farthest(found_at) < same_patches * gate_;
    }
    // Patches of the poses that came favour these, and those of the others the others.
    std::vector<WorkingPatch> both = first_patches;
    if (rounds > 1) both.insert(both.end(), patches_.begin(), patches_.end());
    const double most = limit(fitted_anew(first_patches, prior_), prior_);
    std::vector<SummedDistance> before = judged(both, prior_, most);
    std::vector<SummedDistance> after = judged(both, poses_, most);
    for (std::size_t p = 0; p < both.size(); ++p)
      if (before[p].count == 0 || after[p].count == 0) before[p] = after[p] = {};
    result.thickness_before = mean(before);
    result.thickness_after = mean(after);
    // Distances far above what noise makes are bends of the scans: patches are not independent.
    const double bends =
        std::max(1.0, result.thickness_after / (usual_excess * expected_distance()));
    result.improved = gain(before, after) > least_gain * bends;
  }

  const std::vector<Pose>& poses() const { return poses_; }

  /// m, how far the points of a scan went from where another pose has them, rms.
  double moved(std::size_t scan, const Pose& from) const {
    const Pose motion = from.inverse() * poses_[scan];
    return std::hypot(motion.translation().norm(), rotation_angle(motion) * radius_[scan]);
  }

  /// The same from where it came.
  double moved(std::size_t scan) const { return moved(scan, prior_[scan]); }

 private:
  /// m, mean distance of surfels from their planes that their noise makes.
  double expected_distance() const {
    constexpr double mean_per_deviation = 0.7979;  // of a normal distribution: sqrt(2 / pi)
    double sum = 0;
    for (const Surfel& surfel : surfels_) sum += std::sqrt(surfel.offset_variance);
    return mean_per_deviation * sum /
           static_cast<double>(std::max<std::size_t>(surfels_.size(), 1));
  }

  double farthest(const std::vector<Pose>& from) const {
    double result = 0;
    for (std::size_t i = 0; i < poses_.size(); ++i) result = std::max(result, moved(i, from[i]));
    return result;
  }

  void find_patches() {
    patches_.clear();
    for (const PlanePatch& patch : plane_patches(
             surfels_, seeds_, poses_, part_of_scan_,
             {.radius = params_.patch_radius, .gate = gate_, .max_angle = params_.max_angle})) {
      WorkingPatch one = working(patch, surfels_);
      if (one.makers.size() >= 2) patches_.push_back(std::move(one));
    }
  }

  /// The limit of the biweight from the distances of some surfels from the planes that they make.
  double limit(std::span<const WorkingPatch> patches, std::span<const Pose> poses) const {
    std::vector<double> distances;
    for (const WorkingPatch& patch : patches)
      for (const ScanPart& part : patch.makers) {
        const Plane plane = seen_from(poses[part.scan], patch.plane);
        for (std::size_t k = 0; k < part.points.size(); k += one_of_so_many)
          distances.push_back(std::abs(plane.signed_distance(part.points[k].cast<double>())));
      }
    return distances.empty() ? gate_ : std::clamp(biweight_limit(distances), least_noise, gate_);
  }

  /// The sums over what scans see of a patch, weighted by how well it suits the plane.
  SharedPlane observed(const WorkingPatch& patch, std::span<const Pose> poses, double limit) const {
    SharedPlane result;
    for (const ScanPart& part : patch.makers) {
      const Plane plane = seen_from(poses[part.scan], patch.plane);
      PlaneObservation observation{
          .scan = part.scan, .origin = part.points.front().cast<double>(), .moments = {}};
      std::size_t count = 0;
      for (const Eigen::Vector3f& p : part.points) {
        const Eigen::Vector3d point = p.cast<double>();
        const double weight = biweight(plane.signed_distance(point), limit);
        if (weight == 0) continue;
        observation.moments.add(point - observation.origin, weight_of_scan_[part.scan] * weight);
        ++count;
      }
      if (count >= least_surfels_of_scan) result.push_back(observation);
    }
    return result;
  }

  /// The sums of all patches, and their planes fitted anew to them.
  std::vector<SharedPlane> observed(std::vector<WorkingPatch>& patches, std::span<const Pose> poses,
                                    double limit) const {
    std::vector<SharedPlane> planes(patches.size());
    parallel_for(patches.size(), patches_per_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        planes[p] = observed(patches[p], poses, limit);
        if (const std::optional<PlaneFit> fit = fitted(planes[p], poses))
          patches[p].plane = facing(fit->plane, patches[p].plane.normal);
      }
    });
    return planes;
  }

  std::vector<WorkingPatch> fitted_anew(std::vector<WorkingPatch> patches,
                                        std::span<const Pose> poses) const {
    observed(patches, poses, gate_);
    return patches;
  }

  /// Moves all poses until they rest; false if they do not.
  bool iterate(const Progress& progress, PlaneRefinement& result) {
    const double stiffness = std::pow(std::sin(params_.weak_angle), 2);
    std::vector<SharedPlane> planes;
    std::optional<PlaneSystem> system;
    for (int i = 0; i < params_.max_iterations; ++i) {
      // Weights are held after a while, and with them the sums: points are not looked at again.
      if (i < iterations_of_weights) {
        planes = observed(patches_, poses_, limit(patches_, poses_));
        std::erase_if(planes, [](const SharedPlane& plane) { return plane.size() < 2; });
        if (planes.empty()) return true;
        system.emplace(planes, poses_.size());
      }
      system->linearize(planes, poses_, prior_, radius_, stiffness);
      const std::optional<std::vector<Vector6d>> motions = system->solved();
      progress.report(static_cast<std::size_t>(++result.iterations), 0);
      if (!motions) return false;
      const std::vector<Pose> before = poses_;
      for (std::size_t k = 0; k < poses_.size(); ++k)
        poses_[k] = orthonormalized(exp_se3((*motions)[k]) * poses_[k]);
      result.planes = planes.size();
      result.observations = 0;
      for (const SharedPlane& plane : planes) result.observations += plane.size();
      if (farthest(before) < params_.tolerance * noise_) return true;
    }
    return false;
  }

  /// For each patch how far held-out surfels are from the plane that the others make; nothing where
  /// it is not shared. No surfel counts more than `most`.
  std::vector<SummedDistance> judged(std::vector<WorkingPatch> patches, std::span<const Pose> poses,
                                     double most) const {
    observed(patches, poses, most);
    const std::vector<SharedPlane> planes = observed(patches, poses, most);
    std::vector<SummedDistance> result(patches.size());
    for (std::size_t p = 0; p < patches.size(); ++p) {
      if (planes[p].size() < 2) continue;
      for (const ScanPart& part : patches[p].judges) {
        const Plane plane = seen_from(poses[part.scan], patches[p].plane);
        for (const Eigen::Vector3f& point : part.points)
          result[p].sum += std::min(std::abs(plane.signed_distance(point.cast<double>())), most);
        result[p].count += static_cast<double>(part.points.size());
      }
    }
    return result;
  }

  std::span<const std::size_t> part_of_scan_;
  const PlaneRefinementParams& params_;
  const std::vector<Pose> prior_;
  std::vector<Pose> poses_;
  const std::vector<Surfel> surfels_;
  const std::vector<std::uint32_t> seeds_;
  std::vector<double> weight_of_scan_, radius_;
  double noise_ = 0, gate_ = 0;  ///< m
  std::vector<WorkingPatch> patches_;
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
  if (!result.improved) {
    result.reason =
        fmt::format("planes would be {:.3f} mm thick instead of {:.3f} mm, which may be chance",
                    1000 * result.thickness_after, 1000 * result.thickness_before);
    return result;
  }
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
