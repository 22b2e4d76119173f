#include "slam/graph/loop_consistency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "slam/core/parallel.hpp"
#include "slam/graph/path_covariance.hpp"

namespace planum {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

using Covariances = std::vector<std::optional<Matrix6d>>;

/// Covariances along the paths from every scan where a loop begins or ends.
std::map<std::size_t, Covariances> paths_from_ends(const PoseGraph& graph,
                                                   std::span<const Edge> loops,
                                                   const Matrix6d& step_noise) {
  std::map<std::size_t, Covariances> result;
  for (const Edge& loop : loops) result[loop.from], result[loop.to];
  std::vector<std::size_t> starts;
  for (const auto& [start, covariances] : result) starts.push_back(start);
  const PathCovariances paths(graph, step_noise);
  parallel_for(starts.size(), 1,
               [&](std::size_t k, std::size_t) { result.at(starts[k]) = paths.from(starts[k]); });
  return result;
}

class Cycles {
 public:
  Cycles(const PoseGraph& graph, std::span<const Edge> loops, std::span<const Matrix6d> covariances,
         const Matrix6d& step_noise)
      : graph_(graph),
        loops_(loops),
        covariances_(covariances),
        paths_(paths_from_ends(graph, loops, step_noise)) {}

  /// Standard deviations by which the cycle k.from, k.to, l.to, l.from, k.from fails to close; zero
  /// if no path joins them.
  double deviation(std::size_t k, std::size_t l) const {
    const Edge &first = loops_[k], &second = loops_[l];
    const auto& forth = paths_.at(first.to)[second.to];
    const auto& back = paths_.at(second.from)[first.from];
    if (!forth || !back) return 0;
    const Pose out = graph_.poses[first.to].inverse() * graph_.poses[second.to];
    const Pose home = graph_.poses[second.from].inverse() * graph_.poses[first.from];
    // Each error moved to the end of the cycle: X exp(e) Y == X Y exp(adjoint(Y^-1) e).
    const Pose after_second = second.from_from_to.inverse() * home;
    const Pose after_first = out * after_second;
    const Vector6d error = log_se3(first.from_from_to * after_first);
    const auto moved = [](const Matrix6d& covariance, const Pose& after) -> Matrix6d {
      const Matrix6d to_end = adjoint(after.inverse());
      return to_end * covariance * to_end.transpose();
    };
    const Matrix6d covariance = moved(covariances_[k], after_first) + moved(*forth, after_second) +
                                moved(covariances_[l], after_second) + *back;
    return planum::deviation(error, covariance);
  }

 private:
  const PoseGraph& graph_;
  std::span<const Edge> loops_;
  std::span<const Matrix6d> covariances_;
  std::map<std::size_t, Covariances> paths_;
};

/// Deviations of all pairs; infinite where they contradict.
using Table = std::vector<std::vector<double>>;

struct Group {
  std::vector<std::size_t> members;
  double deviations = 0;

  bool better_than(const Group& other) const {
    return members.size() != other.members.size() ? members.size() > other.members.size()
                                                  : deviations < other.deviations;
  }
};

/// Takes the loops that agree with most others first, if they agree with all taken so far.
Group group_around(std::size_t seed, const Table& table, const std::vector<std::size_t>& order) {
  Group group{.members = {seed}};
  for (const std::size_t k : order) {
    if (k == seed) continue;
    double sum = 0;
    for (const std::size_t member : group.members) sum += table[k][member];
    if (sum == infinite) continue;
    group.deviations += sum;
    group.members.push_back(k);
  }
  return group;
}

}  // namespace

std::vector<bool> consistent_loops(const PoseGraph& graph, std::span<const Edge> loops,
                                   std::span<const Matrix6d> covariances,
                                   const Matrix6d& step_noise, double max_deviation) {
  const std::size_t count = loops.size();
  std::vector<bool> result(count, false);
  if (count == 0) return result;
  const Cycles cycles(graph, loops, covariances, step_noise);
  Table table(count, std::vector<double>(count, 0));
  parallel_for(count, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (std::size_t l = 0; l < k; ++l) {
        const double off = cycles.deviation(k, l);
        table[k][l] = off > max_deviation ? infinite : off;
      }
  });
  std::vector<std::size_t> agreeing(count, 0), order(count);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t l = 0; l < k; ++l) {
      table[l][k] = table[k][l];
      if (table[k][l] == infinite) continue;
      ++agreeing[k];
      ++agreeing[l];
    }
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t x, std::size_t y) { return agreeing[x] > agreeing[y]; });
  Group best;
  for (const std::size_t seed : order) {
    if (agreeing[seed] + 1 < best.members.size()) break;
    if (Group group = group_around(seed, table, order); group.better_than(best))
      best = std::move(group);
  }
  for (const std::size_t k : best.members) result[k] = true;
  return result;
}

}  // namespace planum
