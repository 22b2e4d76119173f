#include "tools/workflow/unit_cache.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

const Digest key = Hasher().text("key").result();
const Digest other_key = Hasher().text("other").result();

TEST(UnitCache, GivesBackOnlyWhatWasMadeFromTheSame) {
  const testing::TemporaryDirectory directory;
  UnitCache cache(directory / "units");
  EXPECT_FALSE(cache.find("scan000", key));
  cache.store("scan000", key, "points");
  EXPECT_EQ(cache.find("scan000", key), "points");
  EXPECT_FALSE(cache.find("scan000", other_key));
  EXPECT_FALSE(cache.find("scan001", key));
  EXPECT_EQ(UnitCache(directory / "units").find("scan000", key), "points");
  EXPECT_EQ(UnitCache(directory / "units").read("scan000"), "points");
  EXPECT_FALSE(UnitCache(directory / "units").read("scan001"));
}

TEST(UnitCache, TakesADamagedUnitForNone) {
  const testing::TemporaryDirectory directory;
  UnitCache cache(directory / "units");
  cache.store("scan000", key, "points");
  std::fstream(cache.file("scan000"), std::ios::in | std::ios::out).seekp(34).put('X');
  EXPECT_FALSE(cache.find("scan000", key));
  std::ofstream(cache.file("scan000")) << "short";
  EXPECT_FALSE(cache.find("scan000", key));
}

TEST(UnitCache, FindsNothingWhereAllIsToBeDoneAnew) {
  const testing::TemporaryDirectory directory;
  UnitCache(directory / "units").store("scan000", key, "before");
  UnitCache cache(directory / "units", false);
  EXPECT_FALSE(cache.find("scan000", key));
  cache.store("scan000", key, "after");
  cache.remove_unused();
  EXPECT_EQ(UnitCache(directory / "units").find("scan000", key), "after");
}

TEST(UnitCache, RemovesWhatWasNotUsed) {
  const testing::TemporaryDirectory directory;
  UnitCache(directory / "units").store("old", key, "1");
  UnitCache cache(directory / "units");
  cache.store("new", key, "2");
  cache.remove_unused();
  EXPECT_FALSE(std::filesystem::exists(cache.file("old")));
  EXPECT_EQ(cache.find("new", key), "2");
}

}  // namespace
}  // namespace planum
