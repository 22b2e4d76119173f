#include "slam/core/parallel.hpp"

#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{1000}}) {
    for (const std::size_t block :
         {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{5000}}) {
      std::vector<int> visits(count);
      parallel_for(count, block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++visits[i];
      });
      EXPECT_EQ(visits, std::vector<int>(count, 1));
    }
  }
}

TEST(ParallelFor, ThrowsTheErrorOfTheLowestBlock) {
  for (int round = 0; round < 50; ++round) {
    try {
      parallel_for(200, 1, [](std::size_t begin, std::size_t) {
        if (begin % 3 == 2) throw Error("block " + std::to_string(begin));
      });
      FAIL() << "no error";
    } catch (const Error& e) {
      EXPECT_STREQ(e.what(), "block 2");
    }
  }
}

TEST(ParallelFor, ReportsProgressUpToTheEnd) {
  std::mutex mutex;
  std::size_t most = 0;
  parallel_for(
      1000, 64, [](std::size_t, std::size_t) {}, Progress([&](std::size_t done, std::size_t total) {
        const std::scoped_lock lock(mutex);
        EXPECT_EQ(total, 1000u);
        most = std::max(most, done);
      }));
  EXPECT_EQ(most, 1000u);
}

}  // namespace
}  // namespace planum
