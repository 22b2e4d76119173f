#include "tools/workflow/nearest_name.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace planum {
namespace {

TEST(EditDistance, CountsSlips) {
  EXPECT_EQ(edit_distance("mesh", "mesh"), 0u);
  EXPECT_EQ(edit_distance("mesh", "mesh_"), 1u);
  EXPECT_EQ(edit_distance("mesh", "mehs"), 1u);  // neighbours swapped
  EXPECT_EQ(edit_distance("mesh", "mash"), 1u);
  EXPECT_EQ(edit_distance("", "mesh"), 4u);
  EXPECT_EQ(edit_distance("voxel_cm", "voxel_m"), 1u);
}

TEST(EditDistance, IsSymmetricAndAtMostTheLongerLength) {
  std::mt19937 random(1);
  const auto word = [&] {
    std::string text(random() % 7, ' ');
    for (char& letter : text) letter = static_cast<char>('a' + random() % 3);
    return text;
  };
  for (int i = 0; i < 500; ++i) {
    const std::string a = word(), b = word();
    EXPECT_EQ(edit_distance(a, b), edit_distance(b, a)) << a << " " << b;
    EXPECT_LE(edit_distance(a, b), std::max(a.size(), b.size()));
    EXPECT_EQ(edit_distance(a, b) == 0, a == b);
  }
}

TEST(NearestName, FindsWhatWasMeantOrNothing) {
  const std::vector<std::string> names = {"run", "status", "simulate", "max_range_m"};
  EXPECT_EQ(nearest_name("rnu", names), "run");
  EXPECT_EQ(nearest_name("statsu", names), "status");
  EXPECT_EQ(nearest_name("max", names), "max_range_m");
  EXPECT_EQ(nearest_name("frobnicate", names), std::nullopt);
}

}  // namespace
}  // namespace planum
