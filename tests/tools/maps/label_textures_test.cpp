#include "tools/maps/label_textures.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"
#include "slam/io/atomic_file.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/tools/maps/small_map.hpp"
#include "tests/tools/report/picture.hpp"
#include "tools/maps/texture_frames.hpp"

namespace planum {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;
using testing::Picture;
using testing::small_map;
using testing::SmallMap;

Picture picture_of(Label label) {
  const testing::TemporaryDirectory directory;
  write_file_atomically(directory / "texture.png", texture_png(label));
  return testing::read_png(directory / "texture.png", PNG_FORMAT_RGB_COLORMAP);
}

/// Mean difference of brightness between columns (or rows) `a` and `b`, of 255.
double difference(const Picture& picture, int a, int b, bool of_columns) {
  double sum = 0;
  for (int i = 0; i < picture.width; ++i) {
    const Colour& p = of_columns ? picture.at(a, i) : picture.at(i, a);
    const Colour& q = of_columns ? picture.at(b, i) : picture.at(i, b);
    sum += std::abs(p[1] - q[1]);
  }
  return sum / picture.width;
}

TEST(LabelTextures, AreSmallSquaresThatDiffer) {
  std::set<std::string> pictures;
  std::size_t bytes = 0;
  for (const Label label : all_labels) {
    const Picture picture = picture_of(label);
    EXPECT_EQ(picture.width, picture.height);
    EXPECT_TRUE(std::has_single_bit(static_cast<unsigned>(picture.width)));
    EXPECT_GE(texture_size(label), 0.3);
    EXPECT_LE(texture_size(label), 2);
    EXPECT_EQ(texture_png(label), texture_png(label));
    bytes += texture_png(label).size();
    pictures.insert(texture_png(label));
  }
  EXPECT_EQ(pictures.size(), all_labels.size());
  EXPECT_LT(bytes, 120'000u);
}

TEST(LabelTextures, FitOntoThemselves) {
  for (const Label label : all_labels) {
    const Picture picture = picture_of(label);
    for (const bool of_columns : {true, false}) {
      // The seam is no harder than the hardest edge within the picture.
      double hardest = 0;
      for (int i = 0; i + 1 < picture.width; ++i)
        hardest = std::max(hardest, difference(picture, i, i + 1, of_columns));
      EXPECT_LE(difference(picture, picture.width - 1, 0, of_columns), hardest)
          << name(label) << (of_columns ? " columns" : " rows");
    }
  }
}

TEST(TextureFrames, AreToScaleAndUprightOnWalls) {
  const Pose world_from_room = pose_from_xyz_ypr({5, -3, 1}, radians(25), 0, 0);
  const SmallMap small = small_map(world_from_room);
  const auto frames = texture_frames(small.map, small.labels);
  ASSERT_EQ(frames.size(), small.map.polygons.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double size = texture_size(small.labels.polygons[i].label);
    const Vector3d u = size * frames[i].u, v = size * frames[i].v;
    const Vector3d& normal = small.map.polygons[i].plane.normal;
    EXPECT_NEAR(u.norm(), 1, 1e-9);
    EXPECT_NEAR(v.norm(), 1, 1e-9);
    EXPECT_NEAR(u.dot(v), 0, 1e-9);
    EXPECT_NEAR(u.dot(normal), 0, 1e-9);
    EXPECT_NEAR(v.dot(normal), 0, 1e-9);
    EXPECT_NEAR(u.z(), 0, 1e-9);
    if (std::abs(normal.z()) > 0.5) {  // along the walls
      const Vector2d way = (world_from_room.linear().transpose() * u).head<2>().cwiseAbs();
      EXPECT_NEAR(way.maxCoeff(), 1, 1e-6);
    } else {
      EXPECT_NEAR(v.z(), 1, 1e-9);
      EXPECT_NEAR((u.cross(v) - normal).norm(), 0, 1e-9) << "not mirrored";
    }
  }
}

TEST(TextureFrames, ContinueFromFloorToFloor) {
  SmallMap small = small_map();
  MapPolygon step = small.map.polygons[0];
  step.plane.normal = Vector3d(0.02, 0, 1).normalized();
  small.map.polygons.push_back(step);
  small.labels.polygons.push_back({Label::floor, 1});
  const auto frames = texture_frames(small.map, small.labels);
  EXPECT_EQ(frames.front().u, frames.back().u);
  EXPECT_EQ(frames.front().v, frames.back().v);
}

TEST(TextureFrames, SaysWhenLabelsAreOfAnotherMap) {
  const SmallMap small = small_map();
  EXPECT_THROW(texture_frames(small.map, {}), Error);
  EXPECT_TRUE(texture_frames({}, {}).empty());
}

}  // namespace
}  // namespace planum
