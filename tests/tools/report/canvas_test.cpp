#include "tools/report/canvas.hpp"

#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/tools/report/picture.hpp"

namespace planum {
namespace {

using Eigen::Vector2d;
using testing::Picture;
using testing::TemporaryDirectory;
using testing::total_ink;

constexpr Colour black = {0, 0, 0}, white = {255, 255, 255};
constexpr double rounding = 0.5 / 255;  // of a pixel in a file

Picture drawn(const Canvas& canvas) {
  const TemporaryDirectory directory;
  canvas.write_png(directory / "picture.png");
  return testing::read_png(directory / "picture.png");
}

Picture drawn(int width, int height, const std::function<void(Canvas&)>& draw) {
  Canvas canvas(width, height);
  draw(canvas);
  return drawn(canvas);
}

Vector2d in_picture(testing::Draws& draws, double size, double margin) {
  return {draws.uniform(margin, size - margin), draws.uniform(margin, size - margin)};
}

TEST(Canvas, PixelsComeBackFromTheFile) {
  testing::Draws draws(1);
  const int width = 37, height = 23;
  Canvas canvas(width, height);
  std::vector<Colour> expected;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto value = [&] { return static_cast<std::uint8_t>(draws.below(256)); };
      expected.push_back({value(), value(), value()});
      canvas.blend(x, y, expected.back(), 1);
    }
  const Picture picture = drawn(canvas);
  EXPECT_EQ(picture.width, width);
  EXPECT_EQ(picture.height, height);
  EXPECT_EQ(picture.pixels, expected);
}

TEST(Canvas, IsItsBackgroundWhereNothingIsDrawn) {
  const Colour background = {10, 200, 30};
  Canvas canvas(5, 4, background);
  for (const int outside : {-1, 5, 1'000'000}) {
    canvas.blend(outside, 2, black, 1);
    canvas.blend(2, outside, black, 1);
  }
  canvas.blend(2, 2, black, 0);
  canvas.polyline({}, true, {});
  canvas.polyline({}, false, {});
  canvas.fill({}, black, 1);
  canvas.text({2, 2}, "", 10, {});
  EXPECT_EQ(drawn(canvas).pixels, std::vector<Colour>(20, background));
}

TEST(Canvas, BlendsByOpacity) {
  const Picture picture = drawn(2, 1, [](Canvas& canvas) {
    canvas.blend(0, 0, {0, 100, 255}, 0.4);
    canvas.blend(1, 0, black, 0.5);
    canvas.blend(1, 0, black, 0.5);
  });
  EXPECT_EQ(picture.at(0, 0), (Colour{153, 193, 255}));
  EXPECT_EQ(picture.at(1, 0), (Colour{64, 64, 64}));
}

TEST(Canvas, ALineIsAsWideAsItsStroke) {
  testing::Draws draws(2);
  for (int draw = 0; draw < 20; ++draw) {
    const double width = draws.uniform(1, 9), y = draws.uniform(10, 30);
    const Picture picture = drawn(40, 40, [&](Canvas& canvas) {
      canvas.line({-20, y}, {60, y}, {.colour = black, .width = width});
    });
    for (int x = 0; x < 40; ++x) {
      double sum = 0, moment = 0;
      for (int row = 0; row < 40; ++row) {
        sum += testing::ink(picture.at(x, row));
        moment += testing::ink(picture.at(x, row)) * (row + 0.5);
      }
      EXPECT_NEAR(sum, width, 40 * rounding);
      EXPECT_NEAR(moment / sum, y, 0.2);
    }
  }
}

TEST(Canvas, ADiscHasTheAreaOfACircle) {
  testing::Draws draws(3);
  for (int draw = 0; draw < 20; ++draw) {
    const double radius = draws.uniform(2, 15);
    const Vector2d centre = in_picture(draws, 40, 17);
    const Picture picture =
        drawn(40, 40, [&](Canvas& canvas) { canvas.disc(centre, radius, black); });
    const double area = std::numbers::pi * radius * radius;
    EXPECT_NEAR(total_ink(picture), area, 0.02 * area + 0.3);
  }
}

TEST(Canvas, APolylineIsItsSegments) {
  const std::vector<Vector2d> corners = {{5, 5}, {35, 5}, {35, 30}};
  const auto ink_of = [&](bool closed) {
    return drawn(40, 40, [&](Canvas& canvas) {
      canvas.polyline(corners, closed, {.colour = black, .width = 2});
    });
  };
  const Picture open = ink_of(false), closed = ink_of(true);
  EXPECT_EQ(open.at(20, 4), black);
  EXPECT_EQ(open.at(35, 17), black);
  EXPECT_EQ(open.at(20, 17), white);
  EXPECT_NE(closed.at(20, 17), white);
  EXPECT_EQ(closed.at(20, 4), black);
}

TEST(Canvas, FillsTheAreaOfARingWithoutItsHole) {
  testing::Draws draws(4);
  for (int draw = 0; draw < 10; ++draw) {
    const Vector2d a(2, draws.uniform(2, 60)), b(draws.uniform(70, 97), 3),
        c(draws.uniform(50, 97), 97);
    const Vector2d middle = (a + b + c) / 3;
    const auto shrunk = [&](const Vector2d& p) -> Vector2d { return middle + (p - middle) / 2; };
    const double area = std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) / 2;
    const auto ink_of = [&](const std::vector<std::vector<Vector2d>>& rings, double opacity) {
      return total_ink(
          drawn(100, 100, [&](Canvas& canvas) { canvas.fill(rings, black, opacity); }));
    };
    EXPECT_NEAR(ink_of({{a, b, c}}, 1), area, 0.01 * area);
    EXPECT_NEAR(ink_of({{c, b, a}}, 0.5), area / 2, 0.01 * area);
    // The hole takes a quarter, whichever way round it runs.
    EXPECT_NEAR(ink_of({{a, b, c}, {shrunk(a), shrunk(b), shrunk(c)}}, 1), 0.75 * area,
                0.01 * area);
    EXPECT_NEAR(ink_of({{a, b, c}, {shrunk(c), shrunk(b), shrunk(a)}}, 1), 0.75 * area,
                0.01 * area);
  }
}

