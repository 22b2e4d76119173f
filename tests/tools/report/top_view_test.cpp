#include "tools/report/top_view.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/tools/report/picture.hpp"

namespace planum {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::Picture;
using testing::TemporaryDirectory;

constexpr Colour white = {255, 255, 255};

void add(Cloud& cloud, const Vector3d& point, const Vector3d& normal) {
  cloud.points.push_back(point.cast<float>());
  cloud.normals.push_back(normal.cast<float>());
}

/// Points every 5 mm along a line, three above each other.
void add_wall(Cloud& cloud, const Vector2d& from, const Vector2d& to) {
  const Vector2d along = to - from;
  const Vector3d normal(-along.normalized().y(), along.normalized().x(), 0);
  const int count = static_cast<int>(along.norm() / 0.005);
  for (int i = 0; i <= count; ++i) {
    const Vector2d p = from + along * i / count;
    for (const double z : {0.5, 1.0, 1.5}) add(cloud, {p.x(), p.y(), z}, normal);
  }
}

const Vector2d room_size(10, 6);

/// The walls of a room of 10 x 6 m with a corner at 0, a short one inside, floor and ceiling.
Cloud room_cloud() {
  Cloud cloud;
  const double w = room_size.x(), d = room_size.y();
  add_wall(cloud, {0, 0}, {w, 0});
  add_wall(cloud, {w, 0}, {w, d});
  add_wall(cloud, {w, d}, {0, d});
  add_wall(cloud, {0, d}, {0, 0});
  add_wall(cloud, {2, 5}, {2.2, 5});
  for (double x = -3; x < 13; x += 0.05)
    for (double y = -3; y < 9; y += 0.05) {
      add(cloud, {x, y, 0}, {0, 0, 1});
      add(cloud, {x, y, 2.5}, {0, 0, -1});
    }
  return cloud;
}

Pose at(double x, double y) { return Pose(Eigen::Translation3d(x, y, 0.8)); }

const std::vector<Pose> some_path = {at(1, 1), at(4, 2), at(7, 1), at(8, 4)};

Picture drawn(const TopView& view, const TopViewParams& params = {}) {
  const TemporaryDirectory directory;
  write_top_view(directory / "topview.png", view, params);
  return testing::read_png(directory / "topview.png");
}

TopView view_of(const Cloud& cloud) {
  return {.cloud = cloud, .before = {}, .after = {}, .names = {}, .loops = {}};
}

/// Where things of the room are in its picture, from what the header says: the longest side and
/// the margin.
struct RoomFrame {
  TopViewParams params = {};
  double scale = params.longest_side / (room_size.x() + 2 * params.margin);  // pixels a metre

