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
  bool hopeless = false;  ///< given up: a loop is very far off
};

/// Whether a graph may turn out to have false loops.
enum class Trust { full, doubtful };

/// After so many steps a graph of right loops is nearly done, while wrong ones fill the systems and
/// do not let it end.
constexpr int trial_iterations = 15;
constexpr double hopeless_factor = 30;  ///< beyond what is contradictory

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
  Solution<Manifold> solve(std::vector<double> weights, Trust trust, const Poses* guess = nullptr) {
    Solution<Manifold> solution{.weights = std::move(weights)};
    solution.parts = joined_poses<Manifold>(problem_.graph, solution.weights);
    problem_.terms.anchors = anchors_of(problem_, params_, solution.parts);
    std::vector<bool> included;
    for (const double weight : solution.weights) included.push_back(weight > 0);
    const GraphPattern pattern = graph_pattern(problem_.graph, included);
    GraphSolver<Manifold> solver(problem_.graph, pattern, problem_.terms);
    solution.descent = descent(solver, start(solution, pattern, guess), solution, trust);
    solution.squared_errors = squared(solution.descent.poses);
    if (params_.covariances && !solution.hopeless)
      solution.covariances = solver.covariances(solution.descent.poses, solution.weights);
    return solution;
  }

  /// One loop is more than `factor` times farther off than the worst of so many right ones should
  /// be: a normal value exceeds z in less than exp(-z^2 / 2) / 2 of all cases.
  bool contradictory(const std::vector<double>& squared_of_edge, double factor = 1) const {
    const double z = std::sqrt(2 * std::log(50.0 * static_cast<double>(loop_count())));
    const double limit = factor * chi_squared(z, Manifold::dimension);
    for (std::size_t i = 0; i < problem_.graph.edges.size(); ++i)
      if (is_loop(i) && !(squared_of_edge[i] <= limit)) return true;
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

  std::vector<double> squared(const Poses& poses) const {
    return squared_errors<Manifold>(problem_.graph, problem_.terms, poses);
  }

  Descent<Manifold> descent(GraphSolver<Manifold>& solver, Poses poses,
                            Solution<Manifold>& solution, Trust trust) const {
    const int trial = trust == Trust::doubtful ? std::min(trial_iterations, params_.max_iterations)
                                               : params_.max_iterations;
    DescentParams steps = {.max_iterations = trial, .tolerance = params_.tolerance};
    Descent<Manifold> tried = solver.descend(std::move(poses), solution.weights, steps, progress_);
    steps.max_iterations = params_.max_iterations - trial;
    if (tried.converged || steps.max_iterations == 0) return tried;
    solution.hopeless = contradictory(squared(tried.poses), hopeless_factor);
    if (solution.hopeless) return tried;
    Descent<Manifold> done =
        solver.descend(std::move(tried.poses), solution.weights, steps, progress_);
    done.iterations += tried.iterations;
    return done;
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
  const bool may_doubt = params.rejection != LoopRejection::never && params.max_iterations > 0 &&
                         optimizer.loop_count() > 0;
  Solution<Manifold> solution =
      optimizer.solve(optimizer.all_weights(), may_doubt ? Trust::doubtful : Trust::full);
  quality.iterations = solution.descent.iterations;
  if (may_doubt && (params.rejection == LoopRejection::always ||
                    optimizer.contradictory(solution.squared_errors))) {
    LoopChoice<Manifold> choice = optimizer.choice();
    quality.noise_scale = choice.noise_scale;
    quality.iterations += choice.systems;
    if (solution.hopeless || choice.weights != solution.weights) {
      solution = optimizer.solve(std::move(choice.weights), Trust::full, &choice.poses);
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
