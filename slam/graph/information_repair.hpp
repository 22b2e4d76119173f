#pragma once

#include <cstddef>
#include <vector>

namespace planum {

/// An edge whose information matrix says less than nothing about some direction.
struct RepairedInformation {
  std::size_t edge = 0;
  double least_eigenvalue = 0;  ///< negative
};

/// Makes the information of each edge of a graph (in space or in the plane) symmetric and positive
/// semidefinite: negative eigenvalues become 0, the nearest such matrix (Higham 1988). Rounding,
/// 1e-9 of the largest diagonal element, is let be. Tells which were repaired.
template <class Graph>
std::vector<RepairedInformation> repair_information(Graph& graph);

}  // namespace planum
