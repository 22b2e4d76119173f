#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "slam/core/progress.hpp"
#include "slam/graph/block_cholesky.hpp"
#include "slam/graph/graph_pattern.hpp"
#include "slam/graph/gravity.hpp"
#include "slam/graph/pose_manifold.hpp"

namespace planum {

/// A pose that may not move as it likes: only along freedom * x, for small motions x of it.
template <class Manifold>
struct Anchor {
  std::size_t pose = 0;
  typename Manifold::Matrix freedom = Manifold::Matrix::Zero();  ///< a projection; zero: fixed
};

/// What there is beside the edges of a graph.
template <class Manifold>
struct GraphTerms {
  RotationError rotation_error = RotationError::chord;
  std::vector<Anchor<Manifold>> anchors;          ///< at least one pose of each component
  std::vector<GravityObservation> gravity;        ///< in space only; up_in_pose must be unit
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< in the world, unit
};

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
  GraphSolver(const Graph& graph, const GraphPattern& pattern, GraphTerms<Manifold> terms);

  /// e' I e of each edge.
  std::vector<double> squared_errors(Poses poses) const;

  /// The weighted sum of them, plus that of gravity.
  double cost(Poses poses, Weights weights) const;

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
  EdgeBlocks edge_blocks(std::size_t edge, Poses poses, double weight) const;
  void linearize(Poses poses, Weights weights);
  void add_gravity(Poses poses);
  void apply_anchors();
  void set_damping_scale();
  bool factorize(double damping);
  BlockMatrix anchored_inverse() const;
  Innovation innovation(std::size_t edge, Poses poses, bool counted,
                        const BlockMatrix& inverse) const;
  void improve_positions(std::vector<PoseType>& poses, double& poses_cost, Weights weights) const;
  Eigen::Map<Matrix> diagonal(std::size_t pose);

  const Graph* graph_;
  const GraphPattern* pattern_;
  GraphTerms<Manifold> terms_;
  std::vector<std::size_t> anchor_poses_;
  BlockCholesky cholesky_;
  BlockMatrix hessian_;
  Eigen::VectorXd gradient_, damping_scale_;
  std::vector<EdgeBlocks> edge_blocks_;
};

}  // namespace planum
