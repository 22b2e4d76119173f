#include "slam/graph/lu_milios_system.hpp"

#include <algorithm>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using Links = std::vector<std::pair<std::size_t, std::size_t>>;

const Vector6d little = Vector6d::Constant(1e-3);

/// Links between random poses; the first ones make a chain, so that all hang together.
std::vector<LinkEquation> random_links(std::mt19937& random, std::size_t poses, std::size_t count) {
  std::normal_distribution<double> normal;
  std::vector<LinkEquation> links;
  while (links.size() < count) {
    LinkEquation link;
    link.a = links.size() + 1 < poses ? links.size() + 1 : random() % poses;
    link.b = links.size() + 1 < poses ? links.size() : random() % poses;
    if (link.a == link.b) continue;
    const Matrix6d root = Matrix6d::NullaryExpr([&] { return normal(random); });
    link.information = root * root.transpose();
    link.weighted_difference = Vector6d::NullaryExpr([&] { return normal(random); });
    links.push_back(link);
  }
  return links;
}

Links pairs_of(const std::vector<LinkEquation>& equations) {
  Links links;
  for (const LinkEquation& e : equations) links.emplace_back(e.a, e.b);
  return links;
}

/// The system of Lu & Milios written down as it stands.
Eigen::VectorXd dense_solution(const std::vector<LinkEquation>& links, std::size_t poses,
                               const std::vector<bool>& fixed, const Vector6d& damping) {
  const auto size = static_cast<Eigen::Index>(6 * poses);
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
  for (std::size_t i = 0; i < poses; ++i)
    g.block<6, 6>(static_cast<Eigen::Index>(6 * i), static_cast<Eigen::Index>(6 * i)) =
        damping.asDiagonal();
  for (const LinkEquation& link : links) {
    const auto i = static_cast<Eigen::Index>(6 * link.a), j = static_cast<Eigen::Index>(6 * link.b);
    g.block<6, 6>(i, i) += link.information;
    g.block<6, 6>(j, j) += link.information;
    g.block<6, 6>(i, j) -= link.information;
    g.block<6, 6>(j, i) -= link.information;
    b.segment<6>(i) += link.weighted_difference;
    b.segment<6>(j) -= link.weighted_difference;
  }
  for (std::size_t i = 0; i < poses; ++i)
    if (fixed[i]) {
      const auto at = static_cast<Eigen::Index>(6 * i);
      g.middleRows<6>(at).setZero();
      g.middleCols<6>(at).setZero();
      g.block<6, 6>(at, at).setIdentity();
      b.segment<6>(at).setZero();
    }
  return g.ldlt().solve(b);
}

double largest_difference(const std::vector<Vector6d>& found, const Eigen::VectorXd& expected) {
  double most = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    most = std::max(
        most,
        (found[i] - expected.segment<6>(static_cast<Eigen::Index>(6 * i))).cwiseAbs().maxCoeff());
  return most;
}

TEST(LuMiliosSystem, IsSolvedAsTheDenseSystemIs) {
  std::mt19937 random(1);
  for (const std::size_t poses : {2u, 5u, 20u}) {
    std::vector<bool> fixed(poses, false);
    fixed[0] = true;
    const auto links = random_links(random, poses, 3 * poses);
    LuMiliosSystem system(pairs_of(links), fixed);
    EXPECT_LT(largest_difference(system.solve(links, little),
                                 dense_solution(links, poses, fixed, little)),
              1e-9);
  }
}

TEST(LuMiliosSystem, IsAnalysedOnceForManySystems) {
  std::mt19937 random(2);
  const std::vector<bool> fixed = {true, false, false, true, false, false};
  auto links = random_links(random, 6, 12);
  LuMiliosSystem system(pairs_of(links), fixed);
  for (int draw = 0; draw < 5; ++draw) {
    for (LinkEquation& link : links) {
      link.information *= 1.0 + 0.1 * draw;
      link.weighted_difference *= -1.3;
    }
    const auto motions = system.solve(links, little);
    EXPECT_LT(largest_difference(motions, dense_solution(links, 6, fixed, little)), 1e-9);
    EXPECT_TRUE(motions[0].isZero());
    EXPECT_TRUE(motions[3].isZero());
  }
}

TEST(LuMiliosSystem, DoesNotMindTheOrderOfLinks) {
  std::mt19937 random(3);
  std::vector<bool> fixed(15, false);
  fixed[0] = true;
  auto links = random_links(random, 15, 40);
  const auto before = LuMiliosSystem(pairs_of(links), fixed).solve(links, little);
  for (int draw = 0; draw < 5; ++draw) {
    std::shuffle(links.begin(), links.end(), random);
    const auto after = LuMiliosSystem(pairs_of(links), fixed).solve(links, little);
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_LT((before[i] - after[i]).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(LuMiliosSystem, TakesLinksThatDoNotDetermineEverything) {
  // Two poses and a link of rank one: the rest stays in place.
  LinkEquation link{.a = 1, .b = 0};
  link.information(0, 0) = 1e6;
  link.weighted_difference[0] = 1e6 * 0.5;
  LuMiliosSystem system(Links{{1, 0}}, {true, false});
  const auto motions = system.solve(std::vector<LinkEquation>{link}, little);
  EXPECT_NEAR(motions[1][0], 0.5, 1e-6);
  EXPECT_TRUE(motions[1].tail<5>().isZero(1e-12));
}

TEST(LuMiliosSystem, LeavesPosesThatNothingLinks) {
  LuMiliosSystem system(Links{}, {true, false, false});
  for (const Vector6d& motion : system.solve({}, little)) EXPECT_TRUE(motion.isZero());
  EXPECT_TRUE(LuMiliosSystem(Links{}, {}).solve({}, little).empty());
}

TEST(LuMiliosSystem, RefusesWhatIsNoSystem) {
  EXPECT_NE(testing::message_of([] {
              LuMiliosSystem(Links{{0, 3}}, {true, false});
            }).find("a link of poses 0 and 3, but there are 2 poses"),
            std::string::npos);
  LinkEquation link{.a = 1, .b = 0, .information = -Matrix6d::Identity()};
  LuMiliosSystem system(Links{{1, 0}}, {true, false});
  EXPECT_EQ(testing::message_of([&] { system.solve(std::vector<LinkEquation>{link}, little); }),
            "relaxation: the system of links is not positive definite");
}

}  // namespace
}  // namespace planum
