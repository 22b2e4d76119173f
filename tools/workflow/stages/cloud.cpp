#include <fmt/format.h>

#include "meshing/free_space.hpp"
#include "meshing/level_planes.hpp"
#include "meshing/normals.hpp"
#include "meshing/up_direction.hpp"
#include "slam/io/frames.hpp"
#include "slam/io/g2o.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/tum.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"
#include "tools/workflow/trajectory_figures.hpp"

namespace planum {
namespace {

World unlevelled_world(const Imported& imported, const Relaxed& relaxed) {
  World world;
  for (const Scan& scan : imported.scans) {
    world.numbers.push_back(static_cast<std::uint32_t>(scan.number));
    world.odometry.push_back(scan.world_from_scan);
  }
  world.poses = relaxed.graph.poses;
  world.is_mapped.assign(world.poses.size(), 0);
  for (const std::size_t scan : relaxed.components.front()) world.is_mapped[scan] = 1;
  return world;
}

/// The points of all mapped scans; a point's scan is its position in the list of all scans.
Cloud consistent_cloud(const Imported& imported, const World& world) {
  std::vector<Scan> scans;
  for (std::size_t i = 0; i < imported.scans.size(); ++i) {
    const Scan& scan = imported.scans[i];
    scans.push_back({scan.id, scan.number, world.poses[i], {}});
    if (world.is_mapped[i]) scans.back().cloud = scan.cloud;
  }
  return merged(scans);
}

/// Turns the world about the place of the first scan, so that it stays where its pose file has it.
/// False if there is no floor to go by.
bool level(World& world, Cloud& cloud) {
  const auto found = estimate_up(cloud.normals, {}, Eigen::Vector3d::UnitZ());
  if (!found) return false;
  const Eigen::Vector3d pivot = world.odometry.front().translation();
  const Eigen::Vector3d up = up_of_planes(cloud, found->up);
  const auto turn = turn_between(up, Eigen::Vector3d::UnitZ());
  world.world_from_input = Eigen::Translation3d(pivot) * turn * Eigen::Translation3d(-pivot);
  world.up_confidence = found->confidence;
  cloud = transformed(cloud, world.world_from_input);
  for (std::vector<Pose>* poses : {&world.odometry, &world.poses}) {
    for (Pose& pose : *poses) pose = orthonormalized(world.world_from_input * pose);
  }
  return true;
}

G2oGraph g2o_graph(const Imported& imported, const Relaxed& relaxed, const World& world) {
  const auto id = [&](std::size_t scan) { return imported.scans[scan].number; };
  G2oGraph graph;
  for (std::size_t i = 0; i < world.poses.size(); ++i) {
    graph.vertices.push_back({id(i), world.poses[i]});
  }
  graph.fixed = {id(relaxed.components.front().front())};
  for (const Edge& edge : relaxed.graph.edges) {
    if (edge.accepted) {
      graph.edges.push_back(
          {id(edge.from), id(edge.to), edge.from_from_to, g2o_from_information(edge.information)});
    } else {
      graph.comments.push_back(
          fmt::format("rejected {} {}: {}", id(edge.from), id(edge.to), edge.reason));
    }
  }
  return graph;
}

/// For viewers of 3DTK: where each scan was at first, after matching, and at last.
void write_all_frames(const std::filesystem::path& directory, const Imported& imported,
                      const SequenceMatch& registered, const World& world) {
  std::filesystem::create_directories(directory);
  for (std::size_t i = 0; i < world.poses.size(); ++i) {
    const Pose after_matching = world.world_from_input * registered.poses[i];
    const Frame frames[] = {
        {world.odometry[i], FrameKind::icp},
        {after_matching, FrameKind::icp},
        {world.poses[i], world.is_mapped[i] ? FrameKind::lum : FrameKind::invalid}};
    write_frames(directory / (imported.scans[i].id + ".frames"), frames);
  }
}

void write_poses(StageContext& context, const Imported& imported, const World& world) {
  write_tum(context.staging / "trajectory.tum", mapped_trajectory(imported, world));
  write_tum(context.staging / "odometry.tum", odometry_trajectory(imported, world));
  write_g2o(context.staging / "graph.g2o",
            g2o_graph(imported, context.results.relaxed.get(), world));
  write_all_frames(context.staging / "frames", imported, context.results.registered.get(), world);
}

void work(StageContext& context) {
  const Imported& imported = context.results.imported.get();
  World world = unlevelled_world(imported, context.results.relaxed.get());
  Cloud cloud = consistent_cloud(imported, world);
  cloud.normals = estimate_normals(cloud, scan_origins(world), context.project.settings.normals,
                                   context.progress);
  const std::size_t seen_through =
      drop_normals_in_free_space(cloud, scan_origins(world), context.project.settings.free_space);
  if (context.project.settings.level && !level(world, cloud)) {
    context.record.warnings.push_back(
        "no floor or ceiling was found, so the world is not levelled");
  }
  write_ply(context.staging / "cloud.ply", with_scan_numbers(cloud, world));
  write_poses(context, imported, world);
  write_result(context.result, world);
  context.record.summary = fmt::format(
      "{} points, {} of them in free space; world turned by {:.2f} degrees to be level",
      cloud.points.size(), seen_through, degrees(rotation_angle(world.world_from_input)));
  context.results.world.set(std::move(world));
  context.results.cloud.set(std::move(cloud));
}

}  // namespace

Stage cloud_stage() {
  return {.name = "cloud",
          .version = 4,
          .unit = "steps",
          .needs = {"import", "register", "relax"},
          .parameters = {"world", "cloud"},
          .input_files = {},
          .work = work};
}

}  // namespace planum
