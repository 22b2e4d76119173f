#include <fmt/format.h>

#include "io_test_support.hpp"
#include "slam/io/frames.hpp"
#include "slam/io/g2o.hpp"
#include "slam/io/obj.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/pose_list.hpp"
#include "slam/io/scan_directory.hpp"
#include "slam/io/slices.hpp"
#include "slam/io/tum.hpp"
#include "slam/io/uos.hpp"
#include "slam/io/xyz.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::Draws;
using testing::TemporaryDirectory;

/// A file after some accident: bytes changed, cut out, doubled, or the end missing.
std::string mutated(std::string text, Draws& draws) {
  const std::string letters("0123456789+-.eE #\n\r\t\0naif/xyz\xFF\x80", 32);
  for (std::size_t changes = 1 + draws.below(4); changes > 0 && !text.empty(); --changes) {
    const std::size_t at = draws.below(text.size());
    const std::size_t length = 1 + draws.below(std::min<std::size_t>(text.size() - at, 20));
    switch (draws.below(6)) {
      case 0:
        text[at] = static_cast<char>(text[at] ^ (1 << draws.below(8)));
        break;
      case 1:
        text[at] = letters[draws.below(letters.size())];
        break;
      case 2:
        text.insert(at, 1, letters[draws.below(letters.size())]);
        break;
      case 3:
        text.erase(at, length);
        break;
      case 4:
        text.insert(at, text.substr(at, length));
        break;
      default:
        text.resize(at);
    }
  }
  return text;
}

/// Reads a few thousand mutations of a file: each gives a result or an Error, and nothing else.
void expect_error_or_result(const std::string& name,
                            const std::function<void(const std::filesystem::path&)>& write,
                            const std::function<void(const std::filesystem::path&)>& read) {
  constexpr int rounds = 2000;
  const TemporaryDirectory directory;
  const auto file = directory / name;
  write(file);
  const std::string text = testing::text_of(file);
  Draws draws(13);
  int errors = 0;
  for (int round = 0; round < rounds; ++round) {
    testing::write_text(file, mutated(text, draws));
    try {
      read(file);
    } catch (const Error& error) {
      ++errors;
      EXPECT_TRUE(std::string(error.what()).starts_with(file.string())) << error.what();
    }
  }
  EXPECT_GT(errors, 0);
  EXPECT_LT(errors, rounds);
}

Cloud small_cloud() {
  Draws draws(14);
  Cloud cloud;
  for (int i = 0; i < 12; ++i) {
    cloud.points.push_back(draws.vector(10).cast<float>());
    cloud.normals.push_back(draws.vector(1).cast<float>());
    cloud.intensity.push_back(static_cast<float>(draws.uniform(0, 1)));
    cloud.scan.push_back(static_cast<std::uint32_t>(i));
  }
  return cloud;
}

LabelledMesh small_mesh() {
  LabelledMesh labelled;
  labelled.mesh.vertices = small_cloud().points;
  for (std::uint32_t i = 0; i < 10; ++i) {
    labelled.mesh.triangles.push_back({i, i + 1, i + 2});
    labelled.group.push_back(i % 2);
  }
  labelled.names = {"floor", "wall"};
  return labelled;
}

std::vector<Pose> small_path() {
  Draws draws(15);
  std::vector<Pose> poses;
  for (int i = 0; i < 8; ++i) poses.push_back(draws.pose());
  return poses;
}

TEST(MutatedFile, OfUosPointsGivesErrorOrResult) {
  expect_error_or_result(
      "scan000.3d", [](const auto& path) { write_uos_scan(path, small_cloud()); }, read_uos_scan);
}

TEST(MutatedFile, OfAUosPoseGivesErrorOrResult) {
  expect_error_or_result(
      "scan000.pose", [](const auto& path) { write_uos_pose(path, small_path()[0]); },
      read_uos_pose);
}

