// The graphs of ../shared/datasets/pose_graphs: chi2 that is reached against the optimum of the
// data's README, and time against Ceres on the same graph from the same vertices, with the same
// cost: a plain pose graph as in Ceres' own examples (automatic derivatives, quaternions,
// SPARSE_NORMAL_CHOLESKY), and the same from our chordal start, for graphs where it gets stuck.
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <vector>

#include <ceres/ceres.h>
#include <fmt/format.h>

#include "slam/core/parallel.hpp"
#include "slam/graph/g2o_pose_graph.hpp"
#include "slam/graph/graph_optimization.hpp"

namespace {

using namespace planum;

constexpr int repetitions = 7;

double median_ms(const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < repetitions; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
            .count());
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

ceres::Solver::Options ceres_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 200;
  options.num_threads = thread_count();
  options.function_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  return options;
}

/// I = L L': residuals are L' e.
struct SpatialResidual {
  Eigen::Quaterniond rotation;
  Eigen::Vector3d translation;
  Matrix6d root;  ///< L'

  template <class T>
  bool operator()(const T* p_from, const T* q_from, const T* p_to, const T* q_to,
                  T* residuals) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    using Quaternion = Eigen::Quaternion<T>;
    const Eigen::Map<const Vector> from(p_from), to(p_to);
    const Eigen::Map<const Quaternion> turn_from(q_from), turn_to(q_to);
    const Quaternion measured = rotation.cast<T>();
    const Quaternion back = turn_from.conjugate();
    const Quaternion rest = measured.conjugate() * (back * turn_to);
    Eigen::Map<Eigen::Matrix<T, 6, 1>> e(residuals);
    e.template head<3>() = measured.conjugate() * (back * (to - from) - translation.cast<T>());
    const T sign = rest.w() < T(0) ? T(-2) : T(2);
    e.template tail<3>() = sign * rest.vec();
    e.applyOnTheLeft(root.cast<T>());
    return true;
  }
};

struct PlanarResidual {
  PlanarPose measured;
  Eigen::Matrix3d root;

  template <class T>
  bool operator()(const T* from, const T* to, T* residuals) const {
    const T c = cos(from[2]), s = sin(from[2]);
    const T dx = to[0] - from[0], dy = to[1] - from[1];
    const T ux = c * dx + s * dy - measured.position.x();
    const T uy = -s * dx + c * dy - measured.position.y();
    const double cm = std::cos(measured.heading), sm = std::sin(measured.heading);
    const T angle = to[2] - from[2] - measured.heading;
    Eigen::Map<Eigen::Matrix<T, 3, 1>> e(residuals);
    e << cm * ux + sm * uy, -sm * ux + cm * uy,
        angle - T(2 * pi) * floor((angle + T(pi)) / T(2 * pi));
    e.applyOnTheLeft(root.cast<T>());
    return true;
  }
};

double solved_by_ceres(ceres::Problem& problem) {
  ceres::Solver::Summary summary;
  ceres::Solve(ceres_options(), &problem, &summary);
  return 2 * summary.final_cost;
}

double ceres_chi2(const PoseGraph& graph, const std::vector<Pose>& start) {
  std::vector<std::array<double, 3>> positions;
  std::vector<std::array<double, 4>> rotations;
  for (const Pose& pose : start) {
    const Eigen::Quaterniond q(pose.linear());
    positions.push_back({pose.translation().x(), pose.translation().y(), pose.translation().z()});
    rotations.push_back({q.x(), q.y(), q.z(), q.w()});
  }
  ceres::EigenQuaternionManifold manifold;
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(options);
  for (const Edge& edge : graph.edges) {
    const auto residual = new ceres::AutoDiffCostFunction<SpatialResidual, 6, 3, 4, 3, 4>(
        new SpatialResidual{Eigen::Quaterniond(edge.from_from_to.linear()),
                            edge.from_from_to.translation(), edge.information.llt().matrixU()});
    problem.AddResidualBlock(residual, nullptr, positions[edge.from].data(),
                             rotations[edge.from].data(), positions[edge.to].data(),
                             rotations[edge.to].data());
  }
  for (auto& rotation : rotations) problem.SetManifold(rotation.data(), &manifold);
  problem.SetParameterBlockConstant(positions[0].data());
  problem.SetParameterBlockConstant(rotations[0].data());
  return solved_by_ceres(problem);
}

double ceres_chi2(const PlanarPoseGraph& graph, const std::vector<PlanarPose>& start) {
  std::vector<std::array<double, 3>> poses;
  for (const PlanarPose& pose : start)
    poses.push_back({pose.position.x(), pose.position.y(), pose.heading});
  ceres::Problem problem;
  for (const PlanarEdge& edge : graph.edges)
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PlanarResidual, 3, 3, 3>(
            new PlanarResidual{edge.from_from_to, edge.information.llt().matrixU()}),
        nullptr, poses[edge.from].data(), poses[edge.to].data());
  problem.SetParameterBlockConstant(poses[0].data());
  return solved_by_ceres(problem);
}

template <class Graph>
void compare(const char* name, const Graph& graph, double optimum) {
  const GraphParams params = {.covariances = false};
  const auto chordal =
      optimize(graph, {.start = GraphStart::edges, .max_iterations = 0, .covariances = false});
  double own = 0, with_covariances = 0, peer = 0, peer_chordal = 0;
  int iterations = 0;
  const double own_ms = median_ms([&] {
    const GraphQuality quality = optimize(graph, params).quality;
    own = quality.cost_after;
    iterations = quality.iterations;
  });
  const double covariances_ms =
      median_ms([&] { with_covariances = optimize(graph).quality.cost_after; });
  const double peer_ms = median_ms([&] { peer = ceres_chi2(graph, graph.poses); });
  const double chordal_ms = median_ms([&] { peer_chordal = ceres_chi2(graph, chordal.poses); });
  fmt::print(
      "{:15} {:12.9g} {:+9.1e} {:8.1f} {:10.1f} {:5} {:13.6g} {:8.1f} {:6.1f} {:13.6g} {:8.1f}\n",
      name, own, own / optimum - 1, own_ms, covariances_ms, iterations, peer, peer_ms,
      peer_ms / own_ms, peer_chordal, chordal_ms);
}

}  // namespace

int main() {
  const auto folder =
      std::filesystem::path(PLANUM_SOURCE_DIR).parent_path() / "shared/datasets/pose_graphs";
  fmt::print("medians of {} runs, {} threads, ms\n", repetitions, thread_count());
  fmt::print("{:15} {:>12} {:>9} {:>8} {:>10} {:>5} {:>13} {:>8} {:>6} {:>13} {:>8}\n", "", "chi2",
             "optimum", "time", "with cov.", "iter.", "Ceres chi2", "time", "ratio", "from chordal",
             "time");
  const std::pair<const char*, double> graphs[] = {
      {"tinyGrid3D", 6.7278816}, {"smallGrid3D", 458.15378}, {"parking-garage", 1.2386906},
      {"sphere2500", 727.14967}, {"intel", 45.004696},       {"MIT", 41.163269}};
  for (const auto& [name, optimum] : graphs) {
    const G2oGraph file = read_g2o(folder / (std::string(name) + ".g2o"));
    const G2oIndex index = g2o_index(file);
    if (file.planar)
      compare(name, planar_graph(file, index), optimum);
    else
      compare(name, spatial_graph(file, index), optimum);
  }
}
