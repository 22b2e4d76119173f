#pragma once

#include <span>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/graph/pose_graph.hpp"

namespace planum {

/// Which of some loops agree with each other: two do if the cycle they form with the paths between
/// their ends comes back to where it began, within `max_deviation` standard deviations of all four.
/// What counts is the largest group in which all agree with all (pairwise consistency: Mangelson,
/// Dominic, Eustice & Vasudevan, ICRA 2018), found greedily from every loop in turn; of groups as
/// large the one with the smaller sum of deviations. True for its members.
/// `graph` has the path, with poses that suit its edges; `covariances` are those of the errors of
/// the loops in the sense of Edge::information; `step_noise` is added to that of each edge.
std::vector<bool> consistent_loops(const PoseGraph& graph, std::span<const Edge> loops,
                                   std::span<const Matrix6d> covariances,
                                   const Matrix6d& step_noise, double max_deviation);

}  // namespace planum
