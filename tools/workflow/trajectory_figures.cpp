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

TrajectoryFigures trajectory_figures(const TrajectoryError& error, const SegmentError& segments) {
  TrajectoryFigures figures{.ate_rmse = error.ape_translation.rmse,
                            .ate_max = error.ape_translation.max,
                            .rot_mean = radians(error.ape_rotation.mean),
                            .rot_max = radians(error.ape_rotation.max),
                            .rpe_trans = error.rpe_translation.rmse,
                            .rpe_rot = radians(error.rpe_rotation.rmse),
                            .drift = {}};
  if (segments.translation.count > 0)
    figures.drift = {.trans = segments.translation.mean,
                     .rot = radians(segments.rotation.mean),
                     .segments = segments.translation.count};
  return figures;
}

}  // namespace planum
