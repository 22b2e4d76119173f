#include "tools/workflow/digest.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

TEST(Digest, SurvivesText) {
  const Digest digest = Hasher().text("a scan").result();
  EXPECT_EQ(digest_from_string(to_string(digest)), digest);
  EXPECT_THROW(digest_from_string("12"), Error);
  EXPECT_THROW(digest_from_string("zz345678901234567890123456789012"), Error);
}

TEST(Digest, DoesNotConfuseHowTextsAreDivided) {
  EXPECT_NE(Hasher().text("ab").text("c").result(), Hasher().text("a").text("bc").result());
  EXPECT_NE(Hasher().list(std::vector<int>{}).result(), Hasher().result());
}

TEST(Digest, OfAFileIsThatOfItsBytes) {
  const testing::TemporaryDirectory directory;
  const std::string text(1 << 20, 'x');
  std::ofstream(directory / "file") << text;
  EXPECT_EQ(digest_of_file(directory / "file"), Hasher().bytes(text.data(), text.size()).result());
  EXPECT_THROW(digest_of_file(directory / "none"), Error);
}

}  // namespace
}  // namespace planum
