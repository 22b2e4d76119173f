#include "slam/graph/information_repair.hpp"

#include <Eigen/Cholesky>

#include "slam/core/symmetric_eigen.hpp"
#include "slam/graph/planar_pose_graph.hpp"

namespace planum {
namespace {

constexpr double rounding = 1e-9;

template <class Matrix>
bool positive_semidefinite(Matrix information) {
  const double largest = information.diagonal().maxCoeff();
  information.diagonal().array() += rounding * largest;
  return largest > 0 && Eigen::LLT<Matrix>(information).info() == Eigen::Success;
}

}  // namespace

template <class Graph>
std::vector<RepairedInformation> repair_information(Graph& graph) {
  std::vector<RepairedInformation> repaired;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    auto& information = graph.edges[i].information;
    information = (0.5 * (information + information.transpose())).eval();
    if (positive_semidefinite(information)) continue;
    const auto [values, vectors] = symmetric_eigen(information);
    if (values[0] >= -rounding * values.cwiseAbs().maxCoeff()) continue;
    information = vectors * values.cwiseMax(0).asDiagonal() * vectors.transpose();
    repaired.push_back({.edge = i, .least_eigenvalue = values[0]});
  }
  return repaired;
}

template std::vector<RepairedInformation> repair_information(PoseGraph&);
template std::vector<RepairedInformation> repair_information(PlanarPoseGraph&);

}  // namespace planum
