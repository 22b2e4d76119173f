#include "tools/maps/octomap_map.hpp"

#include <cstdlib>
#include <limits>
#include <memory>
#include <octomap/OcTree.h>
#include <octomap/ScanGraph.h>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::Draws;
using testing::error_of;
using testing::TemporaryDirectory;
using testing::text_of;

struct Scans {
  Cloud cloud;
  std::vector<Eigen::Vector3d> origins;

  octomap::Pointcloud points_of(std::size_t scan) const {
    octomap::Pointcloud result;
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
      if (const Eigen::Vector3f& p = cloud.points[i]; cloud.scan[i] == scan)
        result.push_back(p.x(), p.y(), p.z());
    return result;
  }

  octomap::point3d origin_of(std::size_t scan) const {
    const Eigen::Vector3f p = origins[scan].cast<float>();
    return {p.x(), p.y(), p.z()};
  }
};

/// The walls of a room as seen from different places, with somebody in it who walks about.
Scans scans_of_a_room(std::size_t scans = 20, std::size_t points = 1500) {
  Draws draws(7);
  Scans result;
  for (std::size_t scan = 0; scan < scans; ++scan) {
    const Eigen::Vector3d origin(draws.uniform(-2, 2), draws.uniform(-1, 1), draws.uniform(1, 2));
    const Eigen::Vector3d somebody(draws.uniform(-2, 2), draws.uniform(-1, 1), 1);
    result.origins.push_back(origin);
    for (std::size_t i = 0; i < points; ++i) {
      const Eigen::Vector3d direction = draws.vector(1).normalized();
      const Eigen::Array3d to_low =
                               (Eigen::Array3d(-3, -2, 0) - origin.array()) / direction.array(),
                           to_high = (Eigen::Array3d(3, 2, 3) - origin.array()) / direction.array();
      const double range = to_low.max(to_high).minCoeff() + draws.uniform(-0.02, 0.02);
      const Eigen::Vector3d end =
          i % 10 == 0 ? Eigen::Vector3d(somebody + draws.vector(0.3)) : origin + range * direction;
      result.cloud.points.push_back(end.cast<float>());
      result.cloud.scan.push_back(static_cast<std::uint32_t>(scan));
    }
  }
  return result;
}

/// As OctoMap does it, scan after scan.
std::unique_ptr<octomap::OcTree> grown_tree(const Scans& scans, double cell) {
  auto tree = std::make_unique<octomap::OcTree>(cell);
  for (std::size_t scan = 0; scan < scans.origins.size(); ++scan)
    tree->insertPointCloud(scans.points_of(scan), scans.origin_of(scan), -1, false, true);
  return tree;
}

void expect_same_trees(const Scans& scans, double cell) {
  const TemporaryDirectory directory;
  write_octomap(directory / "map.bt", scans.cloud, scans.origins, {.cell = cell});
  const auto expected = grown_tree(scans, cell);
  const std::unique_ptr<octomap::AbstractOcTree> full(
      octomap::AbstractOcTree::read((directory / "map.ot").string()));
  ASSERT_TRUE(full);
  EXPECT_GT(full->size(), 100u);
  EXPECT_TRUE(dynamic_cast<octomap::OcTree&>(*full) == *expected) << "cells of " << cell << " m";
  expected->toMaxLikelihood();
  expected->prune();
  const octomap::OcTree likely((directory / "map.bt").string());
  EXPECT_TRUE(likely == *expected) << "cells of " << cell << " m";
}

/// What a program of OctoMap prints.
std::string output_of(const TemporaryDirectory& directory, const std::string& command) {
  const std::string log = (directory / "log").string();
  EXPECT_EQ(
      std::system(
          ("cd " + directory.path().string() + " && " + command + " >" + log + " 2>&1").c_str()),
      0)
      << command << " (of the Debian package octomap-tools)\n"
      << text_of(log);
  return text_of(log);
}

TEST(OctomapMap, IsTheTreeThatOctomapGrowsFromTheScans) {
  const Scans scans = scans_of_a_room();
  for (const double cell : {0.07, 0.1, 0.37}) expect_same_trees(scans, cell);
}

