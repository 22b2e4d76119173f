#include "meshing/up_direction.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t normals_per_task = 1 << 15;

/// Directions collected in small bins: a few thousand bins stand for millions of normals.
struct Bin {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weight = 0;
  Eigen::Vector3d mean() const { return sum.normalized(); }
};

/// Bins over the sphere, seen as the faces of a cube with side x side squares.
class DirectionBins {
 public:
  DirectionBins() : bins_(6 * side * side) {}

  void add(const Eigen::Vector3d& direction, double weight) {
    Eigen::Index axis;
    const double length = direction.cwiseAbs().maxCoeff(&axis);
    const auto place = [&](Eigen::Index k) {
      const double at = direction[k] / length;  // -1 to 1
      return std::clamp(int((at + 1) / 2 * side), 0, side - 1);
    };
    const int face = int(axis) * 2 + (direction[axis] < 0);
    Bin& bin =
        bins_[std::size_t((face * side + place((axis + 1) % 3)) * side + place((axis + 2) % 3))];
    bin.sum += weight * direction;
    bin.weight += weight;
  }
  void add(const DirectionBins& other) {
    for (std::size_t k = 0; k < bins_.size(); ++k) {
      bins_[k].sum += other.bins_[k].sum;
      bins_[k].weight += other.bins_[k].weight;
    }
  }
  std::vector<Bin> filled() const {
    std::vector<Bin> result;
    for (const Bin& bin : bins_)
      if (bin.weight > 0) result.push_back(bin);
    return result;
  }

 private:
  static constexpr int side = 90;  // about a degree
  std::vector<Bin> bins_;
};

/// All normals in bins. The sums do not depend on the number of threads.
std::vector<Bin> binned(std::span<const Eigen::Vector3f> normals, std::span<const float> weights) {
  constexpr std::size_t parts = 16;
  const std::size_t part_size = std::max(normals_per_task, (normals.size() + parts - 1) / parts);
  std::vector<DirectionBins> some((normals.size() + part_size - 1) / part_size);
  parallel_for(normals.size(), part_size, [&](std::size_t begin, std::size_t end) {
    DirectionBins& bins = some[begin / part_size];
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d normal = normals[i].cast<double>();
      const double weight = weights.empty() ? 1.0 : double(weights[i]);
      if (normal.allFinite() && normal.squaredNorm() > 0.25 && weight > 0)
        bins.add(normal.normalized(), weight);
    }
  });
  DirectionBins all;
  for (const DirectionBins& bins : some) all.add(bins);
  return all.filled();
}

/// Weight that is parallel to a direction (either way), and that is at right angles to it.
struct Support {
  double parallel = 0, upright = 0;
};

Support support_of(const std::vector<Bin>& bins, const Eigen::Vector3d& direction, double spread) {
  Support support;
  const double least = std::cos(spread), most = std::sin(spread);
  for (const Bin& bin : bins) {
    const double cosine = std::abs(bin.mean().dot(direction));
    if (cosine > least) support.parallel += bin.weight;
    if (cosine < most) support.upright += bin.weight;
  }
  return support;
}

/// The weight that fits to a direction as up. Upright things count only as far as there is
/// something they stand on, else any direction along a wall would do.
double fitting(const Support& support) {
  return support.parallel + std::min(support.upright, 2 * support.parallel);
}

/// Far from the prior, more must speak for a direction.
double score(const Support& support, const Eigen::Vector3d& direction,
             const Eigen::Vector3d& prior) {
  const double cosine = direction.dot(prior);
  return cosine * cosine * fitting(support);
}