TEST(Canvas, DrawsOnlyThePartOfThingsThatIsInside) {
  for (const double far : {100.0, 1e5, 1e12}) {
    const Picture picture = drawn(20, 20, [&](Canvas& canvas) {
      canvas.line({-far, 5}, {far, 5}, {.colour = black, .width = 2});
      canvas.line({far, far}, {2 * far, 3 * far}, {.colour = black, .width = 2});
      canvas.line({-far, -far}, {-2 * far, -far}, {.colour = black, .width = 2});
      canvas.fill({{{-far, 15}, {far, 15}, {far, 17}, {-far, 17}}}, black, 1);
      canvas.fill({{{far, 0}, {2 * far, 0}, {2 * far, 20}, {far, 20}}}, black, 1);
      canvas.fill({{{-far, 0}, {-2 * far, 0}, {-2 * far, 20}, {-far, 20}}}, black, 1);
    });
    EXPECT_NEAR(total_ink(picture), 20 * (2 + 2), 0.1) << far;
    for (const int y : {4, 5, 15, 16}) EXPECT_EQ(picture.at(19, y), black) << far;
  }
}

TEST(Canvas, WordsStandAroundTheirMiddleInTheirHeight) {
  testing::Draws draws(5);
  for (const std::string words : {"l", "hello 12.5 m", "bdfhkl", "8"}) {
    const double height = draws.uniform(8, 30);
    const double width = Canvas::text_width(words, height);
    const Vector2d middle(250, 40);
    const Picture picture = drawn(500, 80, [&](Canvas& canvas) {
      canvas.text(middle, words, height, {.colour = black, .width = 1});
    });
    Vector2d low(1e9, 1e9), high(-1e9, -1e9);
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        if (testing::ink(picture.at(x, y)) > 0.4) {
          low = low.cwiseMin(Vector2d(x, y));
          high = high.cwiseMax(Vector2d(x + 1, y + 1));
        }
    EXPECT_NEAR(low.y(), middle.y() - height / 2, 1.5) << words;
    EXPECT_NEAR(high.y(), middle.y() + height / 2, 1.5) << words;
    // The last letter may be narrower than its place.
    EXPECT_GE(low.x(), middle.x() - width / 2 - 1.5) << words;
    EXPECT_LE(high.x(), middle.x() + width / 2 + 1.5) << words;
    EXPECT_GT(high.x() - low.x(), width - 0.6 * height) << words;
  }
}

TEST(Canvas, WordsGrowWithTheirLettersAndHeight) {
  EXPECT_EQ(Canvas::text_width("", 10), 0);
  EXPECT_GT(Canvas::text_width("abc", 10), Canvas::text_width("ab", 10));
  EXPECT_DOUBLE_EQ(Canvas::text_width("abc", 20), 2 * Canvas::text_width("abc", 10));
}

TEST(Canvas, SaysWhereItCannotBeWritten) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "absent" / "picture.png";
  testing::expect_cannot_write(path, [&] { Canvas(3, 3).write_png(path); });
}

}  // namespace
}  // namespace planum
