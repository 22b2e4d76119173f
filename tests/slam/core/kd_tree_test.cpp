#include "slam/core/kd_tree.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// Point sets that search trees tend to get wrong.
std::map<std::string, Points> distributions() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0, 1);
  const auto make = [&](int n, const std::function<Eigen::Vector3f(int)>& f) {
    Points points;
    for (int i = 0; i < n; ++i) points.push_back(f(i));
    return points;
  };
  const auto cube = [&](int) { return Eigen::Vector3f(unit(random), unit(random), unit(random)); };
  return {
      {"cube", make(3000, cube)},
      {"one point", make(1, cube)},
      {"seventeen points", make(17, cube)},
      {"plane", make(2000, [&](int) { return Eigen::Vector3f(unit(random), unit(random), 0.5f); })},
      {"line", make(1000, [&](int i) { return Eigen::Vector3f(0.001f * float(i), 0, 0); })},
      {"lattice", make(1000,
                       [&](int i) {
                         return Eigen::Vector3f(
                             Eigen::Vector3f(float(i % 10), float(i / 10 % 10), float(i / 100)) /
                             10);
                       })},
      {"all equal", make(500, [&](int) { return Eigen::Vector3f(0.3f, 0.3f, 0.3f); })},
      {"few values", make(800,
                          [&](int) {
                            return Eigen::Vector3f(float(random() % 3), float(random() % 2),
                                                   float(random() % 2));
                          })},
      {"far away",
       make(500, [&](int i) { return (Eigen::Vector3f(1e5f, -1e5f, 3e4f) + cube(i)).eval(); })},
      {"one outlier",
       make(500, [&](int i) { return i == 250 ? Eigen::Vector3f(1e9f, 0, 0) : cube(i); })},
      {"arcs of a tilting laser",
       make(3000,
            [&](int i) {
              const float tilt = 0.05f * float(i / 300), beam = 0.01f * float(i % 300),
                          range = 2 + 0.01f * unit(random);
              return Eigen::Vector3f(range * std::cos(tilt) * std::cos(beam),
                                     range * std::sin(beam),
                                     range * std::sin(tilt) * std::cos(beam));
            })},
  };
}

Points queries_for(const Points& points) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> offset(-0.3f, 0.3f);
  Points queries;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f& p = points[random() % points.size()];
    queries.push_back(
        i % 4 == 0 ? p : p + Eigen::Vector3f(offset(random), offset(random), offset(random)));
  }
  queries.emplace_back(-50.0f, 20.0f, 3.0f);
  return queries;
}

std::vector<Neighbour> brute_force(const Points& points, const Eigen::Vector3f& query,
                                   float radius) {
  std::vector<Neighbour> found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float dx = points[i].x() - query.x(), dy = points[i].y() - query.y(),
                dz = points[i].z() - query.z();
    const float squared = dx * dx + dy * dy + dz * dz;
    if (squared <= radius * radius) found.push_back({static_cast<std::uint32_t>(i), squared});
  }
  std::sort(found.begin(), found.end());
  return found;
}

void expect_same(const std::vector<Neighbour>& a, const std::vector<Neighbour>& b,
                 const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].index, b[i].index) << what << ", place " << i;
    ASSERT_EQ(a[i].squared_distance, b[i].squared_distance) << what << ", place " << i;
  }
}

TEST(KdTree, AgreesWithBruteForceBitForBit) {
  for (const auto& [name, points] : distributions()) {
    const KdTree tree(points);
    std::vector<Neighbour> found;
    for (const Eigen::Vector3f& query : queries_for(points)) {
      for (const float radius : {0.05f, 0.4f, 100.0f}) {
        const auto truth = brute_force(points, query, radius);
        const auto nearest = tree.nearest(query, radius);
        ASSERT_EQ(nearest.has_value(), !truth.empty()) << name;
        if (nearest) expect_same({*nearest}, {truth.front()}, name + " nearest");
        tree.within(query, radius, found);
        expect_same(found, truth, name + " within");
        for (const std::size_t k : {1u, 7u, 40u, 100u}) {
          tree.k_nearest(query, k, found, radius);
          auto first = truth;
          first.resize(std::min(first.size(), k));
          expect_same(found, first, name + " k nearest");
        }
      }
    }
  }
}

