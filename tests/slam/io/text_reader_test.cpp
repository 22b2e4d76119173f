#include "slam/io/text_reader.hpp"

#include <cmath>

#include "io_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::error_of;

std::vector<double> all_numbers_of(const std::string& text) {
  TextReader reader("numbers.txt", text);
  std::vector<double> numbers;
  while (reader.next_data_line()) {
    std::array<double, 100> line;
    const std::size_t count = reader.numbers(line);
    numbers.insert(numbers.end(), line.begin(), line.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return numbers;
}

TEST(TextReader, TakesAnyLineEndSpacingAndComment) {
  const std::vector<double> expected = {1, 2, 3, 4};
  for (const std::string text : {"1 2\n3 4\n", "1 2\n3 4", "1 2\r\n3 4\r\n",
                                 "\t1\t2 \n\n  \n3  4  ", "# 9\n1 2 # 8\n#\n3 4 #",
                                 "\xEF\xBB\xBF"
                                 "1 2\n3 4\n",
                                 "+1 2.\n 3e0 0.4E1"})
    EXPECT_EQ(all_numbers_of(text), expected) << text;
  EXPECT_TRUE(all_numbers_of("").empty());
  EXPECT_TRUE(all_numbers_of("\n\r\n# only\n  \n").empty());
}

TEST(TextReader, ReadsNotANumberAndInfinity) {
  const auto numbers = all_numbers_of("nan NaN -nan inf -inf Infinity INF");
  ASSERT_EQ(numbers.size(), 7u);
  EXPECT_TRUE(std::isnan(numbers[0]) && std::isnan(numbers[1]) && std::isnan(numbers[2]));
  EXPECT_EQ(numbers[3], HUGE_VAL);
  EXPECT_EQ(numbers[4], -HUGE_VAL);
  EXPECT_EQ(numbers[5], HUGE_VAL);
  EXPECT_EQ(numbers[6], HUGE_VAL);
}

TEST(TextReader, RoundsNumbersBeyondTheirTypeAsIeeeDoes) {
  const std::vector<double> expected = {HUGE_VAL, -HUGE_VAL, 0};
  EXPECT_EQ(all_numbers_of("1e400 -1e400 1e-400"), expected);
  TextReader reader("ranges.txt", "1e39 1e-50 0.1");
  ASSERT_TRUE(reader.next_data_line());
  std::vector<float> floats;
  reader.append_numbers(floats);
  EXPECT_EQ(floats, (std::vector<float>{HUGE_VALF, 0, 0.1f}));
}

TEST(TextReader, CountsLinesAsEditorsDo) {
  TextReader reader("lines.txt", "# first\n\nthird\r\n\n\nsixth");
  EXPECT_EQ(reader.line_number(), 0u);
  ASSERT_TRUE(reader.next_line());
  EXPECT_TRUE(reader.is_comment());
  EXPECT_EQ(reader.line_number(), 1u);
  ASSERT_TRUE(reader.next_data_line());
  EXPECT_EQ(reader.line(), "third");
  EXPECT_EQ(reader.line_number(), 3u);
  ASSERT_TRUE(reader.next_line());
  EXPECT_EQ(reader.word(), "sixth");
  EXPECT_EQ(reader.line_number(), 6u);
  EXPECT_FALSE(reader.next_line());
}

std::string number_error(const std::string& text) {
  return error_of([&] {
    TextReader reader("dir/a.txt", text);
    reader.next_data_line();
    std::array<double, 3> numbers;
    reader.all_numbers(numbers, "x y z");
  });
}

TEST(TextReader, SaysWhatWasExpectedAndFoundAndWhere) {
  EXPECT_EQ(number_error("\n1 2"), "dir/a.txt:2: expected 3 numbers (x y z), got 2");
  EXPECT_EQ(number_error("1 two 3"), "dir/a.txt:1: expected a number, got \"two\"");
  EXPECT_EQ(number_error("1 2 3 4"),
            "dir/a.txt:1: expected 3 numbers (x y z), but the line goes on with \"4\"");
  for (const std::string word : {"1,5", "1e", "0x10", "1.2.3", "1.#IND", "--1", "+-1", "1\r2", "-"})
    EXPECT_NE(number_error("1 2 " + word).find("expected a number"), std::string::npos) << word;
  EXPECT_EQ(number_error("1 2 " + std::string(100, '\x01')),
            "dir/a.txt:1: expected a number, got \"" + std::string(40, '?') + "...\"");
}

TEST(TextReader, ReadsWholeNumbers) {
  TextReader reader("ids.txt", "12 -3 4.5");
  ASSERT_TRUE(reader.next_data_line());
  EXPECT_EQ(reader.integer(), 12);
  EXPECT_EQ(reader.integer(), -3);
  EXPECT_EQ(error_of([&] { reader.integer(); }), "ids.txt:1: expected a whole number, got \"4.5\"");
  TextReader large("ids.txt", "99999999999999999999");
  ASSERT_TRUE(large.next_data_line());
  EXPECT_EQ(error_of([&] { large.integer(); }), "ids.txt:1: \"99999999999999999999\" is too large");
}

TEST(TextReader, SaysThatAFileIsMissingOrNone) {
  const testing::TemporaryDirectory directory;
  const std::string missing = (directory / "absent.txt").string();
  EXPECT_EQ(error_of([&] { TextReader reader(missing); }),
            missing + ": cannot open: No such file or directory");
  const std::string none = directory.path().string();
  EXPECT_EQ(error_of([&] { TextReader reader(none); }), none + ": cannot read: Is a directory");
}

}  // namespace
}  // namespace planum
