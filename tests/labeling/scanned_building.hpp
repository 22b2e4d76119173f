#pragma once

#include <algorithm>
#include <vector>

#include "labeling/rooms/rooms.hpp"
#include "meshing/normals.hpp"
#include "slam/sensor/building.hpp"
#include "slam/sensor/simulator.hpp"
#include "slam/sensor/tilted_laser.hpp"

namespace planum::testing {

/// A merged cloud with normals and the places it was scanned from.
struct ScannedWorld {
  Cloud cloud;
  std::vector<Eigen::Vector3d> origins;
};

/// The scans of a model at their true poses, with noise, drop-outs and mixed pixels.
inline ScannedWorld scanned(const TriangleMesh& model, const std::vector<Pose>& poses,
                            SimulatorParams params = {.beams = 181, .slices = 120}) {
  ScannedWorld world;
  std::vector<Scan> scans;
  for (const SimulatedScan& simulated : simulate_scans(model, poses, params)) {
    Scan scan;
    scan.world_from_scan = poses[scans.size()];
    scan.cloud = points_from_slices(simulated.scan).cloud;
    world.origins.push_back(scan.world_from_scan.translation());
    scans.push_back(std::move(scan));
  }
  world.cloud = merged(scans);
  world.cloud.normals = estimate_normals(world.cloud, world.origins);
  return world;
}

inline ScannedWorld moved(const ScannedWorld& world, const Pose& b_from_a) {
  ScannedWorld result{transformed(world.cloud, b_from_a), {}};
  for (const Eigen::Vector3d& origin : world.origins) result.origins.push_back(b_from_a * origin);
  return result;
}

inline RoomMap rooms_in(const ScannedWorld& world, const PolygonMap& map = {}) {
  return find_rooms(world.cloud, world.origins, map);
}

inline std::size_t count(const RoomMap& rooms, OpeningKind kind) {
  return static_cast<std::size_t>(
      std::count_if(rooms.openings.begin(), rooms.openings.end(),
                    [&](const Opening& opening) { return opening.kind == kind; }));
}

/// The opening nearest to a place in plan, or null if none is within a metre.
inline const Opening* opening_at(const RoomMap& rooms, const Eigen::Vector3d& place) {
  const Opening* best = nullptr;
  double best_distance = 1;
  for (const Opening& opening : rooms.openings) {
    const double distance = (opening.position - place).head<2>().norm();
    if (distance < best_distance) {
      best = &opening;
      best_distance = distance;
    }
  }
  return best;
}

/// The room nearest to a place in plan, or null if none is within 1.5 m.
inline const Room* room_at(const RoomMap& rooms, const Eigen::Vector2d& place) {
  const Room* best = nullptr;
  double best_distance = 1.5;
  for (const Room& room : rooms.rooms) {
    const double distance = (room.centre.head<2>() - place).norm();
    if (distance < best_distance) {
      best = &room;
      best_distance = distance;
    }
  }
  return best;
}

/// A model made of rectangles, to be scanned.
class ModelMaker {
 public:
  /// The rectangle from `corner` along two edges.
  void rectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& a,
                 const Eigen::Vector3d& b) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3d& p : {corner, Eigen::Vector3d(corner + a),
                                     Eigen::Vector3d(corner + a + b), Eigen::Vector3d(corner + b)})
      mesh.vertices.push_back(p.cast<float>());
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }

  /// A wall in the plane x == x0, with a rectangular hole (y and z limits) if it has any size.
  void wall_across_x(double x, const Eigen::Vector2d& y, const Eigen::Vector2d& z,
                     const Eigen::Vector2d& hole_y = {0, 0},
                     const Eigen::Vector2d& hole_z = {0, 0}) {
    const auto part = [&](double y0, double y1, double z0, double z1) {
      if (y1 > y0 && z1 > z0) rectangle({x, y0, z0}, {0, y1 - y0, 0}, {0, 0, z1 - z0});
    };
    if (hole_y[1] <= hole_y[0]) return part(y[0], y[1], z[0], z[1]);
    part(y[0], hole_y[0], z[0], z[1]);
    part(hole_y[1], y[1], z[0], z[1]);
    part(hole_y[0], hole_y[1], z[0], hole_z[0]);
    part(hole_y[0], hole_y[1], hole_z[1], z[1]);
  }

  /// Floor, ceiling and the two walls along x of a room; those across x are up to the caller.
  void tunnel(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    const Eigen::Vector3d size = high - low;
    const Eigen::Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
    rectangle(low, x, y);
    rectangle(low + z, x, y);
    rectangle(low, x, z);
    rectangle(low + y, x, z);
  }

  TriangleMesh mesh;
};

}  // namespace planum::testing
