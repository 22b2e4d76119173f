#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "slam/core/pose.hpp"
#include "slam/graph/pose_manifold.hpp"

namespace planum::testing {

template <int N>
Eigen::Matrix<double, N, 1> normal_vector(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, N, 1> v;
  for (double& value : v.reshaped()) value = normal(random);
  return v;
}

inline Pose turned_pose(std::mt19937& random, double shift) {
  const Eigen::Vector4d q = normal_vector<4>(random).normalized();
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(q).toRotationMatrix();
  pose.translation() = shift * normal_vector<3>(random);
  return pose;
}

/// A graph with known truth.
template <class Manifold>
struct SyntheticGraph {
  typename Manifold::GraphType graph;                ///< its poses: odometry, added up
  std::vector<typename Manifold::PoseType> truth{};  ///< pose 0 as in the graph
  std::vector<bool> false_loop{};                    ///< of each edge
};

/// Odometry of two laps and `loops` loops between places less than 3 m apart (one in `false_share`
/// of them false: measured as if it were elsewhere), with noise that is as the information says.
template <class Manifold>
SyntheticGraph<Manifold> synthetic_graph(std::size_t count, std::size_t loops, double false_share,
                                         unsigned seed);

/// rms distance of positions, m.
template <class Manifold>
double position_rms(const std::vector<typename Manifold::PoseType>& a,
                    const std::vector<typename Manifold::PoseType>& b);

}  // namespace planum::testing
