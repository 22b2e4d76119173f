#include "tools/planum/simulated_scans.hpp"

#include <fmt/format.h>

#include "slam/io/slices.hpp"
#include "slam/io/tum.hpp"

namespace planum {
namespace {

/// Poses relative to the first one, stamped 0, 1, 2 ...
Trajectory from_first(std::span<const Pose> poses) {
  Trajectory trajectory;
  for (const Pose& pose : poses) {
    const auto stamp = static_cast<double>(trajectory.size());
    trajectory.push_back({stamp, orthonormalized(poses.front().inverse() * pose)});
  }
  return trajectory;
}

}  // namespace

void write_simulated_scans(const std::filesystem::path& directory, const TriangleMesh& model,
                           std::span<const Pose> model_from_scan, const SimulatorParams& params,
                           const Progress& progress) {
  std::filesystem::create_directories(directory);
  const RayCaster caster(model);
  for (std::size_t i = 0; i < model_from_scan.size(); ++i) {
    const auto file = directory / fmt::format("scan{:03}.slices", i);
    if (!std::filesystem::exists(file)) {
      write_slices(file, simulate_scan(caster, model_from_scan[i], i, params).scan);
    }
    progress.report(i + 1, model_from_scan.size());
  }
}

void write_simulated_trajectories(const std::filesystem::path& directory,
                                  std::span<const Pose> model_from_scan, const DriftParams& drift) {
  if (!std::filesystem::exists(directory / "truth.tum")) {
    write_tum(directory / "truth.tum", from_first(model_from_scan));
  }
  if (!std::filesystem::exists(directory / "odometry.tum")) {
    write_tum(directory / "odometry.tum", from_first(drifted(model_from_scan, drift)));
  }
}

}  // namespace planum
