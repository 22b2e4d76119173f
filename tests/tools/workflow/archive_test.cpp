#include "tools/workflow/archive.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "slam/core/pose.hpp"
#include "tools/workflow/stored_types.hpp"

namespace planum {
namespace {

struct Part {
  std::string name;
  std::vector<double> numbers;
};
struct Whole {
  int count = 0;
  Pose pose = Pose::Identity();
  std::vector<Part> parts;
  std::array<std::uint32_t, 3> triangle{};
  bool flag = false;
};

template <class Archive>
void fields(Archive& archive, Part& part) {
  archive(part.name, part.numbers);
}
template <class Archive>
void fields(Archive& archive, Whole& whole) {
  archive(whole.count, whole.pose, whole.parts, whole.triangle, whole.flag);
}

const Whole example = {7,
                       exp_se3((Vector6d() << 1, 2, 3, 0.1, 0.2, 0.3).finished()),
                       {{"one", {0.1, std::numeric_limits<double>::quiet_NaN()}}, {"", {}}},
                       {1, 2, 3},
                       true};

TEST(Archive, GivesBackExactlyWhatWentIn) {
  const std::string bytes = archived(example);
  EXPECT_EQ(archived(unarchived<Whole>(bytes)), bytes);
  const Whole back = unarchived<Whole>(bytes);
  EXPECT_EQ(back.pose.matrix(), example.pose.matrix());
  EXPECT_EQ(back.parts.at(0).name, "one");
  EXPECT_EQ(back.triangle, example.triangle);
}

TEST(Archive, RefusesBytesThatAreCutOrLongerAtEveryPlace) {
  const std::string bytes = archived(example);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(unarchived<Whole>(std::string_view(bytes).substr(0, size)), Error) << size;
  }
  EXPECT_THROW(unarchived<Whole>(bytes + "x"), Error);
}

TEST(Archive, KeepsCloudsExactly) {
  Cloud cloud;
  cloud.points = {{1, 2, 3}, {4, 5, 6}};
  cloud.intensity = {0.5f, 1.5f};
  const Cloud back = unarchived<Cloud>(archived(cloud));
  EXPECT_EQ(back.points, cloud.points);
  EXPECT_EQ(back.intensity, cloud.intensity);
  EXPECT_TRUE(back.normals.empty());
}

}  // namespace
}  // namespace planum
