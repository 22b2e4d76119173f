#include "slam/graph/robust_loops.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "slam/graph/chi_squared.hpp"
#include "slam/graph/chordal_initialization.hpp"
#include "slam/graph/odometry_tree.hpp"

namespace planum {
namespace {

/// How far above the estimated noise a loop may be once others support the estimate: the tails of
/// real noise are heavier than normal. Never beyond what the information itself allows.
constexpr double tail_allowance = 4;

/// A loop must be so much worse to leave than to enter, or it would come and go for ever.
constexpr double leaving_factor = 1.5;

template <class Manifold>
class LoopSearch {
 public:
  using Graph = typename Manifold::GraphType;

  LoopSearch(const Graph& graph, const GraphTerms& terms, const RobustParams& params)
      : graph_(graph), terms_(terms), params_(params) {
    for (std::size_t i = 0; i < graph.edges.size(); ++i)
      if (graph.edges[i].accepted && graph.edges[i].kind == EdgeKind::loop) loops_.push_back(i);
  }

  LoopChoice<Manifold> best(const Progress& progress) {
    State state = first_state();
    grow(state, params_.max_stages, std::nullopt, progress);
    try_rejected(state);
    return {.weights = std::move(state.weights),
            .poses = std::move(state.poses),
            .noise_scale = std::sqrt(state.squared_scale),
            .systems = systems_};
  }

 private:
  struct State {
    std::vector<double> weights;
    std::vector<typename Manifold::PoseType> poses;
    std::vector<Innovation> innovations;
    double squared_scale = 1;
    double cost = 0;
    bool measured = false;  ///< the innovations are those against the loops that count
  };

  bool counts(const State& state, std::size_t loop) const { return state.weights[loop] > 0; }

  double gate(const State& state) const {
    const double nominal = chi_squared(params_.gate, Manifold::dimension);
    const double scale = state.squared_scale;
    if (!state.measured) return nominal * scale;
    return nominal * std::min(tail_allowance * scale, std::max(1.0, scale));
  }

  /// The squared scale of the noise: the median innovation of all loops beside that of normal
  /// noise; generous where loops are few.
  double squared_scale(const State& state) const {
    if (params_.noise_scale > 0) return params_.noise_scale * params_.noise_scale;
    std::vector<double> squared;
    for (const std::size_t loop : loops_) squared.push_back(state.innovations[loop].squared);
    const auto middle = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 2);
    std::nth_element(squared.begin(), middle, squared.end());
    const double generous = 1 + 2 / std::sqrt(static_cast<double>(squared.size()));
    return *middle / chi_squared(0, Manifold::dimension) * generous * generous;
  }

  /// Odometry alone. The information is taken at its word, at most, unless most loops contradict
  /// it.
  State first_state() {
    State state;
    for (const auto& edge : graph_.edges)
      state.weights.push_back(edge.accepted && edge.kind == EdgeKind::odometry ? 1.0 : 0.0);
    const OdometryTree<Manifold> tree(graph_, terms_.anchors);
    state.poses = tree.poses();
    for (const Anchor& anchor : terms_.anchors)
      state.poses[anchor.pose] = graph_.poses[anchor.pose];
    state.innovations.resize(graph_.edges.size());
    const double nominal = chi_squared(params_.gate, Manifold::dimension);
    std::size_t fitting = 0;
    for (const std::size_t loop : loops_) {
      state.innovations[loop] = tree.innovation(graph_.edges[loop], terms_.rotation_error);
      if (state.innovations[loop].squared < nominal) ++fitting;
    }
    if (loops_.empty()) return state;
    largest_scale_ = std::max(1.0, 2 * fitting >= loops_.size() ? 1.0 : squared_scale(state));
    if (params_.noise_scale > 0) largest_scale_ = std::numeric_limits<double>::infinity();
    state.squared_scale = std::min(largest_scale_, squared_scale(state));
    return state;
  }

