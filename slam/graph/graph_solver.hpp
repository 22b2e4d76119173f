#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "slam/core/progress.hpp"
#include "slam/graph/block_cholesky.hpp"
#include "slam/graph/graph_cost.hpp"
#include "slam/graph/graph_pattern.hpp"
#include "slam/graph/pose_manifold.hpp"

namespace planum {

struct DescentParams {
  int max_iterations = 100;
  double tolerance =
      1e-10;  ///< done when a step promises to lower the cost by less than this share
};

template <class Manifold>
struct Descent {
  std::vector<typename Manifold::PoseType> poses;
  double cost = 0;
  int iterations = 0;  ///< systems solved
  bool converged = false;
};

/// How an edge compares with what all others together say about its two poses.
struct Innovation {
  /// e' S^-1 e with the covariance S of the difference, to first order; 0 if nothing else joins the
  /// two poses. For an edge out of the pattern a lower bound.
  double squared = 0;
  /// Information the edge adds or has added, in nats; infinite if nothing else joins the two poses.
  double gain = std::numeric_limits<double>::infinity();
  bool exact = false;  ///< false: out of the pattern
};

/// Levenberg-Marquardt for the sum of weight e' I e over the edges of a pose graph (plus gravity),
/// with analytic derivatives. Where a step turns out worse than its linearization promised,
/// positions are solved for anew with the turned rotations before damping is tried: given the
/// rotations they are a linear problem, and a small turn of a long chain moves its far end along an
/// arc that a linear step leaves. Information matrices must be positive semidefinite. The same bits
/// for any number of threads.
template <class Manifold>
class GraphSolver {
 public:
  using Graph = typename Manifold::GraphType;
  using PoseType = typename Manifold::PoseType;
  using Vector = typename Manifold::Vector;
  using Matrix = typename Manifold::Matrix;
  using Poses = std::span<const PoseType>;
  using Weights =
      std::span<const double>;  ///< one an edge; 0: left out, as all out of the pattern are

  /// Keeps references to the graph, whose poses are not used, and to the pattern.
  GraphSolver(const Graph& graph, const GraphPattern& pattern, GraphTerms terms);

  Descent<Manifold> descend(std::vector<PoseType> poses, Weights weights,
                            const DescentParams& params, const Progress& progress = {});

  /// The covariance of each pose, of small motions in its own frame, given the anchors; empty if
  /// the edges do not determine all poses.
  std::vector<Matrix> covariances(Poses poses, Weights weights);

  /// For every edge, by one selected inversion. Weights must be 0 or 1.
  std::vector<Innovation> innovations(Poses poses, Weights weights);

 private:
  /// What one edge adds to the normal equations.
  struct EdgeBlocks {
    Matrix from_from, to_to;
    Matrix first_second;  ///< rows of the pose with the lower index
    Vector from, to;
  };
  double cost(Poses poses, Weights weights) const;
  EdgeBlocks edge_blocks(std::size_t edge, Poses poses, double weight) const;
  void linearize(Poses poses, Weights weights);
  void add_gravity(Poses poses);
  Matrix freedom(const Anchor& anchor, Poses poses) const;
  void apply_anchors(Poses poses);
  void set_damping_scale();
  bool factorize(double damping);
  BlockMatrix anchored_inverse(Poses poses) const;
  Innovation innovation(std::size_t edge, Poses poses, bool counted,
                        const BlockMatrix& inverse) const;
  void improve_positions(std::vector<PoseType>& poses, double& poses_cost, Weights weights) const;
  Eigen::Map<Matrix> diagonal(std::size_t pose);

  const Graph* graph_;
  const GraphPattern* pattern_;
  GraphTerms terms_;
  std::vector<std::size_t> anchor_poses_;
  BlockCholesky cholesky_;
  BlockMatrix hessian_;
  Eigen::VectorXd gradient_, damping_scale_;
  std::vector<EdgeBlocks> edge_blocks_;
};

}  // namespace planum
