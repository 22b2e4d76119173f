#include "slam/graph/loops.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/robust.hpp"
#include "slam/graph/edge_relaxation.hpp"
#include "slam/graph/path_covariance.hpp"
#include "slam/graph/scan_links.hpp"
#include "slam/registration/overlap.hpp"

namespace planum {
namespace {

/// A gate reaches this many standard deviations of the guess.
constexpr double gate_per_deviation = 3;

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

/// A pair of scans that may be a loop, and how well the path between them is known.
struct Candidate {
  std::size_t from = 0, to = 0;
  Pose guess = Pose::Identity();  ///< from_from_to
  Matrix6d covariance = Matrix6d::Zero();
  double overlap = 0;

  double gate(const LoopParams& params) const {
    return std::clamp(gate_per_deviation * std::sqrt(covariance.diagonal().head<3>().maxCoeff()),
                      params.least_gate, params.most_gate);
  }
};

/// m, standard deviation of where a pose with this covariance puts a point so far away.
double placed_within(const Matrix6d& covariance, double radius) {
  const double shift = covariance.diagonal().head<3>().maxCoeff();
  const double turn = covariance.diagonal().tail<3>().maxCoeff();
  return std::sqrt(shift + radius * radius * turn);
}

/// How many standard deviations an error is.
double deviation(const Vector6d& error, const Matrix6d& covariance) {
  return std::sqrt(std::max(0.0, error.dot(covariance.ldlt().solve(error))));
}

class LoopSearch {
 public:
  LoopSearch(std::span<const MatchingScan> scans, const PoseGraph& graph,
             const LoopMatcher& matcher, const LoopParams& params)
      : scans_(scans), graph_(graph), matcher_(matcher), params_(params) {
    step_noise_.diagonal() << Eigen::Vector3d::Constant(std::pow(params.step_translation, 2)),
        Eigen::Vector3d::Constant(std::pow(params.step_rotation, 2));
    std::vector<double> rms;
    for (const Edge& edge : graph.edges)
      if (edge.accepted && edge.matched) rms.push_back(edge.rms);
    if (!rms.empty()) usual_rms_ = upper_median(rms);
  }

  std::vector<Edge> run(const Progress& progress) {
    for (int round = 0; round < params_.max_rounds; ++round) {
      // Few at first, while the path is unsure and gates are wide: they make the others easy.
      const std::vector<Candidate> found =
          candidates(std::min(params_.candidates_per_scan, std::size_t{1} << std::min(round, 20)));
      if (found.empty()) break;
      verify(found, progress);
      settle();
    }
    std::vector<Edge> result;
    for (const auto& [pair, edge] : loops_) result.push_back(edge);
    return result;
  }

 private:
  /// Pairs that no edge joins yet and no match was tried for from about the same guess.
  std::vector<Candidate> candidates(std::size_t per_scan) const {
    const PoseGraph closed = with_loops();
    std::vector<Candidate> all;
    std::vector<std::vector<Candidate>> of_scan(scans_.size());
    parallel_for(scans_.size(), 1, [&](std::size_t from, std::size_t) {
      const auto covariances = path_covariances(closed, from, step_noise_);
      for (std::size_t to = from + 2; to < scans_.size(); ++to)
        if (const auto candidate = considered(from, to, covariances[to]))
          of_scan[from].push_back(*candidate);
    });
    for (const auto& some : of_scan) all.insert(all.end(), some.begin(), some.end());
    return most_overlapping(std::move(all), per_scan);
  }

  std::optional<Candidate> considered(std::size_t from, std::size_t to,
                                      const std::optional<Matrix6d>& covariance) const {
    Candidate result{.from = from,
                     .to = to,
                     .guess = graph_.poses[from].inverse() * graph_.poses[to],
                     .covariance = covariance.value_or(unknown())};
    if (result.guess.translation().norm() > params_.max_distance) return std::nullopt;
    if (placed_within(result.covariance, scans_[to].radius) < params_.known_within)
      return std::nullopt;
    if (const auto known = loops_.find({from, to}); known != loops_.end()) {
      const Pose change = guesses_.at({from, to}).inverse() * result.guess;
      if (known->second.accepted || change.translation().norm() < params_.least_gate / 2)
        return std::nullopt;
    }
    const OverlapParams near{.distance = result.gate(params_)};
    result.overlap =
        std::max(estimated_overlap(scans_[to], scans_[from], result.guess, near),
                 estimated_overlap(scans_[from], scans_[to], result.guess.inverse(), near));
    if (result.overlap < params_.min_overlap) return std::nullopt;
    return result;
  }

  PoseGraph with_loops() const {
    PoseGraph result = graph_;
    for (const auto& [pair, edge] : loops_) result.edges.push_back(edge);
    return result;
  }

  /// Of a loop; where its match was weak, as unknown as can be.
  Matrix6d covariance_of(const Edge& edge) const {
    const Matrix6d information = edge.information + Matrix6d(unknown().inverse());
    return information.llt().solve(Matrix6d::Identity()) + step_noise_;
  }