  /// Optimizes with the loops that count and judges all; `suspects` are judged exactly, those that
  /// seemed to fit before are so too.
  void measure(State& state, const std::vector<std::size_t>& suspects = {}) {
    std::vector<bool> included(graph_.edges.size());
    for (std::size_t i = 0; i < included.size(); ++i) included[i] = state.weights[i] > 0;
    const double near = 3 * gate(state);
    for (const std::size_t loop : loops_)
      if (state.innovations[loop].exact && state.innovations[loop].squared < near)
        included[loop] = true;
    for (const std::size_t loop : suspects) included[loop] = true;
    const GraphPattern pattern = graph_pattern(graph_, included);
    GraphSolver<Manifold> solver(graph_, pattern, terms_);
    if (!state.measured) start(state, pattern);
    Descent<Manifold> descent = solver.descend(std::move(state.poses), state.weights,
                                               {.max_iterations = 20, .tolerance = 1e-4});
    systems_ += descent.iterations + 1;
    state.poses = std::move(descent.poses);
    state.cost = descent.cost;
    state.innovations = solver.innovations(state.poses, state.weights);
    state.squared_scale = std::min(largest_scale_, squared_scale(state));
    state.measured = true;
  }

  /// The better of odometry and the chordal start.
  void start(State& state, const GraphPattern& pattern) {
    std::vector<std::size_t> anchors;
    for (const Anchor& anchor : terms_.anchors) anchors.push_back(anchor.pose);
    auto chordal = chordal_initialization<Manifold>(graph_, pattern, anchors, state.weights);
    if (!chordal.empty() && !(graph_cost<Manifold>(graph_, terms_, state.poses, state.weights) <
                              graph_cost<Manifold>(graph_, terms_, chordal, state.weights)))
      state.poses = std::move(chordal);
  }

  /// Adds and removes loops until nothing changes. `locked` stays whatever it does.
  void grow(State& state, int stages, std::optional<std::size_t> locked = {},
            const Progress& progress = {}) {
    std::vector<std::size_t> suspects, added;
    State before;
    bool looked_again = false, changed = true;
    for (int stage = 0; stage < stages; ++stage) {
      progress.report(static_cast<std::size_t>(stage), static_cast<std::size_t>(stages));
      if (stage > 0 || state.measured) measure(state, suspects);
      suspects.clear();
      if (added.size() > 1 && !compatible(before, state, added.size())) {
        added.resize(added.size() / 2);
        state = before;
        count(state, added);
        continue;
      }
      added.clear();
      changed = remove_worst(state, locked);
      if (!changed) {
        added = surest(state);
        changed = !added.empty();
        if (changed) before = state;
        count(state, added);
      }
      if (changed) {
        looked_again = false;
        continue;
      }
      if (looked_again) break;
      looked_again = true;
      suspects = forgotten(state);
      if (suspects.empty() && state.measured) break;
    }
    if (changed) measure(state);
  }

  static void count(State& state, const std::vector<std::size_t>& loops) {
    for (const std::size_t loop : loops) state.weights[loop] = 1;
  }

  /// Whether loops that fit one by one fit together, or nearly so: what they add to the cost is a
  /// chi-squared value of all their dimensions. A few wrong ones among many are better removed
  /// afterwards than by halves.
  bool compatible(const State& before, const State& after, std::size_t added) const {
    if (!before.measured) return true;
    const double scale =
        std::min(tail_allowance * before.squared_scale, std::max(1.0, before.squared_scale));
    const int freedom = Manifold::dimension * static_cast<int>(added);
    return after.cost - before.cost <= 10 * scale * chi_squared(params_.gate, freedom);
  }

  /// Removes the loops that contradict the others most; they may be the reason why others do.
  bool remove_worst(State& state, std::optional<std::size_t> locked) const {
    const double limit = leaving_factor * gate(state);
    const auto removable = [&](std::size_t loop) { return counts(state, loop) && loop != locked; };
    double worst = 0;
    for (const std::size_t loop : loops_)
      if (removable(loop)) worst = std::max(worst, state.innovations[loop].squared);
    if (worst <= limit) return false;
    for (const std::size_t loop : loops_)
      if (removable(loop) && state.innovations[loop].squared > std::max(limit, 0.5 * worst))
        state.weights[loop] = 0;
    return true;
  }

