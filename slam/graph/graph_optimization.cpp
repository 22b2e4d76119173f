#include "slam/graph/graph_optimization.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "slam/graph/chi_squared.hpp"
#include "slam/graph/chordal_initialization.hpp"
#include "slam/graph/graph_problem.hpp"
#include "slam/graph/robust_loops.hpp"

namespace planum {
namespace {

/// Poses for a choice of edges, and how good they are.
template <class Manifold>
struct Solution {
  std::vector<double> weights;  ///< one an edge, 0 or 1
  std::vector<std::vector<std::size_t>> parts{};
  Descent<Manifold> descent{};
  std::vector<double> squared_errors{};
  std::vector<typename Manifold::Matrix> covariances{};
};

/// Optimizes one graph for this or that choice of loops.
template <class Manifold>
class GraphOptimizer {
 public:
  using Poses = std::vector<typename Manifold::PoseType>;

  GraphOptimizer(GraphProblem<Manifold> problem, const GraphParams& params,
                 const Progress& progress)
      : problem_(std::move(problem)), params_(params), progress_(progress) {}

  std::vector<double> all_weights() const {
    std::vector<double> weights;
    for (const auto& edge : problem_.graph.edges) weights.push_back(edge.accepted ? 1 : 0);
    return weights;
  }

  bool all_known() const {
    return std::all_of(problem_.known.begin(), problem_.known.end(), [](bool k) { return k; });
  }

  /// `guess`: poses to start from if they are better than those that `params.start` allows.
  Solution<Manifold> solve(std::vector<double> weights, const Poses* guess = nullptr) {
    Solution<Manifold> solution{.weights = std::move(weights)};
    solution.parts = joined_poses<Manifold>(problem_.graph, solution.weights);
    problem_.terms.anchors = anchors_of(problem_, params_, solution.parts);
    std::vector<bool> included;
    for (const double weight : solution.weights) included.push_back(weight > 0);
    const GraphPattern pattern = graph_pattern(problem_.graph, included);
    GraphSolver<Manifold> solver(problem_.graph, pattern, problem_.terms);
    solution.descent = solver.descend(
        start(solution, pattern, guess), solution.weights,
        {.max_iterations = params_.max_iterations, .tolerance = params_.tolerance}, progress_);
    solution.squared_errors =
        squared_errors<Manifold>(problem_.graph, problem_.terms, solution.descent.poses);
    if (params_.covariances)
      solution.covariances = solver.covariances(solution.descent.poses, solution.weights);
    return solution;
  }

  /// With all loops, one is farther off than the worst of so many right ones should be: a normal
  /// value exceeds z in less than exp(-z^2 / 2) / 2 of all cases.
  bool contradictory(const Solution<Manifold>& solution) const {
    const double z = std::sqrt(2 * std::log(50.0 * static_cast<double>(loop_count())));
    const double limit = chi_squared(z, Manifold::dimension);
    for (std::size_t i = 0; i < problem_.graph.edges.size(); ++i)
      if (is_loop(i) && !(solution.squared_errors[i] <= limit)) return true;
    return false;
  }

  std::size_t loop_count() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < problem_.graph.edges.size(); ++i) count += is_loop(i) ? 1 : 0;
    return count;
  }

  LoopChoice<Manifold> choice() const {
    return consistent_loops<Manifold>(problem_.graph, problem_.terms, {.gate = params_.loop_gate},
                                      progress_);
  }

  double cost_before() const {
    if (!all_known()) return std::numeric_limits<double>::infinity();
    return cost(problem_.graph.poses, all_weights());
  }

  const GraphProblem<Manifold>& problem() const { return problem_; }

 private:
  bool is_loop(std::size_t edge) const {
    return problem_.graph.edges[edge].accepted && problem_.graph.edges[edge].kind == EdgeKind::loop;
  }

  double cost(const Poses& poses, const std::vector<double>& weights) const {
    return graph_cost<Manifold>(problem_.graph, problem_.terms, poses, weights);
  }

  Poses start(const Solution<Manifold>& solution, const GraphPattern& pattern,
              const Poses* guess) const {
    const bool given_allowed = all_known() && params_.start != GraphStart::edges;
    if (given_allowed && params_.start == GraphStart::given && !guess) return problem_.graph.poses;
    std::vector<std::size_t> anchors;
    for (const Anchor& anchor : problem_.terms.anchors) anchors.push_back(anchor.pose);
    Poses best =
        chordal_initialization<Manifold>(problem_.graph, pattern, anchors, solution.weights);
    if (best.empty())
      best = problem_.graph.poses;
    else
      turn_upright(problem_, params_, solution.parts, best);
    double best_cost = cost(best, solution.weights);
    const auto consider = [&](const Poses& poses) {
      const double its_cost = cost(poses, solution.weights);
      if (best_cost <= its_cost) return;
      best = poses;
      best_cost = its_cost;
    };
    if (given_allowed) consider(problem_.graph.poses);
    if (guess) consider(*guess);
    return best;
  }

  GraphProblem<Manifold> problem_;
  const GraphParams& params_;
  const Progress& progress_;
};

template <class Manifold, class Result>
Result optimized(const typename Manifold::GraphType& graph, const GraphParams& params,
                 const Progress& progress) {
  GraphOptimizer<Manifold> optimizer(graph_problem<Manifold>(graph, params), params, progress);
  Result result;
  GraphQuality& quality = result.quality;
  quality.converged = graph.poses.empty();
  if (graph.poses.empty()) return result;
  quality.cost_before = optimizer.cost_before();
  Solution<Manifold> solution = optimizer.solve(optimizer.all_weights());
  quality.iterations = solution.descent.iterations;
  const bool doubted =
      params.rejection == LoopRejection::always ||
      (params.rejection == LoopRejection::if_needed && optimizer.contradictory(solution));
  if (doubted && optimizer.loop_count() > 0 && params.max_iterations > 0) {
    LoopChoice<Manifold> choice = optimizer.choice();
    quality.noise_scale = choice.noise_scale;
    quality.iterations += choice.systems;
    if (choice.weights != solution.weights) {
      solution = optimizer.solve(std::move(choice.weights), &choice.poses);
      quality.iterations += solution.descent.iterations;
    }
  }
  quality.converged = solution.descent.converged;
  quality.cost_after = solution.descent.cost;
  for (const double weight : solution.weights) quality.counts.push_back(weight > 0);
  quality.squared_errors = std::move(solution.squared_errors);
  quality.repaired = optimizer.problem().repaired;
  quality.components = std::move(solution.parts);
  result.poses = std::move(solution.descent.poses);
  result.covariances = std::move(solution.covariances);
  return result;
}

}  // namespace

OptimizedGraph optimize(const PoseGraph& graph, const GraphParams& params,
                        const Progress& progress) {
  return optimized<SpatialManifold, OptimizedGraph>(graph, params, progress);
}

OptimizedPlanarGraph optimize(const PlanarPoseGraph& graph, const GraphParams& params,
                              const Progress& progress) {
  return optimized<PlanarManifold, OptimizedPlanarGraph>(graph, params, progress);
}

}  // namespace planum
