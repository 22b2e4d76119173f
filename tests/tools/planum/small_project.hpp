#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "slam/core/error.hpp"
#include "slam/io/slices.hpp"
#include "slam/io/tum.hpp"
#include "slam/sensor/building.hpp"
#include "slam/sensor/odometry_drift.hpp"
#include "slam/sensor/simulator.hpp"
#include "tests/tools/planum/program.hpp"

namespace planum::testing {

/// Places in the small room, in its frame.
inline std::vector<Pose> small_room_poses() {
  std::vector<Pose> poses;
  for (int i = 0; i < 4; ++i) {
    poses.push_back(pose_from_xyz_ypr({1.2 + 0.6 * i, 1.5 + 0.2 * i, 0.6}, 0.5 * i, 0, 0));
  }
  return poses;
}

/// An L-shaped room and a corner of another, scanned coarsely from four places.
inline Building small_room() {
  BuildingPlan plan;
  plan.name = "small room";
  RoomPlan room;
  room.name = "room";
  room.walls.outer = {{0, 0}, {4.2, 0}, {4.2, 3.1}, {2.6, 3.1}, {2.6, 4.4}, {0, 4.4}};
  room.height = 2.5;
  plan.rooms = {room};
  plan.furniture = {{{3.2, 0.6, 0}, {0.8, 0.6, 0.75}, 0.2}};
  return built(plan);
}

/// Writes scans/scanNNN.slices, odometry.tum, truth.tum and project.toml.
inline void write_small_project(const std::filesystem::path& directory) {
  const std::vector<Pose> poses = small_room_poses();
  const auto odometry = drifted(poses, {.seed = 3});
  const SimulatorParams simulator = {.beams = 181, .slices = 70};
  const auto scans = simulate_scans(small_room().mesh.mesh, poses, simulator);
  std::filesystem::create_directories(directory / "scans");
  Trajectory truth, drifting;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    write_slices(directory / ("scans/scan00" + std::to_string(i) + ".slices"), scans[i].scan);
    truth.push_back({static_cast<double>(i), poses[0].inverse() * poses[i]});
    drifting.push_back({static_cast<double>(i), poses[0].inverse() * odometry[i]});
  }
  write_tum(directory / "truth.tum", truth);
  write_tum(directory / "odometry.tum", drifting);
  std::ofstream(directory / "project.toml") << "version = 1\n"
                                               "[scans]\n"
                                               "directory = \"scans\"\n"
                                               "poses = \"odometry.tum\"\n"
                                               "[evaluation]\n"
                                               "truth = \"truth.tum\"\n";
}

/// Every file of an output directory but what the workflow keeps for itself: name -> content.
inline std::map<std::string, std::string> result_files(const std::filesystem::path& output) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(output)) {
    const std::string name = entry.path().lexically_relative(output).string();
    if (entry.is_regular_file() && !name.starts_with(".cache/")) {
      files[name] = file_text(entry.path());
    }
  }
  return files;
}

}  // namespace planum::testing