/// The heaviest bins near the prior, pointing its way.
std::vector<Bin> candidates_near(std::vector<Bin> bins, const Eigen::Vector3d& prior,
                                 double max_tilt) {
  constexpr std::size_t most = 500;
  std::erase_if(
      bins, [&](const Bin& bin) { return std::abs(bin.mean().dot(prior)) < std::cos(max_tilt); });
  std::stable_sort(bins.begin(), bins.end(),
                   [](const Bin& a, const Bin& b) { return a.weight > b.weight; });
  if (bins.size() > most) bins.resize(most);
  for (Bin& bin : bins)
    if (bin.sum.dot(prior) < 0) bin.sum = -bin.sum;
  return bins;
}

/// The candidate with the best score that is not near `other`.
std::optional<Eigen::Vector3d> best_direction(const std::vector<Bin>& bins,
                                              const std::vector<Bin>& candidates,
                                              const Eigen::Vector3d& prior, double spread,
                                              const std::optional<Eigen::Vector3d>& other) {
  std::optional<Eigen::Vector3d> best;
  double best_score = 0;
  for (const Bin& candidate : candidates) {
    const Eigen::Vector3d direction = candidate.mean();
    if (other && direction.dot(*other) > std::cos(4 * spread)) continue;
    const double value = score(support_of(bins, direction, spread), direction, prior);
    if (value > best_score) best_score = value, best = direction;
  }
  return best;
}

/// The mean direction of the normals near `start`, with weights that fall off smoothly (Tukey), so
/// that what is not quite parallel does not pull.
Eigen::Vector3d refined(std::span<const Eigen::Vector3f> normals, std::span<const float> weights,
                        Eigen::Vector3d start, double spread) {
  constexpr int rounds = 10;
  const std::size_t tasks = (normals.size() + normals_per_task - 1) / normals_per_task;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Eigen::Vector3d> sums(tasks, Eigen::Vector3d::Zero());
    parallel_for(normals.size(), normals_per_task, [&](std::size_t begin, std::size_t end) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t i = begin; i < end; ++i) {
        Eigen::Vector3d normal = normals[i].cast<double>();
        if (normal.dot(start) < 0) normal = -normal;
        const double squared = normal.cross(start).squaredNorm() / (spread * spread);
        const double weight = weights.empty() ? 1.0 : double(weights[i]);
        if (squared < 1 && normal.dot(start) > 0.5 && weight > 0)
          sum += weight * (1 - squared) * (1 - squared) * normal;
      }
      sums[begin / normals_per_task] = sum;
    });
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& part : sums) sum += part;
    if (sum.squaredNorm() == 0) return start;
    const double moved = (sum.normalized() - start).norm();
    start = sum.normalized();
    if (moved < 1e-7) break;
  }
  return start;
}

}  // namespace

std::optional<UpDirection> estimate_up(std::span<const Eigen::Vector3f> normals,
                                       std::span<const float> weights, const Eigen::Vector3d& prior,
                                       const UpParams& params) {
  if (!weights.empty() && weights.size() != normals.size())
    throw Error("up direction: " + std::to_string(normals.size()) + " normals, but " +
                std::to_string(weights.size()) + " weights");
  if (!(prior.norm() > 0)) throw Error("up direction: the prior has no direction");
  const std::vector<Bin> bins = binned(normals, weights);
  double total = 0;
  for (const Bin& bin : bins) total += bin.weight;
  const Eigen::Vector3d toward = prior.normalized();
  const auto candidates = candidates_near(bins, toward, params.max_tilt);
  const auto best = best_direction(bins, candidates, toward, params.spread, std::nullopt);
  if (!best) return std::nullopt;
  UpDirection result;
  result.up = refined(normals, weights, *best, 2 * params.spread);
  const Support support = support_of(bins, result.up, params.spread);
  result.share = support.parallel / total;
  if (result.share < params.min_share) return std::nullopt;
  double rival = 0;
  if (const auto second = best_direction(bins, candidates, toward, params.spread, *best))
    rival = score(support_of(bins, *second, params.spread), *second, toward);
  const double own = score(support, result.up, toward);
  result.confidence = std::clamp(fitting(support) / total * (1 - rival / own), 0.0, 1.0);
  return result;
}

}  // namespace planum