TEST(OctomapMap, IsTheTreeThatOctomapGrowsOfRaysAlongTheAxesAndBetweenCells) {
  Scans scans;
  scans.origins = {{0, 0, 0}, {0.25, -0.5, 1}, {-3, 2, 0.125}, {1e-9, -1e-9, 0.05}};
  for (std::uint32_t scan = 0; scan < 4; ++scan)
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y)
        for (int z = -2; z <= 2; ++z) {
          const Eigen::Vector3d way(x, y, z);
          for (const double size : {0.0, 0.01, 0.05, 1.0, 8.0}) {
            scans.cloud.points.push_back((scans.origins[scan] + size * way).cast<float>());
            scans.cloud.scan.push_back(scan);
          }
        }
  expect_same_trees(scans, 0.05);
}

TEST(OctomapMap, HasNoDivergenceFromTheTreeOfOctomapsTools) {
  const TemporaryDirectory directory;
  const Scans scans = scans_of_a_room();
  octomap::ScanGraph graph;
  for (std::size_t scan = 0; scan < scans.origins.size(); ++scan)
    graph.addNode(new octomap::Pointcloud(scans.points_of(scan)),
                  octomap::pose6d(scans.origin_of(scan), octomath::Quaternion()));
  ASSERT_TRUE(graph.writeBinary((directory / "scans.graph").string()));
  write_octomap(directory / "map.bt", scans.cloud, scans.origins, {.cell = 0.1});
  output_of(directory, "graph2tree -g -discretize -res 0.1 -i scans.graph -o tools.bt");
  const std::string compared = output_of(directory, "compare_octrees map.ot tools.bt.ot");
  EXPECT_NE(compared.find("KLD: 0\n"), std::string::npos) << compared;
}

TEST(OctomapMap, IsTheSameForAnyNumberOfThreads) {
  const Scans scans = scans_of_a_room();
  const TemporaryDirectory directory;
  const int threads = thread_count();
  for (const int count : {1, 4}) {
    set_thread_count(count);
    write_octomap(directory / fmt::format("{}.bt", count), scans.cloud, scans.origins);
  }
  set_thread_count(threads);
  EXPECT_EQ(text_of(directory / "1.bt"), text_of(directory / "4.bt"));
  EXPECT_EQ(text_of(directory / "1.ot"), text_of(directory / "4.ot"));
}

TEST(OctomapMap, RefusesWhatOctomapCannotHold) {
  const TemporaryDirectory directory;
  const auto path = directory / "map.bt";
  const auto message = [&](const Cloud& cloud, const std::vector<Eigen::Vector3d>& origins,
                           double cell) {
    return error_of([&] { write_octomap(path, cloud, origins, {.cell = cell}); });
  };
  Cloud cloud;
  const std::vector<Eigen::Vector3d> origin = {{0, 0, 0}};
  EXPECT_EQ(message(cloud, origin, 0.1), path.string() + ": there are no points for it");
  cloud.points = {{1, 2, 3}};
  EXPECT_EQ(message(cloud, {}, 0.1),
            path.string() + ": it is not known where the scans were taken");
  EXPECT_NE(message(cloud, origin, 0), "");
  cloud.scan = {1};
  EXPECT_EQ(message(cloud, origin, 0.1), path.string() + ": a point is of scan 1 of 1");
  cloud.scan = {0};
  cloud.points = {{0, -1640, 0}};
  EXPECT_EQ(message(cloud, origin, 0.05),
            path.string() +
                ": the scans reach 1640.0 m from the origin of the world and OctoMap no "
                "farther than 32768 cells, which are 1638.4 m: larger cells reach "
                "farther");
  EXPECT_EQ(message(cloud, origin, 0.1), "");
  cloud.points = {{0, 0, std::numeric_limits<float>::quiet_NaN()}};
  EXPECT_EQ(message(cloud, origin, 0.1), path.string() + ": a point or an origin is not finite");
}

}  // namespace
}  // namespace planum
