#include "tools/planum/demo_case.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/io/atomic_file.hpp"
#include "slam/io/obj.hpp"
#include "slam/io/pose_list.hpp"
#include "slam/sensor/demo_building.hpp"
#include "tools/planum/simulated_scans.hpp"
#include "tools/workflow/project.hpp"

namespace planum {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t seed = 1;

std::string dimensions_json(const Building& building) {
  Json rooms = Json::array(), doors = Json::array();
  for (const TrueRoom& room : building.rooms) {
    rooms.push_back({{"name", room.name},
                     {"width", room.width},
                     {"depth", room.depth},
                     {"height", room.height},
                     {"centre", {room.centre.x(), room.centre.y()}}});
  }
  for (const TrueDoor& door : building.doors) {
    doors.push_back({{"between", door.between},
                     {"width", door.width},
                     {"height", door.height},
                     {"centre", {door.centre.x(), door.centre.y(), door.centre.z()}}});
  }
  const Json json = {{"name", building.name},
                     {"turn_deg", degrees(building.turn)},
                     {"rooms", rooms},
                     {"doors", doors}};
  return json.dump(1) + "\n";
}

void write_if_missing(const fs::path& file, const std::string& text) {
  if (!fs::exists(file)) write_file_atomically(file, text);
}

}  // namespace

void write_demo_case(const fs::path& directory, const Building& building, Console& console) {
  fs::create_directories(directory / "scans");
  const std::vector<Pose> poses = demo_poses();
  write_if_missing(directory / "dimensions.json", dimensions_json(building));
  if (!fs::exists(directory / "building.obj")) write_obj(directory / "building.obj", building.mesh);
  if (!fs::exists(directory / "true_poses.txt")) {
    write_pose_list(directory / "true_poses.txt", poses);
  }
  SimulatorParams simulator;
  simulator.seed = seed;
  DriftParams drift;
  drift.seed = seed;
  const Progress progress = console.start_bar("simulate", "scans");
  write_simulated_trajectories(directory, poses, drift);
  write_simulated_scans(directory / "scans", building.mesh.mesh, poses, simulator, progress);
  console.end_bar();
  write_if_missing(directory / "project.toml",
                   project_template({{"scans.directory", "\"scans\""},
                                     {"scans.format", "\"slices\""},
                                     {"scans.poses", "\"odometry.tum\""},
                                     {"evaluation.truth", "\"truth.tum\""}}));
}

}  // namespace planum
