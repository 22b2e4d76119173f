#include "slam/graph/relax_lu_milios.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/graph/edge_relaxation.hpp"
#include "slam/graph/scan_links.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/overlap.hpp"

namespace planum {
namespace {

/// The first gate, in last gates, where it is not given.
constexpr double first_gate_per_last = 3;
constexpr double gate_factor = 0.5;
/// A gate before the last is done when no pose moves more than this much of it.
constexpr double step_per_gate = 0.05;
/// Where poses still move far at the last gate, links are chosen anew so many times at most.
constexpr int most_last_rounds = 3;
/// m; who sees the same as whom is asked anew when a pose has moved this far, a small part of the
/// distance at which points count as common.
const double new_links = 0.1 * OverlapParams{}.distance;

void check(const PoseGraph& graph, std::span<const MatchingScan> scans,
           const LuMiliosParams& params) {
  const auto require = [](bool good, const char* option, auto value, const char* limit) {
    if (!good) throw Error(fmt::format("relaxation: {} must be {}, got {}", option, limit, value));
  };
  require(graph.poses.size() == scans.size(), "the number of poses", graph.poses.size(),
          "that of the scans");
  require(params.max_distance > 0, "max_distance", params.max_distance, "> 0 m");
  require(params.min_overlap > 0 && params.min_overlap <= 1, "min_overlap", params.min_overlap,
          "between 0 and 1");
  require(params.first_gate >= 0 && std::isfinite(params.first_gate), "first_gate",
          params.first_gate, ">= 0 m");
  require(params.last_gate >= 0 && std::isfinite(params.last_gate), "last_gate", params.last_gate,
          ">= 0 m");
  require(params.max_normal_angle > 0 && params.max_normal_angle <= pi, "max_normal_angle",
          degrees(params.max_normal_angle), "between 0 and 180 deg");
  require(params.min_pairs >= 6, "min_pairs", params.min_pairs, ">= 6");
  require(params.max_iterations > 0, "max_iterations", params.max_iterations, "> 0");
  require(params.tolerance > 0, "tolerance", params.tolerance, "> 0");
}

/// The relaxation while it runs. Poses are in the frame of the first scan, so that it does not
/// matter where the world has its origin.
class Relaxation {
 public:
  Relaxation(const PoseGraph& graph, std::span<const MatchingScan> scans,
             const LuMiliosParams& params, std::vector<Pose> poses)
      : graph_(graph), scans_(scans), params_(params), poses_(std::move(poses)) {
    for (const MatchingScan& scan : scans) selections_.push_back(scan.selection(params.max_points));
    for (const MatchingScan& scan : scans)
      if (scan.noise > 0) noise_ = noise_ == 0 ? scan.noise : std::min(noise_, scan.noise);
    noise_ = std::max(noise_, least_noise);
    for (const Edge& edge : graph.edges)
      if (!edge.accepted) excluded_.insert(std::minmax(edge.from, edge.to));
  }

  void run(const Progress& progress, GraphResult& result) {
    // The last gate is 1; a link multiplies by its own, which depends on its noise.
    const double first = params_.first_gate > 0 && params_.last_gate > 0
                             ? std::max(1.0, params_.first_gate / params_.last_gate)
                             : first_gate_per_last;
    choose_links();
    for (double gate = first; gate > 1; gate *= gate_factor) {
      iterate(gate, false, progress, result);
      if (links_are_old()) choose_links();
    }
    for (int round = 0; round < most_last_rounds; ++round) {
      select_more();
      result.converged = iterate(1, true, progress, result);
      if (!links_are_old()) break;
      choose_links();
    }
  }

  /// Fits of all links at the last gate, with any poses.
  std::vector<LinkFit> fits(const std::vector<Pose>& poses, double gate) {
    std::vector<LinkFit> result(links_.size());
    parallel_for(links_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t l = begin; l < end; ++l)
        result[l] = links_[l].fit(poses, params_.pairing, gate * last_gate(links_[l]),
                                  params_.max_normal_angle, params_.min_pairs);
    });
    return result;
  }