  /// Of the loops that fit, the half that is predicted best; and all between parts that odometry
  /// does not connect. In the order of their uncertainty.
  std::vector<std::size_t> surest(const State& state) const {
    std::vector<std::pair<double, std::size_t>> fitting;
    for (const std::size_t loop : loops_) {
      const Innovation& innovation = state.innovations[loop];
      if (!counts(state, loop) && innovation.exact && innovation.squared < gate(state))
        fitting.emplace_back(innovation.gain, loop);
    }
    std::sort(fitting.begin(), fitting.end());
    const std::size_t share = std::max({std::size_t{1}, fitting.size() / 2, loops_.size() / 50});
    std::vector<std::size_t> result;
    for (const auto& [gain, loop] : fitting)
      if (result.size() < share || (!state.measured && std::isinf(gain))) result.push_back(loop);
    return result;
  }

  /// Loops that were left out of the pattern and might fit by now, the likeliest first. Not too
  /// many: every one fills the factor.
  std::vector<std::size_t> forgotten(const State& state) const {
    std::vector<std::pair<double, std::size_t>> found;
    for (const std::size_t loop : loops_)
      if (!state.innovations[loop].exact && state.innovations[loop].squared < 10 * gate(state))
        found.emplace_back(state.innovations[loop].squared, loop);
    std::sort(found.begin(), found.end());
    found.resize(std::min(found.size(), 32 + graph_.edges.size() / 50));
    std::vector<std::size_t> result;
    for (const auto& [squared, loop] : found) result.push_back(loop);
    return result;
  }

  /// Truncated least squares, in units of the scale of the noise that gate() has.
  double truncated_cost(const State& state, double limit) const {
    double sum = 0;
    for (std::size_t i = 0; i < graph_.edges.size(); ++i) {
      const auto& edge = graph_.edges[i];
      if (!edge.accepted) continue;
      const auto e = Manifold::error(state.poses[edge.from], state.poses[edge.to],
                                     edge.from_from_to, terms_.rotation_error);
      sum += state.weights[i] > 0 ? e.dot(edge.information * e) : limit;
    }
    return sum;
  }

  /// Forces rejected loops in, those that fit best first, and keeps what lowers the cost: the way
  /// out of wrong loops that came first.
  void try_rejected(State& state) {
    const int trials =
        std::min<int>(params_.max_trials, 1 + 1000 / static_cast<int>(1 + graph_.edges.size()));
    std::vector<bool> tried(graph_.edges.size(), false);
    for (int trial = 0; trial < trials; ++trial) {
      const double limit = gate(state);
      std::optional<std::size_t> next;
      for (const std::size_t loop : loops_) {
        const Innovation& innovation = state.innovations[loop];
        if (counts(state, loop) || tried[loop] || !innovation.exact) continue;
        if (innovation.squared > 10 * limit) continue;
        if (!next || innovation.squared < state.innovations[*next].squared) next = loop;
      }
      if (!next) return;
      tried[*next] = true;
      State other = state;
      other.weights[*next] = 1;
      grow(other, 8, next);
      grow(other, params_.max_stages / 2);
      if (truncated_cost(other, limit) < (1 - 1e-9) * truncated_cost(state, limit))
        state = std::move(other);
    }
  }

  const Graph& graph_;
  const GraphTerms& terms_;
  const RobustParams& params_;
  std::vector<std::size_t> loops_;
  double largest_scale_ = 1;
  int systems_ = 0;
};

}  // namespace

template <class Manifold>
LoopChoice<Manifold> consistent_loops(const typename Manifold::GraphType& graph,
                                      const GraphTerms& terms, const RobustParams& params,
                                      const Progress& progress) {
  return LoopSearch<Manifold>(graph, terms, params).best(progress);
}

template LoopChoice<SpatialManifold> consistent_loops(const PoseGraph&, const GraphTerms&,
                                                      const RobustParams&, const Progress&);
template LoopChoice<PlanarManifold> consistent_loops(const PlanarPoseGraph&, const GraphTerms&,
                                                     const RobustParams&, const Progress&);

}  // namespace planum
