#include "slam/sensor/random_numbers.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace planum {
namespace {

TEST(RandomNumbers, DependOnTheKeyAlone) {
  RandomNumbers a({1, 2, 3}), b({1, 2, 3});
  for (int i = 0; i < 10; ++i) EXPECT_EQ(a.uniform(), b.uniform());
  std::set<double> firsts;
  for (std::uint64_t i = 0; i < 30; ++i)
    for (std::uint64_t j = 0; j < 30; ++j) firsts.insert(RandomNumbers({i, j}).uniform());
  EXPECT_EQ(firsts.size(), 900u);
}

TEST(RandomNumbers, AreTheSameEverywhere) {
  RandomNumbers random({42, 7});
  EXPECT_DOUBLE_EQ(random.uniform(), 0.97899004998579409);
  EXPECT_DOUBLE_EQ(random.normal(), 0.84551194781378092);
}

TEST(RandomNumbers, FirstDrawsOfNeighbouringKeysAreIndependent) {
  constexpr int n = 200'000;
  double sum = 0, squares = 0, products = 0, last = 0;
  for (std::uint64_t i = 0; i < n; ++i) {
    RandomNumbers random({1, i});
    const double x = random.uniform() - 0.5;
    EXPECT_TRUE(x >= -0.5 && x < 0.5);
    sum += x;
    squares += x * x;
    products += x * last;
    last = x;
  }
  EXPECT_NEAR(sum / n, 0, 0.003);
  EXPECT_NEAR(squares / n, 1.0 / 12, 0.001);
  EXPECT_NEAR(products / n, 0, 0.001);
}

TEST(RandomNumbers, NormalHasItsMoments) {
  constexpr int n = 200'000;
  RandomNumbers random({9});
  double sum = 0, squares = 0, fourths = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
    fourths += x * x * x * x;
  }
  EXPECT_NEAR(sum / n, 0, 0.01);
  EXPECT_NEAR(squares / n, 1, 0.015);
  EXPECT_NEAR(fourths / n, 3, 0.15);
}

}  // namespace
}  // namespace planum