  Vector2d operator()(double x, double y) const {
    return scale * Vector2d(x + params.margin, room_size.y() + params.margin - y);
  }
  Vector2d operator()(const Pose& p) const {
    return (*this)(p.translation().x(), p.translation().y());
  }
  int plan_height() const { return static_cast<int>(scale * (room_size.y() + 2 * params.margin)); }
};

double distance_to_path(const Vector2d& p, const std::vector<Vector2d>& path) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Vector2d along = path[i + 1] - path[i];
    const double t = std::clamp((p - path[i]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    best = std::min(best, (p - path[i] - t * along).norm());
  }
  return best;
}

/// The pixels of the plan (without the legend) in which two pictures of the room differ.
std::vector<Vector2d> changes(const Picture& a, const Picture& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  std::vector<Vector2d> found;
  for (int y = 0; y < std::min(RoomFrame().plan_height(), std::min(a.height, b.height)); ++y)
    for (int x = 0; x < std::min(a.width, b.width); ++x)
      if (a.at(x, y) != b.at(x, y)) found.emplace_back(x + 0.5, y + 0.5);
  return found;
}

/// The pixels that changed are those within `reach` of a line, and those on it all did.
void expect_line(const Picture& without, const Picture& with, const std::vector<Vector2d>& line,
                 double reach) {
  for (const Vector2d& p : changes(without, with))
    ASSERT_LE(distance_to_path(p, line), reach) << p.transpose();
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    for (double t = 0; t <= 1; t += 0.01) {
      const Vector2d p = line[i] + t * (line[i + 1] - line[i]);
      const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
      EXPECT_NE(without.at(x, y), with.at(x, y)) << p.transpose();
    }
}

/// Red, green and blue of a pixel around a place of the room.
Colour colour_at(const Picture& picture, const Vector2d& p) {
  return picture.at(static_cast<int>(p.x()), static_cast<int>(p.y()));
}

TEST(TopView, ShowsWallsWhereTheyAreAndNeitherFloorNorCeiling) {
  const Cloud cloud = room_cloud();
  const Picture picture = drawn(view_of(cloud));
  const RoomFrame frame;
  EXPECT_EQ(picture.width, 1600);
  EXPECT_GT(picture.height, frame.plan_height());
  EXPECT_LT(picture.height, frame.plan_height() + 100);
  const std::vector<Vector2d> walls = {frame(0, 0), frame(10, 0), frame(10, 6), frame(0, 6),
                                       frame(0, 0)};
  const std::vector<Vector2d> inner = {frame(2, 5), frame(2.2, 5)};
  for (int y = 0; y < frame.plan_height(); ++y)
    for (int x = 0; x < picture.width; ++x) {
      const Vector2d p(x + 0.5, y + 0.5);
      if (distance_to_path(p, walls) <= 1 || distance_to_path(p, inner) <= 1) continue;
      ASSERT_EQ(picture.at(x, y), white) << p.transpose();
    }
  const auto darkest_around = [&](const Vector2d& p) {
    double darkest = 0;
    for (const int dx : {-1, 0, 1})
      for (const int dy : {-1, 0, 1})
        darkest = std::max(darkest, testing::ink(colour_at(picture, p + Vector2d(dx, dy))));
    return darkest;
  };
  for (const auto& line : {walls, inner})
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
      for (double t = 0; t <= 1; t += 0.01)
        EXPECT_GT(darkest_around(line[i] + t * (line[i + 1] - line[i])), 0.4);
}

TEST(TopView, DrawsThePathThroughItsPoses) {
  const Cloud cloud = room_cloud();
  const RoomFrame frame;
  std::vector<Vector2d> line;
  for (const Pose& pose : some_path) line.push_back(frame(pose));
  TopView view = view_of(cloud);
  const Picture without = drawn(view);
  view.after = some_path;
  const Picture after = drawn(view);
  expect_line(without, after, line, 5);
  view.after.clear();
  view.before = some_path;
  const Picture before = drawn(view);
  expect_line(without, before, line, 5);
  for (const Vector2d& p : line) EXPECT_NE(colour_at(before, p), colour_at(after, p));
  // The result is drawn over what it began with.
  view.after = some_path;
  const Picture both = drawn(view);
  for (const Vector2d& p : line) EXPECT_EQ(colour_at(both, p), colour_at(after, p));
}

TEST(TopView, DrawsLoopsFromPoseToPose) {
  const Cloud cloud = room_cloud();
  const RoomFrame frame;
  TopView view = view_of(cloud);
  view.after = some_path;
  const Picture without = drawn(view);
  view.loops = {{0, 3}};
  const Picture with = drawn(view);
  const std::vector<Vector2d> line = {frame(some_path[0]), frame(some_path[3])};
  for (const Vector2d& p : changes(without, with)) ASSERT_LE(distance_to_path(p, line), 3);
  for (const double t : {0.2, 0.4, 0.7, 0.9}) {
    const Vector2d p = line[0] + t * (line[1] - line[0]);
    EXPECT_NE(colour_at(without, p), colour_at(with, p)) << t;
  }
}

TEST(TopView, WritesTheNamesOfScansBesideThem) {
  const Cloud cloud = room_cloud();
  const RoomFrame frame;
  TopView view = view_of(cloud);
  view.after = some_path;
  const Picture without = drawn(view);
  view.names = {"0", "1", "2", "3", "more than there are poses"};
  std::vector<int> changed(some_path.size());
  for (const Vector2d& p : changes(without, drawn(view))) {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < some_path.size(); ++i)
      if ((p - frame(some_path[i])).norm() < (p - frame(some_path[nearest])).norm()) nearest = i;
    EXPECT_LT((p - frame(some_path[nearest])).norm(), 30);
    ++changed[nearest];
  }
  for (const int count : changed) EXPECT_GT(count, 10);
}

