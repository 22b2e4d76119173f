#include <algorithm>
#include <cctype>
#include <string>

#include <gtest/gtest.h>

#include "slam/graph/g2o_pose_graph.hpp"
#include "slam/graph/graph_optimization.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

/// Optima that others found; see ../shared/datasets/README.md.
struct SharedGraph {
  const char* file;
  double chi2;
};
constexpr SharedGraph shared_graphs[] = {
    {"tinyGrid3D.g2o", 6.7278816},     {"smallGrid3D.g2o", 458.15378},
    {"parking-garage.g2o", 1.2386906}, {"sphere2500.g2o", 727.14967},
    {"intel.g2o", 45.004696},          {"MIT.g2o", 41.163269}};

GraphQuality optimized(const G2oGraph& file) {
  const G2oIndex index = g2o_index(file);
  if (file.planar) return optimize(planar_graph(file, index), {.covariances = false}).quality;
  return optimize(spatial_graph(file, index), {.covariances = false}).quality;
}

void expect_optimum(const SharedGraph& graph, const G2oGraph& file, const char* what) {
  const GraphQuality quality = optimized(file);
  EXPECT_TRUE(quality.converged) << graph.file << what;
  EXPECT_NEAR(quality.cost_after / graph.chi2, 1, 1e-6) << graph.file << what;
  EXPECT_EQ(std::count(quality.counts.begin(), quality.counts.end(), false), 0)
      << graph.file << what << ": no loop of these is false";
  EXPECT_TRUE(quality.repaired.empty());
  EXPECT_EQ(quality.components.size(), 1u);
}

class SharedPoseGraph : public ::testing::TestWithParam<SharedGraph> {};

TEST_P(SharedPoseGraph, IsOptimizedFromItsVerticesAndWithoutThem) {
  PLANUM_SHARED_DATASET(graphs, "pose_graphs");
  G2oGraph file = read_g2o(graphs / GetParam().file);
  expect_optimum(GetParam(), file, ", all vertices");
  std::erase_if(file.vertices, [](const G2oVertex& vertex) { return vertex.id % 3 != 2; });
  expect_optimum(GetParam(), file, ", few vertices");
  file.vertices.clear();
  expect_optimum(GetParam(), file, ", no vertices");
}

std::string graph_name(const ::testing::TestParamInfo<SharedGraph>& info) {
  const std::string file = info.param.file;
  std::string name;
  for (const char c : file.substr(0, file.find('.')))
    if (std::isalnum(static_cast<unsigned char>(c))) name += c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Shared, SharedPoseGraph, ::testing::ValuesIn(shared_graphs), graph_name);

}  // namespace
}  // namespace planum
