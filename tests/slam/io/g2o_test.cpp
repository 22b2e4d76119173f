#include "slam/io/g2o.hpp"

#include "io_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::TemporaryDirectory;
using testing::text_of;
using testing::write_text;

std::string error_from(const std::string& text) {
  const TemporaryDirectory directory;
  return testing::error_in_text(directory / "graph.g2o", text,
                                [](const auto& path) { read_g2o(path); });
}

Matrix6d random_information(testing::Draws& draws) {
  Matrix6d root;
  for (double& value : root.reshaped()) value = draws.uniform(-10, 10);
  return root * root.transpose();
}

TEST(G2o, ComesBackAsItWasWritten) {
  const TemporaryDirectory directory;
  testing::Draws draws(11);
  G2oGraph written;
  for (int i = 0; i < 100; ++i) written.vertices.push_back({3 * i, draws.pose()});
  for (int i = 0; i < 300; ++i) {
    const int from = static_cast<int>(draws.below(99));
    const int to = from + 1 + static_cast<int>(draws.below(static_cast<std::size_t>(99 - from)));
    written.edges.push_back({3 * from, 3 * to, draws.pose(), random_information(draws)});
  }
  written.fixed = {0, 30};
  written.comments = {"rejected EDGE_SE3:QUAT 1 2", "", "second"};
  write_g2o(directory / "graph.g2o", written);
  const G2oGraph read = read_g2o(directory / "graph.g2o");
  ASSERT_EQ(read.vertices.size(), written.vertices.size());
  ASSERT_EQ(read.edges.size(), written.edges.size());
  for (std::size_t i = 0; i < read.vertices.size(); ++i) {
    EXPECT_EQ(read.vertices[i].id, written.vertices[i].id);
    EXPECT_TRUE(
        read.vertices[i].world_from_vertex.isApprox(written.vertices[i].world_from_vertex, 1e-14));
  }
  for (std::size_t i = 0; i < read.edges.size(); ++i) {
    EXPECT_EQ(read.edges[i].from, written.edges[i].from);
    EXPECT_EQ(read.edges[i].to, written.edges[i].to);
    EXPECT_TRUE(read.edges[i].from_from_to.isApprox(written.edges[i].from_from_to, 1e-14));
    EXPECT_TRUE(read.edges[i].information.isApprox(written.edges[i].information, 1e-15));
  }
  EXPECT_EQ(read.fixed, written.fixed);
  EXPECT_EQ(read.comments, written.comments);
}

TEST(G2o, HoldsTheUpperHalfOfTheInformationByRows) {
  const TemporaryDirectory directory;
  G2oGraph graph;
  graph.vertices = {{0, Pose::Identity()}, {1, Pose(Eigen::Translation3d(1, 2, 3))}};
  graph.edges.push_back({0, 1, Pose(Eigen::Translation3d(1, 2, 3)), Matrix6d::Zero()});
  double next = 1;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column)
      graph.edges[0].information(row, column) = graph.edges[0].information(column, row) = next++;
  graph.comments = {"two\nlines"};
  write_g2o(directory / "graph.g2o", graph);
  EXPECT_EQ(text_of(directory / "graph.g2o"),
            "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
            "VERTEX_SE3:QUAT 1 1 2 3 0 0 0 1\n"
            "EDGE_SE3:QUAT 0 1 1 2 3 0 0 0 1 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 "
            "21\n# two\n# lines\n");
  EXPECT_EQ(read_g2o(directory / "graph.g2o").edges[0].information, graph.edges[0].information);
}

TEST(G2o, InformationIsThatOfHalfTheRotation) {
  testing::Draws draws(12);
  for (int i = 0; i < 50; ++i) {
    const Matrix6d file = random_information(draws);
    const Matrix6d ours = information_from_g2o(file);
    EXPECT_TRUE(g2o_from_information(ours).isApprox(file, 1e-14));
    // The weighted square of a small error is the same in both parametrizations.
    Vector6d twist;
    twist << draws.vector(1e-5), draws.vector(1e-5);
    const Pose error = exp_se3(twist);
    Vector6d of_g2o;
    of_g2o << error.translation(), Eigen::Quaterniond(error.linear()).vec();
    const double expected = of_g2o.dot(file * of_g2o);
    EXPECT_NEAR(twist.dot(ours * twist), expected, 1e-4 * expected);
  }
}

TEST(G2o, SaysWhereALineIsWrong) {
  const std::string vertex = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n";
  EXPECT_EQ(error_from(vertex + "VERTEX_XY 1 0 0\n"),
            "FILE:2: expected VERTEX_SE3:QUAT, EDGE_SE3:QUAT, VERTEX_SE2, EDGE_SE2 or FIX, got "
            "\"VERTEX_XY\"");
  EXPECT_EQ(error_from(vertex + "VERTEX_SE2 1 0 0 0\n"),
            "FILE:2: a graph is either 3D (SE3:QUAT) or 2D (SE2), but this file has both");
  EXPECT_EQ(error_from(vertex + vertex), "FILE:2: vertex 0 is there twice");
  EXPECT_EQ(error_from("VERTEX_SE3:QUAT 0 0 0 0\n"),
            "FILE:1: expected 7 numbers (x y z qx qy qz qw), got 3");
  EXPECT_EQ(error_from("VERTEX_SE3:QUAT -1 0 0 0 0 0 0 1\n"),
            "FILE:1: expected a vertex id from 0 to 2147483647, got -1");
  EXPECT_EQ(error_from("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0\n"),
            "FILE:1: expected a unit quaternion qx qy qz qw, got one of length 0");
  std::string edge = "EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1";
  EXPECT_EQ(error_from(vertex + edge + "\n"),
            "FILE:2: expected 28 numbers (x y z qx qy qz qw and the upper half of the information "
            "matrix), got 7");
  for (int i = 0; i < 21; ++i) edge += " 1";
  EXPECT_EQ(error_from(vertex + edge + "\n"),
            "FILE:2: the edge joins vertex 1, which is not in the file");
  EXPECT_EQ(error_from(vertex + "FIX 0 7\n"),
            "FILE:2: vertex 7 is to stay fixed, but is not in the file");
  EXPECT_EQ(error_from("VERTEX_SE3:QUAT 0 0 nan 0 0 0 0 1\n"), "FILE:1: expected finite numbers");
  EXPECT_EQ(error_from(edge + "\n"), "FILE: there are no vertices in it");
  EXPECT_EQ(error_from(""), "FILE: there are no vertices in it");
}