  const std::vector<Pose>& poses() const { return poses_; }

 private:
  /// The points that are looked at at last: a scan with few links needs more in each to be as well
  /// placed.
  void select_more() {
    if (params_.max_points == 0) return;
    std::vector<std::size_t> links(scans_.size(), 0);
    for (const ScanLink& link : links_) ++links[link.pair().first], ++links[link.pair().second];
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      if (links[i] == 0) continue;
      const std::size_t most = params_.last_points > 0
                                   ? std::max(params_.max_points, params_.last_points / links[i])
                                   : 0;
      selections_[i] = scans_[i].selection(most);
    }
    parallel_for(links_.size(), 1,
                 [&](std::size_t l, std::size_t) { links_[l].select(selections_); });
  }

  bool links_are_old() const { return largest_move(poses_when_linked_) > new_links; }

  double last_gate(const ScanLink& link) const {
    return params_.last_gate > 0 ? params_.last_gate : gate_per_noise * link.noise();
  }

  /// Which scans see the same with the poses as they are now.
  void choose_links() {
    const std::vector<ScanPair> pairs =
        overlapping_scans(scans_, poses_,
                          {.max_distance = params_.max_distance,
                           .min_overlap = params_.min_overlap,
                           .links_per_scan = params_.links_per_scan},
                          excluded_);
    // A link that stays remembers where its points found theirs.
    std::map<ScanPair, ScanLink> known;
    for (ScanLink& link : links_) known.emplace(link.pair(), std::move(link));
    links_.clear();
    for (const ScanPair& pair : pairs) {
      const auto stays = known.find(pair);
      if (stays != known.end())
        links_.push_back(std::move(stays->second));
      else
        links_.emplace_back(pair, scans_, selections_);
    }
    poses_when_linked_ = poses_;
    const std::set<ScanPair> linked(pairs.begin(), pairs.end());
    kept_edges_.clear();
    kept_information_.clear();
    for (const Edge& edge : graph_.edges) {
      if (!edge.accepted) continue;
      const bool is_linked = linked.contains(std::minmax(edge.from, edge.to));
      kept_edges_.push_back(&edge);
      kept_information_.push_back(is_linked ? edge.odometry_information : edge.information);
    }
  }

  LuMiliosSystem system() const {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (const ScanLink& link : links_) pairs.push_back(link.pair());
    for (const Edge* edge : kept_edges_) pairs.emplace_back(edge->to, edge->from);
    const std::vector<std::size_t> first = first_connected(poses_.size(), pairs);
    std::vector<bool> fixed(poses_.size());
    for (std::size_t i = 0; i < fixed.size(); ++i) fixed[i] = first[i] == i;
    return {pairs, std::move(fixed)};
  }

  /// Iterates at one gate until poses rest; false if they do not.
  bool iterate(double gate, bool last, const Progress& progress, GraphResult& result) {
    LuMiliosSystem lu_milios = system();
    const double enough =
        last ? params_.tolerance * noise_ : step_per_gate * gate * gate_per_noise * noise_;
    std::vector<Vector6d> motions, before;
    double share = 1;  // of each motion that is made
    for (int i = 0; i < params_.max_iterations; ++i) {
      std::vector<LinkEquation> equations;
      for (const LinkFit& fit : fits(poses_, gate)) equations.push_back(fit.equation);
      for (std::size_t k = 0; k < kept_edges_.size(); ++k)
        equations.push_back(edge_equation(*kept_edges_[k], kept_information_[k], poses_));
      before = std::exchange(motions, lu_milios.solve(equations, gentle_damping()));
      // Where a few pairs change to and fro, so do the poses: between the two they rest.
      if (!before.empty() && turned_back(motions, before)) share /= 2;
      const double moved = move(motions, share);
      progress.report(static_cast<std::size_t>(++result.iterations), 0);
      if (moved < enough) return true;
    }
    return false;
  }

  /// Moves the poses; m, how far the points of the scan that moved most went, rms.
  double move(const std::vector<Vector6d>& motions, double share) {
    const std::vector<Pose> before = poses_;
    for (std::size_t i = 0; i < motions.size(); ++i)
      poses_[i] = orthonormalized(exp_se3(share * motions[i]) * poses_[i]);
    return largest_move(before);
  }

  /// Whether motions mostly undo those before.
  bool turned_back(const std::vector<Vector6d>& motions,
                   const std::vector<Vector6d>& before) const {
    double along = 0, squares = 0, squares_before = 0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Vector6d unit = both_parts(1, scans_[i].radius);
      const Vector6d now = unit.cwiseProduct(motions[i]), then = unit.cwiseProduct(before[i]);
      along += now.dot(then);
      squares += now.squaredNorm();
      squares_before += then.squaredNorm();
    }
    return along < -0.5 * std::sqrt(squares * squares_before);
  }

  /// m, how far the points of the scan that moved most are from where they were, rms.
  double largest_move(const std::vector<Pose>& before) const {
    double largest = 0;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const double shift = (poses_[i].translation() - before[i].translation()).norm();
      const double turn = rotation_angle(before[i].inverse() * poses_[i]);
      largest = std::max(largest, std::hypot(shift, turn * scans_[i].radius));
    }
    return largest;
  }

  const PoseGraph& graph_;
  std::span<const MatchingScan> scans_;
  const LuMiliosParams& params_;
  std::vector<Pose> poses_;
  double noise_ = 0;
  std::set<ScanPair> excluded_;
  std::vector<std::vector<std::uint32_t>> selections_;  ///< of each scan
  std::vector<ScanLink> links_;
  std::vector<Pose> poses_when_linked_;
  std::vector<const Edge*> kept_edges_;
  std::vector<Matrix6d> kept_information_;
};