TEST(TopView, FillsRoomsAndWritesTheirNames) {
  const Cloud cloud = room_cloud();
  const RoomFrame frame;
  RoomMap rooms;
  rooms.rooms.resize(1);
  Room& room = rooms.rooms[0];
  room.outline = {{1, 1, 0}, {9, 1, 0}, {9, 4, 0}, {1, 4, 0}};
  room.centre = {5, 2.5, 1};
  room.name = "";
  TopView view = view_of(cloud);
  const Picture without = drawn(view);
  view.rooms = &rooms;
  const Picture unnamed = drawn(view);
  const Vector2d low = frame(1, 4), high = frame(9, 1);
  const std::vector<Vector2d> filled = changes(without, unnamed);
  for (const Vector2d& p : filled) {
    ASSERT_TRUE((p.array() > low.array() - 1).all()) << p.transpose();
    ASSERT_TRUE((p.array() < high.array() + 1).all()) << p.transpose();
  }
  const Vector2d size = high - low;
  EXPECT_NEAR(static_cast<double>(filled.size()), size.prod(), 2 * size.sum());
  room.name = "room 1";
  const std::vector<Vector2d> letters = changes(unnamed, drawn(view));
  EXPECT_GT(letters.size(), 50u);
  for (const Vector2d& p : letters) {
    EXPECT_LT(std::abs(p.x() - frame(5, 2.5).x()), 60);
    EXPECT_LT(std::abs(p.y() - frame(5, 2.5).y()), 14);
  }
}

TEST(TopView, DrawsOpeningsInTheirWidthAlongTheWall) {
  const Cloud cloud = room_cloud();
  const RoomFrame frame;
  RoomMap rooms;
  TopView view = view_of(cloud);
  view.rooms = &rooms;
  const Picture without = drawn(view);
  rooms.openings.resize(1);
  rooms.openings[0] = {.kind = OpeningKind::door,
                       .position = {10, 2, 1},
                       .across = {-1, 0, 0},
                       .width = 0.9,
                       .rooms = {}};
  const Picture door = drawn(view);
  expect_line(without, door, {frame(10, 1.55), frame(10, 2.45)}, 0.06 * frame.scale);
  rooms.openings[0].kind = OpeningKind::window;
  const Picture window = drawn(view);
  EXPECT_NE(colour_at(window, frame(10, 2)), colour_at(door, frame(10, 2)));
  rooms.openings[0].across = {0, 1, 0};
  rooms.openings[0].position = {7, 6, 1};
  expect_line(without, drawn(view), {frame(6.55, 6), frame(7.45, 6)}, 0.06 * frame.scale);
}

TEST(TopView, LeavesStrayPointsOutside) {
  Cloud cloud = room_cloud();
  const Picture without = drawn(view_of(cloud));
  for (int i = 0; i < 5; ++i) add(cloud, {500.0 + i, -900.0 * i, 1}, {1, 0, 0});
  EXPECT_EQ(drawn(view_of(cloud)).pixels, without.pixels);
}

/// Points at the corners of an upright box.
Cloud corner_cloud(const Vector2d& size) {
  Cloud cloud;
  for (const double x : {0.0, size.x()})
    for (const double y : {0.0, size.y()}) add(cloud, {x, y, 1}, {1, 0, 0});
  return cloud;
}

TEST(TopView, LongestSideIsAsAskedFor) {
  testing::Draws draws(1);
  for (int draw = 0; draw < 12; ++draw) {
    const Vector2d size(draws.uniform(5, 50), draws.uniform(0, 5));
    const TopViewParams params = {.longest_side = 800 + static_cast<int>(draws.below(400))};
    const Cloud wide = corner_cloud(size);
    const Picture landscape = drawn(view_of(wide), params);
    EXPECT_EQ(landscape.width, params.longest_side);
    const Cloud narrow = corner_cloud({size.y(), size.x()});
    const Picture portrait = drawn(view_of(narrow), params);
    const double ratio = (size.y() + 0.8) / (size.x() + 0.8);
    const double legend = landscape.height - ratio * params.longest_side;
    EXPECT_NEAR(portrait.height - params.longest_side, legend, 1);
  }
}

