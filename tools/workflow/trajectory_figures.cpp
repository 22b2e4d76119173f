#include "tools/workflow/trajectory_figures.hpp"

namespace planum {

Trajectory mapped_trajectory(const Imported& imported, const World& world) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < world.poses.size(); ++i) {
    if (!world.is_mapped[i]) continue;
    trajectory.push_back({static_cast<double>(imported.scans[i].number), world.poses[i]});
  }
  return trajectory;
}

Trajectory odometry_trajectory(const Imported& imported, const World& world) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < world.odometry.size(); ++i) {
    trajectory.push_back({static_cast<double>(imported.scans[i].number), world.odometry[i]});
  }
  return trajectory;
}

TrajectoryFigures trajectory_figures(const Trajectory&, const Trajectory&) { return {}; }

Pose truth_from_estimate(const Trajectory&, const Trajectory&) { return Pose::Identity(); }

}  // namespace planum
