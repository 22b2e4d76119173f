#include "slam/graph/block_cholesky.hpp"

#include <random>
#include <set>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "slam/core/parallel.hpp"

namespace planum {
namespace {

struct RandomSystem {
  std::vector<BlockPair> pairs;
  BlockMatrix matrix;
  Eigen::MatrixXd dense;
};

/// A chain with some random extra pairs; diagonally dominant.
RandomSystem random_system(std::size_t blocks, int block_size, std::size_t extra, int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::uniform_real_distribution<double> value(-1, 1);
  std::set<BlockPair> pairs;
  for (std::uint32_t i = 1; i < blocks; ++i) pairs.insert({i - 1, i});
  std::uniform_int_distribution<std::uint32_t> any(0, static_cast<std::uint32_t>(blocks - 1));
  while (blocks > 2 && extra-- > 0) {
    const std::uint32_t a = any(random), b = any(random);
    if (a != b) pairs.insert(std::minmax(a, b));
  }
  RandomSystem system;
  system.pairs.assign(pairs.begin(), pairs.end());
  const Eigen::Index b = block_size;
  const auto area = static_cast<std::size_t>(b * b);
  const auto n = static_cast<Eigen::Index>(blocks) * b;
  system.matrix = {block_size, std::vector<double>(blocks * area), {}};
  system.dense = Eigen::MatrixXd::Zero(n, n);
  for (const auto& [i, j] : system.pairs) {
    const Eigen::MatrixXd block = Eigen::MatrixXd::NullaryExpr(b, b, [&] { return value(random); });
    system.dense.block(i * b, j * b, b, b) = block;
    system.dense.block(j * b, i * b, b, b) = block.transpose();
    system.matrix.off_diagonal.insert(system.matrix.off_diagonal.end(), block.data(),
                                      block.data() + area);
  }
  for (Eigen::Index k = 0; k < n; ++k)
    system.dense(k, k) = 1 + system.dense.row(k).cwiseAbs().sum();
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(blocks); ++k)
    Eigen::Map<Eigen::MatrixXd>(system.matrix.diagonal.data() + static_cast<std::size_t>(k) * area,
                                b, b) = system.dense.block(k * b, k * b, b, b);
  return system;
}

std::shared_ptr<const FrontTree> analysis(std::size_t blocks, const std::vector<BlockPair>& pairs) {
  return std::make_shared<FrontTree>(analyzed_fronts(blocks, pairs));
}

TEST(BlockCholesky, SolvesAsADenseFactorizationDoes) {
  int seed = 0;
  for (const int block_size : {2, 3, 6})
    for (const std::size_t blocks : {1, 2, 7, 60, 150})
      for (const std::size_t extra : {0, 5, 80}) {
        const RandomSystem system = random_system(blocks, block_size, extra, ++seed);
        BlockCholesky cholesky(analysis(blocks, system.pairs), block_size);
        ASSERT_TRUE(cholesky.factorize(system.matrix));
        const Eigen::MatrixXd b = Eigen::MatrixXd::Random(system.dense.rows(), 3);
        EXPECT_LT((system.dense * cholesky.solve(b) - b).cwiseAbs().maxCoeff(), 1e-11);
      }
}

TEST(BlockCholesky, GivesTheInverseOnThePattern) {
  int seed = 100;
  for (const int block_size : {2, 3, 6})
    for (const std::size_t blocks : {1, 2, 40, 120}) {
      const RandomSystem system = random_system(blocks, block_size, 60, ++seed);
      BlockCholesky cholesky(analysis(blocks, system.pairs), block_size);
      ASSERT_TRUE(cholesky.factorize(system.matrix));
      const Eigen::MatrixXd dense = system.dense.inverse();
      const BlockMatrix sparse = cholesky.inverse();
      const Eigen::Index b = block_size;
      const auto area = static_cast<std::size_t>(b * b);
      const auto block = [&](const std::vector<double>& values, std::size_t k) {
        return Eigen::Map<const Eigen::MatrixXd>(values.data() + k * area, b, b);
      };
      for (std::size_t k = 0; k < blocks; ++k) {
        const auto at = static_cast<Eigen::Index>(k) * b;
        EXPECT_LT((block(sparse.diagonal, k) - dense.block(at, at, b, b)).norm(), 1e-12);
      }
      for (std::size_t k = 0; k < system.pairs.size(); ++k) {
        const auto [i, j] = system.pairs[k];
        EXPECT_LT((block(sparse.off_diagonal, k) - dense.block(i * b, j * b, b, b)).norm(), 1e-12);
      }
    }
}

TEST(BlockCholesky, TurnsDownWhatIsNotPositiveDefinite) {
  RandomSystem system = random_system(30, 3, 20, 7);
  BlockCholesky cholesky(analysis(30, system.pairs), 3);
  EXPECT_TRUE(cholesky.factorize(system.matrix));
  BlockMatrix indefinite = system.matrix;
  indefinite.diagonal[9 * 12] = -1;
  EXPECT_FALSE(cholesky.factorize(indefinite));
  EXPECT_FALSE(cholesky.factorize(cholesky.matrix())) << "all zero";
  EXPECT_TRUE(cholesky.factorize(system.matrix)) << "usable again";
}

TEST(BlockCholesky, KeepsSeparatePartsApart) {
  BlockCholesky cholesky(analysis(4, {}), 2);
  BlockMatrix matrix = cholesky.matrix();
  for (std::size_t k = 0; k < 4; ++k)
    matrix.diagonal[4 * k] = matrix.diagonal[4 * k + 3] = 1.0 + static_cast<double>(k);
  ASSERT_TRUE(cholesky.factorize(matrix));
  const Eigen::MatrixXd x = cholesky.solve(Eigen::MatrixXd::Ones(8, 1));
  for (Eigen::Index k = 0; k < 8; ++k)
    EXPECT_DOUBLE_EQ(x(k, 0), 1.0 / (1.0 + static_cast<double>(k / 2)));
}

TEST(BlockCholesky, IsTheSameForAnyNumberOfThreads) {
  const RandomSystem system = random_system(400, 6, 300, 5);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Ones(system.dense.rows(), 1);
  std::vector<Eigen::MatrixXd> results;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    BlockCholesky cholesky(analysis(400, system.pairs), 6);
    ASSERT_TRUE(cholesky.factorize(system.matrix));
    results.push_back(cholesky.solve(b));
  }
  set_thread_count(0);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace planum