TEST(MutatedFile, OfFramesGivesErrorOrResult) {
  expect_error_or_result(
      "scan000.frames",
      [](const auto& path) {
        std::vector<Frame> frames;
        for (const Pose& pose : small_path()) frames.push_back({pose, FrameKind::icp});
        write_frames(path, frames);
      },
      read_frames);
}

TEST(MutatedFile, OfSlicesGivesErrorOrResult) {
  const auto write = [](const auto& path) {
    RawScan scan;
    scan.laser = {.first_beam = -1, .beam_step = 0.1, .max_range = 30, .mount_z = 0.08};
    for (int i = 0; i < 6; ++i) scan.slices.push_back({0.1 * i, 0.2 * i, {1, 2, 3, 4, 5.25f}});
    write_slices(path, scan);
  };
  expect_error_or_result("scan000.slices", write, read_slices);
  // As .txt it is looked at first.
  const TemporaryDirectory directory;
  write(directory / "scan000.txt");
  const std::string text = testing::text_of(directory / "scan000.txt");
  Draws draws(16);
  for (int round = 0; round < 500; ++round) {
    testing::write_text(directory / "scan000.txt", mutated(text, draws));
    try {
      list_scans(directory.path());
    } catch (const Error&) {
    }
  }
}

TEST(MutatedFile, OfXyzGivesErrorOrResult) {
  expect_error_or_result(
      "scan000.xyz", [](const auto& path) { write_xyz(path, small_cloud()); }, read_xyz);
}

TEST(MutatedFile, OfAPlyCloudGivesErrorOrResult) {
  expect_error_or_result(
      "cloud.ply", [](const auto& path) { write_ply(path, small_cloud()); }, read_ply_cloud);
}

TEST(MutatedFile, OfAPlyMeshGivesErrorOrResult) {
  expect_error_or_result(
      "mesh.ply",
      [](const auto& path) {
        write_ply(path, small_mesh().mesh,
                  {.vertex_colours = {}, .triangle_colours = {}, .triangle_properties = {}});
      },
      read_ply_mesh);
}

TEST(MutatedFile, OfATextPlyGivesErrorOrResult) {
  const auto write = [](const auto& path) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\n"
        "property float z\nproperty list uchar int ring\nproperty uint scan\nelement face 2\n"
        "property list uchar int vertex_indices\nend_header\n";
    for (const auto& p : small_cloud().points)
      text += fmt::format("{} {} {} 2 1 2 3\n", p.x(), p.y(), p.z());
    testing::write_text(path, text + "3 0 1 2\n5 1 2 3 4 5\n");
  };
  expect_error_or_result("cloud.ply", write, read_ply_cloud);
  expect_error_or_result("mesh.ply", write, read_ply_mesh);
}

TEST(MutatedFile, OfAnObjGivesErrorOrResult) {
  expect_error_or_result(
      "map.obj", [](const auto& path) { write_obj(path, small_mesh()); }, read_obj);
}

TEST(MutatedFile, OfATrajectoryGivesErrorOrResult) {
  expect_error_or_result(
      "a.tum",
      [](const auto& path) {
        Trajectory trajectory;
        for (const Pose& pose : small_path())
          trajectory.push_back({static_cast<double>(trajectory.size()), pose});
        write_tum(path, trajectory);
      },
      read_tum);
}

TEST(MutatedFile, OfAPoseListGivesErrorOrResult) {
  expect_error_or_result(
      "poses.txt", [](const auto& path) { write_pose_list(path, small_path()); }, read_pose_list);
}

TEST(MutatedFile, OfAGraphGivesErrorOrResult) {
  expect_error_or_result(
      "graph.g2o",
      [](const auto& path) {
        G2oGraph graph;
        for (const Pose& pose : small_path()) {
          const int id = static_cast<int>(graph.vertices.size());
          graph.vertices.push_back({id, pose});
          if (id > 0) graph.edges.push_back({0, id, pose, Matrix6d::Identity()});
        }
        graph.fixed = {0};
        graph.comments = {"a comment"};
        write_g2o(path, graph);
      },
      [](const auto& path) { read_g2o(path); });
}

}  // namespace
}  // namespace planum
