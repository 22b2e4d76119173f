// The search tree against FLANN's exact single-index tree, on real and random points.
#include <random>
#include <vector>

#include <flann/flann.hpp>
#include <gtest/gtest.h>

#include "slam/core/kd_tree.hpp"

namespace planum {
namespace {

/// Distances, not indices, are compared: FLANN breaks ties in its own way.
void expect_distances_of_flann(std::vector<Eigen::Vector3f> points,
                               const std::vector<Eigen::Vector3f>& queries, std::size_t k) {
  const flann::Matrix<float> matrix(points.front().data(), points.size(), 3);
  flann::KDTreeSingleIndex<flann::L2_Simple<float>> reference(matrix,
                                                              flann::KDTreeSingleIndexParams(10));
  reference.buildIndex();
  const KdTree tree(points);
  std::vector<Neighbour> found;
  std::vector<int> indices(k);
  std::vector<float> squared(k);
  for (Eigen::Vector3f query : queries) {
    flann::Matrix<int> index_row(indices.data(), 1, k);
    flann::Matrix<float> distance_row(squared.data(), 1, k);
    reference.knnSearch(flann::Matrix<float>(query.data(), 1, 3), index_row, distance_row, k,
                        flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    tree.k_nearest(query, k, found);
    ASSERT_EQ(found.size(), k);
    for (std::size_t i = 0; i < k; ++i)
      ASSERT_NEAR(found[i].squared_distance, squared[i], 1e-5f * squared[i] + 1e-12f);
  }
}

TEST(KdTree, AgreesWithFlann) {
  std::mt19937 random(13);
  std::normal_distribution<float> normal;
  for (const float flatness : {1.0f, 0.1f, 1e-4f}) {
    std::vector<Eigen::Vector3f> points, queries;
    for (int i = 0; i < 20000; ++i)
      points.emplace_back(normal(random), normal(random), flatness * normal(random));
    for (int i = 0; i < 500; ++i)
      queries.emplace_back(normal(random), normal(random), normal(random));
    for (const std::size_t k : {std::size_t{1}, std::size_t{12}, std::size_t{50}})
      expect_distances_of_flann(points, queries, k);
  }
}

}  // namespace
}  // namespace planum