TEST(KdTree, MemoryNeverChangesAnAnswer) {
  for (const auto& [name, points] : distributions()) {
    const KdTree tree(points);
    std::mt19937 random(3);
    for (Eigen::Vector3f query : queries_for(points)) {
      SearchMemory memory;
      if (random() % 5 == 0)  // a place that is none, or some other one
        memory.place = static_cast<std::uint32_t>(random());
      // Steps that get shorter, as those of ICP; the radius shrinks, grows, finds nothing.
      for (int move = 0; move < 12; ++move) {
        const float length = 0.05f * std::pow(0.6f, static_cast<float>(move));
        const float radius = move % 4 == 1 ? 0.1f : move % 4 == 2 ? 0.001f : 5.0f;
        const auto plain = tree.nearest(query, radius);
        const auto cached = tree.nearest(query, radius, memory);
        ASSERT_EQ(plain.has_value(), cached.has_value()) << name << " move " << move;
        if (plain) expect_same({*cached}, {*plain}, name);
        std::uniform_real_distribution<float> step(-length, length);
        if (move != 5) query += Eigen::Vector3f(step(random), step(random), step(random));
      }
    }
  }
}

TEST(KdTree, TiesAreAnsweredAlikeWithMemory) {
  // Queries half way between points of a grid: two, four or eight are the nearest.
  Points points;
  for (int i = 0; i < 12 * 12 * 12; ++i)
    points.push_back(Eigen::Vector3f(static_cast<float>(i % 12), static_cast<float>(i / 12 % 12),
                                     static_cast<float>(i / 144)));
  const KdTree tree(points);
  SearchMemory memory;
  for (int step = 0; step <= 80; ++step) {
    const Eigen::Vector3f query = Eigen::Vector3f(1, 1, 1) * (0.125f * static_cast<float>(step));
    const auto plain = tree.nearest(query, 10), cached = tree.nearest(query, 10, memory);
    ASSERT_TRUE(plain && cached);
    expect_same({*cached}, {*plain}, "grid");
  }
}

TEST(KdTree, IsTheSameForAnyNumberOfThreads) {
  const Points points = distributions()["cube"];
  std::vector<std::vector<Neighbour>> answers;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    const KdTree tree(points);
    std::vector<Neighbour> all, found;
    for (const Eigen::Vector3f& query : queries_for(points)) {
      tree.k_nearest(query, 9, found);
      all.insert(all.end(), found.begin(), found.end());
    }
    answers.push_back(all);
  }
  set_thread_count(0);
  expect_same(answers[0], answers[1], "two threads");
  expect_same(answers[0], answers[2], "five threads");
}

TEST(KdTree, NumberedByLeafAnswersWithTheNewNumbers) {
  for (const auto& [name, points] : distributions()) {
    KdTree tree(points);
    const std::vector<std::uint32_t> old_numbers = tree.number_by_leaf();
    ASSERT_EQ(old_numbers.size(), points.size()) << name;
    Points in_order;
    for (const std::uint32_t i : old_numbers) in_order.push_back(points[i]);
    EXPECT_TRUE(std::is_permutation(in_order.begin(), in_order.end(), points.begin(), points.end()))
        << name;
    std::vector<Neighbour> found;
    for (const Eigen::Vector3f& query : queries_for(points)) {
      tree.within(query, 0.4f, found);
      expect_same(found, brute_force(in_order, query, 0.4f), name);
    }
  }
}

TEST(KdTree, OfNothingFindsNothing) {
  const KdTree tree(Points{});
  std::vector<Neighbour> found(3);
  SearchMemory memory;
  EXPECT_FALSE(tree.nearest({0, 0, 0}, 1));
  EXPECT_FALSE(tree.nearest({0, 0, 0}, 1, memory));
  EXPECT_FALSE(tree.nearest({0, 0, 0}, 1, memory));
  tree.k_nearest({0, 0, 0}, 3, found);
  EXPECT_TRUE(found.empty());
}

TEST(KdTree, RefusesPointsThatAreNotFinite) {
  const Points points = {{0, 0, 0}, {0, std::numeric_limits<float>::quiet_NaN(), 0}};
  try {
    const KdTree tree(points);
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("point 1 is not finite"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace planum