  /// Covariance of what may be anywhere within the widest gate.
  Matrix6d unknown() const {
    Vector6d variance;
    variance << Eigen::Vector3d::Constant(std::pow(params_.most_gate, 2)),
        Eigen::Vector3d::Constant(std::pow(pi / 4, 2));
    return variance.asDiagonal();
  }

  /// Each scan's best ones; a pair counts for both of its scans.
  std::vector<Candidate> most_overlapping(std::vector<Candidate> all, std::size_t per_scan) const {
    std::vector<std::size_t> order(all.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return all[x].overlap > all[y].overlap; });
    std::vector<std::size_t> count(scans_.size(), 0);
    std::vector<Candidate> result;
    for (const std::size_t k : order) {
      Candidate& candidate = all[k];
      if (std::min(count[candidate.from], count[candidate.to]) >= per_scan) continue;
      ++count[candidate.from];
      ++count[candidate.to];
      result.push_back(candidate);
    }
    return result;
  }

  void verify(const std::vector<Candidate>& found, const Progress& progress) {
    std::vector<Edge> edges(found.size());
    parallel_for(
        found.size(), 1, [&](std::size_t k, std::size_t) { edges[k] = verified(found[k]); },
        progress);
    for (std::size_t k = 0; k < found.size(); ++k) {
      loops_[{found[k].from, found[k].to}] = edges[k];
      guesses_[{found[k].from, found[k].to}] = found[k].guess;
    }
  }

  Edge verified(const Candidate& candidate) const {
    const Alignment alignment =
        matcher_(candidate.from, candidate.to, candidate.guess, candidate.gate(params_));
    Edge edge{.from = candidate.from,
              .to = candidate.to,
              .from_from_to = alignment.target_from_source,
              .information = alignment.information,
              .rms = alignment.rms,
              .overlap = alignment.overlap,
              .kind = EdgeKind::loop};
    edge.reason = doubt(candidate, alignment);
    edge.accepted = edge.reason.empty();
    return edge;
  }

  /// Empty if the match is to be believed.
  std::string doubt(const Candidate& candidate, const Alignment& alignment) const {
    if (alignment.pairs == 0) return "too few pairs";
    if (alignment.overlap < params_.min_overlap)
      return fmt::format("overlap {:.2f} is below {:.2f}", alignment.overlap, params_.min_overlap);
    if (!alignment.converged) return "the match did not converge";
    if (usual_rms_ > 0 && alignment.rms > params_.max_rms_ratio * usual_rms_)
      return fmt::format("rms {:.4f} m is above {:.4f} m", alignment.rms,
                         params_.max_rms_ratio * usual_rms_);
    const Vector6d correction = log_se3(candidate.guess.inverse() * alignment.target_from_source);
    const double off = deviation(correction, candidate.covariance + step_noise_);
    if (off > params_.max_deviation)
      return fmt::format("{:.2f} m and {:.1f} deg off the path, {:.1f} standard deviations",
                         correction.head<3>().norm(), degrees(correction.tail<3>().norm()), off);
    return {};
  }

  /// Moves the poses to close the accepted loops, and drops those that the others contradict.
  void settle() {
    while (true) {
      const std::vector<Pose> poses = relax_edges(with_loops()).poses;
      Edge* worst = nullptr;
      double most = params_.max_deviation;
      for (auto& [pair, edge] : loops_) {
        if (!edge.accepted) continue;
        const double off = deviation(edge_error(edge, poses), covariance_of(edge));
        if (off <= most) continue;
        most = off;
        worst = &edge;
      }
      if (!worst) {
        graph_.poses = poses;
        return;
      }
      worst->accepted = false;
      worst->reason = fmt::format("{:.1f} standard deviations off the other loops", most);
    }
  }

  std::span<const MatchingScan> scans_;
  PoseGraph graph_;  ///< edges as they came; poses with the loops so far closed
  const LoopMatcher& matcher_;
  const LoopParams& params_;
  Matrix6d step_noise_ = Matrix6d::Zero();
  double usual_rms_ = 0;  ///< m
  std::map<ScanPair, Edge> loops_;
  std::map<ScanPair, Pose> guesses_;
};

}  // namespace

LoopMatcher icp_loop_matcher(std::span<const MatchingScan> scans, const IcpParams& params) {
  return [scans, params](std::size_t target, std::size_t source, const Pose& guess,
                         double first_gate) {
    IcpParams gated = params;
    gated.first_gate = first_gate;
    gated.last_gate = std::min(gated.last_gate, first_gate);
    return icp_matcher(scans, gated)(target, source, guess);
  };
}

std::vector<Edge> find_loops(std::span<const MatchingScan> scans, const PoseGraph& graph,
                             const LoopMatcher& matcher, const LoopParams& params,
                             const Progress& progress) {
  check(scans, graph, params);
  return LoopSearch(scans, graph, matcher, params).run(progress);
}

}  // namespace planum