TEST(G2o, SaysWhereALineOfAPlanarGraphIsWrong) {
  const std::string vertices = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";
  EXPECT_EQ(error_from("VERTEX_SE2 0 1 2\n"), "FILE:1: expected 3 numbers (x y heading), got 2");
  EXPECT_EQ(error_from("VERTEX_SE2 0 1 2 inf\n"), "FILE:1: expected finite numbers");
  EXPECT_EQ(error_from(vertices + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0\n"),
            "FILE:3: expected 9 numbers (x y heading and the upper half of the information "
            "matrix), got 8");
  EXPECT_EQ(error_from(vertices + "EDGE_SE2 0 1 1 0 0 1 0 nan 1 0 1\n"),
            "FILE:3: expected finite numbers");
  EXPECT_EQ(error_from(vertices + "\nEDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n"),
            "FILE:4: the edge joins vertex 1 with itself");
  EXPECT_EQ(error_from(vertices + "VERTEX_SE3:QUAT 2 0 0 0 0 0 0 1\n"),
            "FILE:3: a graph is either 3D (SE3:QUAT) or 2D (SE2), but this file has both");
}

TEST(G2o, PlanarGraphsLieInThePlane) {
  const TemporaryDirectory directory;
  const std::string text =
      "VERTEX_SE2 0 1 2 0.5\nVERTEX_SE2 4 -1 3.25 -2.5\nFIX 4\n"
      "EDGE_SE2 0 4 1.5 0.25 -3 1 2 3 4 5 6\n# a comment\n";
  write_text(directory / "graph.g2o", text);
  const G2oGraph graph = read_g2o(directory / "graph.g2o");
  EXPECT_TRUE(graph.planar);
  ASSERT_EQ(graph.edges.size(), 1u);
  EXPECT_EQ(graph.edges[0].line, 4u);
  EXPECT_EQ(graph.vertices[1].world_from_vertex.translation(), Eigen::Vector3d(-1, 3.25, 0));
  EXPECT_NEAR(rotation_angle(graph.vertices[0].world_from_vertex), 0.5, 1e-15);
  Matrix6d information = Matrix6d::Zero();
  information(0, 0) = 1;
  information(0, 1) = information(1, 0) = 2;
  information(0, 5) = information(5, 0) = 3;
  information(1, 1) = 4;
  information(1, 5) = information(5, 1) = 5;
  information(5, 5) = 6;
  EXPECT_EQ(graph.edges[0].information, information);
  write_g2o(directory / "again.g2o", graph);
  const G2oGraph again = read_g2o(directory / "again.g2o");
  EXPECT_TRUE(again.planar);
  EXPECT_EQ(again.edges[0].information, information);
  EXPECT_TRUE(again.edges[0].from_from_to.isApprox(graph.edges[0].from_from_to, 1e-15));
  EXPECT_EQ(again.fixed, std::vector<int>{4});
  EXPECT_EQ(again.comments, graph.comments);
}

TEST(G2o, VerticesMayBeMissingIfAllowed) {
  const TemporaryDirectory directory;
  write_text(directory / "graph.g2o", "EDGE_SE2 0 4 1.5 0.25 -3 1 0 0 1 0 1\n");
  const G2oGraph graph = read_g2o(directory / "graph.g2o", LooseEdges::allowed);
  EXPECT_TRUE(graph.vertices.empty());
  EXPECT_EQ(graph.edges.size(), 1u);
  write_text(directory / "graph.g2o", "# nothing\n");
  EXPECT_THROW(read_g2o(directory / "graph.g2o", LooseEdges::allowed), Error);
}

TEST(G2o, ReadsTheSharedGraphs) {
  PLANUM_SHARED_DATASET(graphs, "pose_graphs");
  const auto expect_size = [&](const char* file, std::size_t vertices, std::size_t edges) {
    const G2oGraph graph = read_g2o(graphs / file);
    EXPECT_EQ(graph.vertices.size(), vertices) << file;
    EXPECT_EQ(graph.edges.size(), edges) << file;
  };
  expect_size("tinyGrid3D.g2o", 9, 11);
  expect_size("smallGrid3D.g2o", 125, 297);
  expect_size("parking-garage.g2o", 1661, 6275);
  expect_size("sphere2500.g2o", 2500, 4949);
  expect_size("intel.g2o", 1728, 2512);
  expect_size("MIT.g2o", 808, 827);
}

}  // namespace
}  // namespace planum
