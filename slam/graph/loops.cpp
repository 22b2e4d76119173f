#include "slam/graph/loops.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/robust.hpp"
#include "slam/graph/edge_relaxation.hpp"
#include "slam/graph/loop_candidates.hpp"
#include "slam/graph/loop_consistency.hpp"
#include "slam/graph/loop_verification.hpp"
#include "slam/graph/path_covariance.hpp"
#include "slam/graph/scan_links.hpp"

namespace planum {
namespace {

void check(std::span<const MatchingScan> scans, const PoseGraph& graph, const LoopParams& params) {
  const auto require = [](bool good, const char* option, auto value, const char* limit) {
    if (!good) throw Error(fmt::format("loops: {} must be {}, got {}", option, limit, value));
  };
  require(graph.poses.size() == scans.size(), "the number of poses", graph.poses.size(),
          "that of the scans");
  require(params.max_distance > 0, "max_distance", params.max_distance, "> 0 m");
  require(params.min_overlap > 0 && params.min_overlap <= 1, "min_overlap", params.min_overlap,
          "between 0 and 1");
  require(params.known_within >= 0, "known_within", params.known_within, ">= 0 m");
  require(params.step_translation > 0, "step_translation", params.step_translation, "> 0 m");
  require(params.step_rotation > 0, "step_rotation", degrees(params.step_rotation), "> 0 deg");
  require(params.max_deviation > 0, "max_deviation", params.max_deviation, "> 0");
  require(params.max_rms_ratio > 0, "max_rms_ratio", params.max_rms_ratio, "> 0");
  require(params.least_gate > 0 && params.least_gate <= params.most_gate, "least_gate",
          params.least_gate, "between 0 and most_gate");
}

class LoopSearch {
 public:
  LoopSearch(std::span<const MatchingScan> scans, const PoseGraph& graph,
             const GatedPairMatcher& matcher, const LoopParams& params)
      : scans_(scans),
        path_(graph),
        matcher_(matcher),
        params_(params),
        poses_(graph.poses),
        views_(scans.size()) {
    std::vector<double> rms;
    for (const Edge& edge : graph.edges)
      if (edge.accepted && edge.matched) rms.push_back(edge.rms);
    if (!rms.empty()) usual_rms_ = upper_median(rms);
  }

  std::vector<Edge> run(const Progress& progress) {
    for (int round = 0; round < params_.max_rounds; ++round) {
      // Few at first, while the path is unsure and gates are wide: they make the others easy.
      const std::size_t per_scan =
          std::min(params_.candidates_per_scan, std::size_t{1} << std::min(round, 20));
      std::vector<LoopCandidate> found = loop_candidates(
          scans_, with_loops(), [this](const LoopCandidate& pair) { return worth_a_try(pair); },
          per_scan, params_);
      if (round == 0 && params_.by_appearance) add_by_appearance(found, progress);
      if (found.empty()) break;
      verify(found, progress);
      drop_inconsistent();
      settle();
    }
    std::vector<Edge> result;
    for (const auto& [pair, loop] : loops_) result.push_back(loop.edge);
    return result;
  }

 private:
  /// A pair that was tried.
  struct Tried {
    LoopCandidate candidate;
    Edge edge;
  };

  /// Whether no match was tried from about the same guess, as surely known.
  bool worth_a_try(const LoopCandidate& pair) const {
    const auto known = loops_.find({pair.from, pair.to});
    if (known == loops_.end()) return true;
    const auto& [before, edge] = known->second;
    const Pose change = before.guess.inverse() * pair.guess;
    return !edge.accepted && (change.translation().norm() >= params_.least_gate / 2 ||
                              pair.gate(params_) <= before.gate(params_) / 2);
  }

  /// The best alike of each pair that is no candidate yet.
  void add_by_appearance(std::vector<LoopCandidate>& found, const Progress& progress) const {
    std::set<ScanPair> known;
    for (const LoopCandidate& pair : found) known.insert({pair.from, pair.to});
    for (const LoopCandidate& pair : candidates_by_appearance(scans_, path_, params_, progress))
      if (known.insert({pair.from, pair.to}).second) found.push_back(pair);
  }

