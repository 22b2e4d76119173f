#include "tools/report/stroke_font.hpp"

#include <map>
#include <string>

#include <gtest/gtest.h>

namespace planum {
namespace {

const std::string_view box = strokes_of('\1');

TEST(StrokeFont, LettersArePolylinesInTheirGrid) {
  for (int code = 0; code < 256; ++code) {
    const std::string_view strokes = strokes_of(static_cast<char>(code));
    std::size_t digits = 0;
    for (std::size_t i = 0; i <= strokes.size(); ++i) {
      if (i == strokes.size() || strokes[i] == ' ') {
        EXPECT_EQ(digits % 2, 0u) << strokes;
        EXPECT_TRUE(digits >= 4 || strokes.empty()) << strokes;
        digits = 0;
        continue;
      }
      EXPECT_GE(strokes[i], '0');
      EXPECT_LE(strokes[i], digits % 2 ? '8' : '4') << strokes;
      ++digits;
    }
  }
}

TEST(StrokeFont, TellsLettersAndDigitsApart) {
  std::map<std::string_view, char> seen;
  for (const char letter : std::string("abcdefghijklmnopqrstuvwxyz0123456789.,-+:/()%#=")) {
    const std::string_view strokes = strokes_of(letter);
    EXPECT_NE(strokes, box) << letter;
    EXPECT_TRUE(seen.emplace(strokes, letter).second) << letter << " is " << seen[strokes];
  }
  EXPECT_TRUE(strokes_of(' ').empty());
}

TEST(StrokeFont, DrawsCapitalsAsSmallLettersAndABoxForTheRest) {
  EXPECT_EQ(strokes_of('Q'), strokes_of('q'));
  EXPECT_FALSE(box.empty());
  for (const char other : {'\0', '\n', '\xfc', '~'}) EXPECT_EQ(strokes_of(other), box);
}

}  // namespace
}  // namespace planum
