// The search tree beside FLANN and nanoflann on the same points and queries: scan 0 of
// kurt3d_corridor, queried by the points of scan 1 as their pose files place them.
#include <filesystem>
#include <nanoflann.hpp>

#include <benchmark/benchmark.h>
#include <flann/flann.hpp>

#include "slam/core/cloud.hpp"
#include "slam/core/kd_tree.hpp"
#include "slam/io/uos.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/registration/normal_equations.hpp"

namespace {

using namespace planum;

constexpr float radius = 1.0f;

struct Data {
  std::vector<Eigen::Vector3f> target, queries;
};

const Data& data() {
  static const Data loaded = [] {
    const auto folder =
        std::filesystem::path(PLANUM_SOURCE_DIR).parent_path() / "shared/datasets/kurt3d_corridor";
    const Pose target_from_source =
        read_uos_pose(folder / "scan000.pose").inverse() * read_uos_pose(folder / "scan001.pose");
    const auto near = [](const Cloud& cloud) {
      std::vector<Eigen::Vector3f> kept;
      for (const auto& p : cloud.points)
        if (p.norm() > 0.5f && p.norm() < 30) kept.push_back(p);
      return kept;
    };
    Cloud source;
    source.points = near(read_uos_scan(folder / "scan001.3d"));
    return Data{near(read_uos_scan(folder / "scan000.3d")),
                transformed(source, target_from_source).points};
  }();
  return loaded;
}

/// nanoflann's view of a list of points.
struct Adaptor {
  const std::vector<Eigen::Vector3f>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Nanoflann = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Adaptor>,
                                                      Adaptor, 3, std::uint32_t>;

/// nanoflann's nearest point within the radius.
std::uint32_t nearest(const Nanoflann& tree, const Eigen::Vector3f& query) {
  std::uint32_t index = 0;
  float squared = radius * radius;
  nanoflann::KNNResultSet<float, std::uint32_t> result(1);
  result.init(&index, &squared);
  squared = radius * radius;
  tree.findNeighbors(result, query.data(), {});
  return index;
}

/// The queries of a whole match: where the points of scan 1 lie at each step of ICP on all of them,
/// from 26 cm off along the corridor.
const std::vector<std::vector<Eigen::Vector3f>>& icp_queries() {
  static const auto steps = [] {
    Cloud source, target;
    source.points = data().queries;
    target.points = data().target;
    const MatchingScan from = matching_scan(source), to = matching_scan(target);
    PairFinder finder(from, to, from.selection(0));
    Pose pose(Eigen::Translation3d(0.26, 0, 0));
    std::vector<std::vector<Eigen::Vector3f>> result;
    for (const double gate : {1.0, 0.5, 0.25}) {
      for (int i = 0; i < 8; ++i) {
        result.push_back(transformed(source, pose).points);
        const auto pairs = finder.find(pose, Pairing::point_to_plane, icp_gate(gate, 0.05, 0.8));
        const NormalEquations equations = normal_equations(pairs, Pairing::point_to_plane);
        pose = motion_about(equations.centre, determined(equations).solution) * pose;
      }
    }
    return result;
  }();
  return steps;
}

void BM_Build(benchmark::State& state) {
  for (auto _ : state) {
    KdTree tree(data().target);
    benchmark::DoNotOptimize(tree);
  }
}
void BM_BuildNanoflann(benchmark::State& state) {
  const Adaptor adaptor{data().target};
  for (auto _ : state) {
    Nanoflann tree(3, adaptor, {16});
    tree.buildIndex();
    benchmark::ClobberMemory();
  }
}

void BM_Nearest(benchmark::State& state) {
  const KdTree tree(data().target);
  for (auto _ : state)
    for (const auto& query : data().queries) {
      auto found = tree.nearest(query, radius);
      benchmark::DoNotOptimize(found);
    }
}

void BM_IcpPlain(benchmark::State& state) {
  const KdTree tree(data().target);
  for (auto _ : state)
    for (const auto& queries : icp_queries())
      for (const auto& query : queries) benchmark::DoNotOptimize(tree.nearest(query, radius));
}
void BM_IcpCached(benchmark::State& state) {
  const KdTree tree(data().target);
  for (auto _ : state) {
    std::vector<SearchMemory> memory(data().queries.size());
    for (const auto& queries : icp_queries())
      for (std::size_t i = 0; i < queries.size(); ++i)
        benchmark::DoNotOptimize(tree.nearest(queries[i], radius, memory[i]));
  }
}
void BM_IcpNanoflann(benchmark::State& state) {
  const Adaptor adaptor{data().target};
  Nanoflann tree(3, adaptor, {16});
  tree.buildIndex();
  for (auto _ : state)
    for (const auto& queries : icp_queries())
      for (const auto& query : queries) benchmark::DoNotOptimize(nearest(tree, query));
}

void BM_NearestNanoflann(benchmark::State& state) {
  const Adaptor adaptor{data().target};
  Nanoflann tree(3, adaptor, {16});
  tree.buildIndex();
  for (auto _ : state)
    for (const auto& query : data().queries) benchmark::DoNotOptimize(nearest(tree, query));
}

void BM_NearestFlann(benchmark::State& state) {
  auto target = data().target;
  const flann::Matrix<float> points(target.front().data(), target.size(), 3);
  flann::KDTreeSingleIndex<flann::L2_3D<float>> tree(points, flann::KDTreeSingleIndexParams(16));
  tree.buildIndex();
  const flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED);
  for (auto _ : state)
    for (auto query : data().queries) {
      int index = 0;
      float squared = 0;
      flann::Matrix<int> indices(&index, 1, 1);
      flann::Matrix<float> distances(&squared, 1, 1);
      tree.knnSearch(flann::Matrix<float>(query.data(), 1, 3), indices, distances, 1, exact);
      benchmark::DoNotOptimize(index);
    }
}

void BM_TwentyNearest(benchmark::State& state) {
  const KdTree tree(data().target);
  std::vector<Neighbour> found;
  for (auto _ : state)
    for (const auto& query : data().target) tree.k_nearest(query, 20, found);
}
void BM_TwentyNearestNanoflann(benchmark::State& state) {
  const Adaptor adaptor{data().target};
  Nanoflann tree(3, adaptor, {16});
  tree.buildIndex();
  std::vector<std::uint32_t> indices(20);
  std::vector<float> squared(20);
  for (auto _ : state)
    for (const auto& query : data().target)
      tree.knnSearch(query.data(), 20, indices.data(), squared.data());
}

BENCHMARK(BM_Build)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_BuildNanoflann)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Nearest)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_NearestNanoflann)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_NearestFlann)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_IcpPlain)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_IcpCached)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_IcpNanoflann)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_TwentyNearest)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_TwentyNearestNanoflann)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