  PoseGraph with_loops() const {
    PoseGraph result{poses_, path_.edges};
    for (const auto& [pair, loop] : loops_) result.edges.push_back(loop.edge);
    return result;
  }

  /// Of a loop; where its match was weak, as unknown as can be.
  Matrix6d covariance_of(const Edge& edge) const {
    const Matrix6d information = edge.information + Matrix6d(unknown_pose(params_).inverse());
    return information.llt().solve(Matrix6d::Identity()) + step_noise(params_);
  }

  void verify(const std::vector<LoopCandidate>& found, const Progress& progress) {
    see(found);
    std::vector<Edge> edges(found.size());
    parallel_for(
        found.size(), 1,
        [&](std::size_t k, std::size_t) {
          const LoopEvidence evidence{
              .usual_rms = usual_rms_, .from = *views_[found[k].from], .to = *views_[found[k].to]};
          edges[k] = verified_loop(found[k], matcher_, evidence, params_);
        },
        progress);
    for (std::size_t k = 0; k < found.size(); ++k)
      loops_[{found[k].from, found[k].to}] = {found[k], edges[k]};
  }

  /// Makes the views of the scans of candidates.
  void see(const std::vector<LoopCandidate>& found) {
    std::set<std::size_t> needed;
    for (const LoopCandidate& pair : found)
      for (const std::size_t scan : {pair.from, pair.to})
        if (!views_[scan]) needed.insert(scan);
    const std::vector<std::size_t> missing(needed.begin(), needed.end());
    parallel_for(missing.size(), 1, [&](std::size_t k, std::size_t) {
      views_[missing[k]] = range_view(scans_[missing[k]]);
    });
  }

  /// Drops loops that contradict most of the others, two by two.
  void drop_inconsistent() {
    std::vector<Edge*> accepted;
    std::vector<Edge> loops;
    std::vector<Matrix6d> covariances;
    for (auto& [pair, loop] : loops_) {
      if (!loop.edge.accepted) continue;
      accepted.push_back(&loop.edge);
      loops.push_back(loop.edge);
      covariances.push_back(covariance_of(loop.edge));
    }
    const std::vector<bool> consistent =
        consistent_loops(path_, loops, covariances, step_noise(params_), params_.max_deviation);
    for (std::size_t k = 0; k < accepted.size(); ++k) {
      if (consistent[k]) continue;
      accepted[k]->accepted = false;
      accepted[k]->reason = "contradicts other loops";
    }
  }

  /// Moves the poses to close the accepted loops, and drops those that the others contradict.
  void settle() {
    while (true) {
      const std::vector<Pose> poses = relax_edges(with_loops()).poses;
      Edge* worst = nullptr;
      double most = params_.max_deviation;
      for (auto& [pair, loop] : loops_) {
        Edge& edge = loop.edge;
        if (!edge.accepted) continue;
        const double off = deviation(edge_error(edge, poses), covariance_of(edge));
        if (off <= most) continue;
        most = off;
        worst = &edge;
      }
      if (!worst) {
        poses_ = poses;
        return;
      }
      worst->accepted = false;
      worst->reason = fmt::format("{:.1f} standard deviations off the other loops", most);
    }
  }

  std::span<const MatchingScan> scans_;
  const PoseGraph& path_;  ///< as it came
  const GatedPairMatcher& matcher_;
  const LoopParams& params_;
  std::vector<Pose> poses_;  ///< with the loops so far closed
  double usual_rms_ = 0;     ///< m
  std::map<ScanPair, Tried> loops_;
  std::vector<std::optional<RangeView>> views_;  ///< of the scans that were tried
};

}  // namespace

std::vector<Edge> find_loops(std::span<const MatchingScan> scans, const PoseGraph& graph,
                             const GatedPairMatcher& matcher, const LoopParams& params,
                             const Progress& progress) {
  check(scans, graph, params);
  return LoopSearch(scans, graph, matcher, params).run(progress);
}

}  // namespace planum
