#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/parallel.hpp"
#include "slam/io/scan_directory.hpp"
#include "slam/io/slices.hpp"
#include "slam/io/tum.hpp"
#include "slam/io/uos.hpp"
#include "slam/io/xyz.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/sensor/demo_building.hpp"
#include "slam/sensor/random_building.hpp"
#include "slam/sensor/range_limits.hpp"
#include "slam/sensor/simulator.hpp"
#include "slam/sensor/tilted_laser.hpp"
#include "tests/benchmarks/ring_building.hpp"

namespace planum::testing {

/// Scans and where they were taken.
struct Scene {
  std::string name;
  std::vector<MatchingScan> scans = {};
  std::vector<Pose> truth = {};  ///< world_from_scan
};

inline std::vector<MatchingScan> matching_scans(const std::vector<Cloud>& clouds) {
  std::vector<std::optional<MatchingScan>> ready(clouds.size());
  parallel_for(clouds.size(), 1, [&](std::size_t i, std::size_t) {
    ready[i] = matching_scan(limited(clouds[i]).cloud);
  });
  std::vector<MatchingScan> result;
  for (auto& scan : ready) result.push_back(std::move(*scan));
  return result;
}

inline Scene simulated_scene(const std::string& name, const Building& building,
                             const std::vector<Pose>& poses) {
  std::vector<Cloud> clouds;
  for (const SimulatedScan& scan : simulate_scans(building.mesh.mesh, poses))
    clouds.push_back(points_from_slices(scan.scan).cloud);
  return {name, matching_scans(clouds), poses};
}

/// The points of a legacy ASCII VTK file.
inline Cloud read_vtk_points(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::string word;
  while (in >> word && word != "POINTS") {
  }
  std::size_t count = 0;
  in >> count >> word;
  Cloud cloud;
  cloud.points.resize(count);
  for (Eigen::Vector3f& p : cloud.points) in >> p.x() >> p.y() >> p.z();
  return cloud;
}

inline std::filesystem::path data_folder() {
  return std::filesystem::path(PLANUM_SOURCE_DIR).parent_path() / "shared" / "datasets";
}

inline Scene classroom() {
  Scene scene{.name = "classroom"};
  std::vector<Cloud> clouds;
  for (const ScanFile& file : list_scans(data_folder() / "classroom", "slices").scans)
    clouds.push_back(points_from_slices(read_slices(file.file)).cloud);
  scene.scans = matching_scans(clouds);
  for (const auto& stamped : read_tum(data_folder() / "classroom" / "truth.tum"))
    scene.truth.push_back(stamped.pose);
  return scene;
}

/// With the reference of the data's README.
inline Scene kurt3d_corridor() {
  std::vector<Cloud> clouds;
  for (const std::string name : {"scan000", "scan001", "scan002"})
    clouds.push_back(read_uos_scan(data_folder() / "kurt3d_corridor" / (name + ".3d")));
  return {"kurt3d_corridor",
          matching_scans(clouds),
          {Pose::Identity(), pose_from_uos({-3.809, -5.898, 156.411}, {1.308, -0.828, -0.516}),
           pose_from_uos({-8.262, -13.725, 339.371}, {0.367, -0.488, -0.309})}};
}

/// With the reference of the data's README.
inline Scene eth_apartment() {
  const auto folder = data_folder() / "eth_apartment";
  return {"eth_apartment",
          matching_scans(
              {read_vtk_points(folder / "cloud_0.vtk"), read_vtk_points(folder / "cloud_1.vtk")}),
          {Pose::Identity(), pose_from_xyz_ypr({0.6139, -0.0132, 0.0056}, radians(6.65), 0, 0)}};
}

/// One scan, which nothing else should be taken for.
inline Scene entrance_hall() {
  Cloud cloud = read_xyz(data_folder() / "entrance_hall" / "scan.dat");
  cloud = transformed(cloud, Pose(Eigen::Translation3d(0, 0, -0.5)));
  return {"entrance_hall", matching_scans({cloud}), {Pose::Identity()}};
}

/// Calls body(scene) for each scene whose name has `wanted` in it.
template <typename Body>
void for_each_scene(const std::string& wanted, const Body& body) {
  const auto take = [&](const std::string& name, const auto& scene) {
    if (name.find(wanted) != std::string::npos) body(scene());
  };
  take("demo_building",
       [] { return simulated_scene("demo_building", demo_building(), demo_poses()); });
  take("ring_building", [] {
    const RingBuilding ring = ring_building();
    return simulated_scene("ring_building", ring.building, ring.poses);
  });
  for (const std::uint64_t seed : {1, 2, 3}) {
    const std::string name = fmt::format("random_building_{}", seed);
    take(name, [&] {
      const RandomBuilding random = random_building(seed, 6);
      return simulated_scene(name, random.building, random.poses);
    });
  }
  if (!std::filesystem::exists(data_folder())) return;
  take("classroom", classroom);
  take("kurt3d_corridor", kurt3d_corridor);
  take("eth_apartment", eth_apartment);
  take("entrance_hall", entrance_hall);
}

}  // namespace planum::testing
