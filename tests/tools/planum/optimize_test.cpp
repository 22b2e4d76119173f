#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/io/g2o.hpp"
#include "tests/tools/planum/program.hpp"

namespace planum::testing {
namespace {

using nlohmann::json;

/// A ring of `count` vertices from id `first` on, with edges to the next one and one back to the
/// first. The edges agree with each other; the vertices are not where they say.
std::string ring(int count, int first) {
  std::string vertices, edges;
  const double turn = 2 * pi / count;
  for (int i = 0; i < count; ++i) {
    vertices += fmt::format("VERTEX_SE2 {} {} 0 0\n", first + i, 0.3 * i);
    edges += fmt::format("EDGE_SE2 {} {} 1 0 {} 100 0 0 100 0 400\n", first + i,
                         first + (i + 1) % count, turn);
  }
  return vertices + edges;
}

class Optimize : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(directory_ / name) << text;
  }

  Outcome optimize(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "optimize");
    return planum_(arguments);
  }

  TemporaryDirectory directory_;
  Program planum_{directory_.path()};
};

TEST_F(Optimize, WritesThePosesThatTheEdgesSay) {
  write("ring.g2o", ring(8, 10));
  for (const std::string method : {"pose-graph", "lu-milios"}) {
    const Outcome outcome = optimize({"ring.g2o", "-o", "out.g2o", "--method", method, "--json"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json result = json::parse(outcome.out);
    EXPECT_EQ(result["kind"], "SE2");
    EXPECT_EQ(result["vertices"], 8);
    EXPECT_EQ(result["edges"], 8);
    EXPECT_EQ(result["converged"], true);
    EXPECT_GT(result["chi2_before"], 100);
    EXPECT_LT(result["chi2_after"], 1e-8);
    const G2oGraph graph = read_g2o(directory_ / "out.g2o");
    ASSERT_EQ(graph.vertices.size(), 8u);
    EXPECT_TRUE(graph.planar);
    EXPECT_EQ(graph.edges.size(), 8u);
    // An octagon of side 1.
    const Eigen::Vector3d across = graph.vertices[4].world_from_vertex.translation() -
                                   graph.vertices[0].world_from_vertex.translation();
    EXPECT_NEAR(across.norm(), 1 / std::sin(pi / 8), 1e-5);
    EXPECT_LT(graph.vertices[0].world_from_vertex.translation().norm(), 1e-9) << "it stays";
  }
}

TEST_F(Optimize, KeepsFixedVerticesWhereTheyAre) {
  write("ring.g2o", ring(8, 0) + "FIX 3\n");
  for (const std::string method : {"pose-graph", "lu-milios"}) {
    ASSERT_EQ(optimize({"ring.g2o", "-o", "out.g2o", "--method", method}).exit_code, 0);
    const G2oGraph graph = read_g2o(directory_ / "out.g2o");
    EXPECT_LT(
        (graph.vertices[3].world_from_vertex.translation() - Eigen::Vector3d(0.9, 0, 0)).norm(),
        1e-9);
    EXPECT_EQ(graph.fixed, std::vector<int>{3});
  }
}

TEST_F(Optimize, ReachesTheOptimumOfARealGraphAndOfOneWithoutVertices) {
  PLANUM_SHARED_DATASET(graphs, "pose_graphs");
  const std::string all = file_text(graphs / "MIT.g2o");
  std::istringstream lines(all);
  std::string edges;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("EDGE")) edges += line + '\n';
  write("all.g2o", all);
  write("edges.g2o", edges);
  for (const std::string name : {"all.g2o", "edges.g2o"}) {
    const Outcome outcome = optimize({name, "--json"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NEAR(json::parse(outcome.out)["chi2_after"].get<double>() / 41.163269, 1, 1e-6) << name;
  }
  const Outcome text = optimize({"edges.g2o", "-o", "out.g2o"});
  EXPECT_SAYS(text.out, "808 vertices, 827 edges (2D)");
  EXPECT_SAYS(text.out, "chi2 inf -> 41.163");
  EXPECT_EQ(read_g2o(directory_ / "out.g2o").vertices.size(), 808u);
}

TEST_F(Optimize, RejectsAFalseLoopAndSaysWhich) {
  write("ring.g2o", ring(40, 0) + "EDGE_SE2 5 25 0 0 0 100 0 0 100 0 400\n");
  const Outcome outcome = optimize({"ring.g2o", "-o", "out.g2o", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_EQ(result["rejected"], json::parse(R"([{"from": 5, "to": 25}])"));
  EXPECT_LT(result["chi2_after"], 1e-6);
  const G2oGraph graph = read_g2o(directory_ / "out.g2o");
  EXPECT_EQ(graph.edges.size(), 40u);
  EXPECT_EQ(graph.comments, std::vector<std::string>{"rejected 5 25: contradicts the other edges"});
  const Outcome trusting = optimize({"ring.g2o", "--reject-loops", "never", "--json"});
  EXPECT_EQ(json::parse(trusting.out)["rejected"].size(), 0u);
}

TEST_F(Optimize, TellsPartsThatDoNotConnect) {
  write("parts.g2o", ring(8, 0) + ring(5, 100) + "VERTEX_SE2 50 1 2 3\n");
  const Outcome outcome = optimize({"parts.g2o", "-o", "out.g2o"});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_SAYS(outcome.err,
              "parts.g2o: 3 parts that no edge joins: 8 vertices from 0 on, 1 vertex from 50 on, "
              "5 vertices from 100 on; each was optimized by itself");
  EXPECT_EQ(read_g2o(directory_ / "out.g2o").vertices.size(), 14u) << "what there is was written";
}

TEST_F(Optimize, NamesAndRepairsIndefiniteInformation) {
  write("ring.g2o", ring(8, 0) + "EDGE_SE2 0 2 1.7 0.7 1.57 100 0 0 -50 0 400\n");
  const Outcome outcome = optimize({"ring.g2o", "-o", "out.g2o", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_SAYS(outcome.err,
              "ring.g2o:17: the information matrix is indefinite (least eigenvalue -50)");
  EXPECT_EQ(json::parse(outcome.out)["repaired"][0]["line"], 17);
  const G2oGraph graph = read_g2o(directory_ / "out.g2o");
  EXPECT_NEAR(graph.edges[8].information(1, 1), 0, 1e-12);
  EXPECT_NEAR(graph.edges[8].information(0, 0), 100, 1e-12);
}

TEST_F(Optimize, RefusesBadInput) {
  write("bad.g2o", "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 nan 0 0\n");
  Outcome outcome = optimize({"bad.g2o"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_SAYS(outcome.err, "bad.g2o:2: expected finite numbers");
  outcome = optimize({"nowhere.g2o"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_SAYS(outcome.err, "nowhere.g2o");
  write("ring.g2o", ring(8, 0));
  outcome = optimize({"ring.g2o", "--method", "magic"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_SAYS(outcome.err, "magic");
}

}  // namespace
}  // namespace planum::testing