/// The longest run of dark pixels in a row of the legend.
int scale_bar(const Picture& picture) {
  int longest = 0;
  for (int y = picture.height - 50; y < picture.height; ++y) {
    int run = 0;
    for (int x = 0; x < picture.width; ++x) {
      run = testing::ink(picture.at(x, y)) > 0.4 ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  }
  return longest;
}

TEST(TopView, ScaleBarIsARoundNumberOfMetres) {
  for (const double size : {0.4, 1.5, 3.0, 7.0, 20.0, 60.0, 250.0}) {
    const Cloud cloud = corner_cloud({size, size / 3});
    const Picture picture = drawn(view_of(cloud), {.longest_side = 1200});
    const double metre = 1200 / (size + 0.8);
    const int bar = scale_bar(picture);
    EXPECT_LE(bar, 1200 / 6 + 4) << size << " m";
    EXPECT_GE(bar, 1200 / 6 / 2.5 - 4) << size << " m";
    bool is_round = false;
    for (const double metres : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0})
      is_round |= std::abs(bar - metres * metre) < 4;
    EXPECT_TRUE(is_round) << size << " m: " << bar / metre;
  }
}

TEST(TopView, LegendFitsIntoANarrowPicture) {
  const Cloud cloud = corner_cloud({1, 40});
  RoomMap rooms;
  rooms.openings.resize(1);
  rooms.openings[0].width = 0.9;
  TopView view = view_of(cloud);
  view.before = view.after = {at(0.5, 10), at(0.5, 30)};
  view.loops = {{0, 1}};
  view.rooms = &rooms;
  const Picture picture = drawn(view);
  std::vector<int> inked;
  for (int x = 0; x < picture.width; ++x)
    for (int y = picture.height - 50; y < picture.height; ++y)
      if (picture.at(x, y) != white) {
        inked.push_back(x);
        break;
      }
  EXPECT_LT(inked.back(), picture.width - 5);
}

TEST(TopView, OfAPathAloneDoesNotDependOnWhereItIs) {
  Cloud floor;
  for (int i = 0; i < 100; ++i) add(floor, {0.1 * i, 0, 0}, {0, 0, 1});
  TopView view = view_of(floor);
  view.after = some_path;
  const Picture here = drawn(view);
  for (Pose& pose : view.after) pose.pretranslate(Vector3d(64, -32, 0));
  const Picture there = drawn(view);
  ASSERT_EQ(there.width, here.width);
  ASSERT_EQ(there.height, here.height);
  int differing = 0;
  for (std::size_t i = 0; i < here.pixels.size(); ++i)
    for (const std::size_t k : {0, 1, 2})
      differing += std::abs(here.pixels[i][k] - there.pixels[i][k]) > 1;
  EXPECT_EQ(differing, 0);
}

TEST(TopView, OfNothingIsAPictureToo) {
  const Cloud none;
  const Picture picture = drawn(view_of(none));
  EXPECT_EQ(picture.width, 1600);
  for (int x = 0; x < picture.width; ++x) ASSERT_EQ(picture.at(x, 800), white);
}

std::string error_with(const TopView& view, const TopViewParams& params) {
  const TemporaryDirectory directory;
  return testing::error_of([&] { write_top_view(directory / "topview.png", view, params); });
}

TEST(TopView, SaysWhatIsMissingOrOutOfRange) {
  Cloud cloud = corner_cloud({4, 3});
  EXPECT_EQ(error_with(view_of(cloud), {.longest_side = 99}),
            "top view: longest_side must be >= 100 pixels, got 99");
  EXPECT_EQ(error_with(view_of(cloud), {.margin = 0}), "top view: margin must be > 0 m, got 0");
  cloud.normals.pop_back();
  EXPECT_EQ(error_with(view_of(cloud), {}), "top view: the cloud has no normals");
}

TEST(TopView, SaysWhereItCannotBeWritten) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "absent" / "topview.png";
  const Cloud none;
  testing::expect_cannot_write(path, [&] { write_top_view(path, view_of(none)); });
}

}  // namespace
}  // namespace planum