double rms(const std::vector<LinkFit>& fits) {
  double squared = 0, weight = 0;
  for (const LinkFit& fit : fits) {
    squared += fit.squared_residuals;
    weight += fit.weight;
  }
  return weight > 0 ? std::sqrt(squared / weight) : 0;
}

/// A link as an edge: scan b is `from`, scan a is `to`.
Edge edge_of(const LinkFit& fit, const std::vector<Pose>& poses) {
  const LinkEquation& e = fit.equation;
  const Matrix6d world_from_error = adjoint(poses[e.a]);
  return {.from = e.b,
          .to = e.a,
          .from_from_to = poses[e.b].inverse() * poses[e.a],
          .information = world_from_error.transpose() * e.information * world_from_error,
          .rms = fit.rms(),
          .overlap = fit.overlap,
          .kind = e.a + 1 == e.b ? EdgeKind::odometry : EdgeKind::loop};
}

}  // namespace

GraphResult relax_lu_milios(const PoseGraph& graph, std::span<const MatchingScan> scans,
                            const LuMiliosParams& params, const Progress& progress) {
  check(graph, scans, params);
  GraphResult result{.graph = graph};
  if (graph.poses.empty()) {
    result.converged = true;
    return result;
  }
  const Pose world_from_first = graph.poses.front(), first_from_world = world_from_first.inverse();
  const auto in_first = [&](std::vector<Pose> poses) {
    for (Pose& pose : poses) pose = first_from_world * pose;
    return poses;
  };
  Relaxation relaxation(graph, scans, params, in_first(relax_edges(graph).poses));
  relaxation.run(progress, result);
  result.residual_before = rms(relaxation.fits(in_first(graph.poses), 1));
  const std::vector<LinkFit> fits = relaxation.fits(relaxation.poses(), 1);
  result.residual_after = rms(fits);
  for (const LinkFit& fit : fits)
    if (fit.pairs > 0) result.links.push_back(edge_of(fit, relaxation.poses()));
  for (std::size_t i = 0; i < graph.poses.size(); ++i)
    result.graph.poses[i] = orthonormalized(world_from_first * relaxation.poses()[i]);
  return result;
}

}  // namespace planum
