#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/tools/planum/small_project.hpp"

namespace planum::testing {
namespace {

using Json = nlohmann::json;

class Register : public ::testing::Test {
 protected:
  Register() { write_small_project(directory_.path()); }

  Outcome planum(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "register");
    return Program(directory_.path())(arguments);
  }

  TemporaryDirectory directory_;
};

Pose pose_in(const Json& rows) {
  Pose pose = Pose::Identity();
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 4; ++j)
      pose.matrix()(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return pose;
}

TEST_F(Register, FindsThePoseOfOneScanInAnother) {
  const std::vector<Pose> truth = small_room_poses();
  const Pose target_from_source = truth[0].inverse() * truth[1];
  const Eigen::Vector3d t = target_from_source.translation();
  const double yaw = degrees(std::atan2(target_from_source(1, 0), target_from_source(0, 0)));
  const std::vector<std::string> guess = {"--guess",
                                          std::to_string(t.x() + 0.15),
                                          std::to_string(t.y() - 0.1),
                                          std::to_string(t.z()),
                                          std::to_string(yaw + 4),
                                          "0",
                                          "0"};
  std::vector<std::string> arguments = {"scans/scan000.slices", "scans/scan001.slices", "--json"};
  arguments.insert(arguments.end(), guess.begin(), guess.end());
  const Outcome outcome = planum(arguments);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  const Pose found = pose_in(json["target_from_source"]);
  EXPECT_LT((found.translation() - t).norm(), 0.01);
  EXPECT_LT(rotation_angle(found, target_from_source), radians(0.3));
  EXPECT_GT(json["overlap"], 0.5);
  EXPECT_LT(json["rms_m"], 0.03);
  EXPECT_EQ(json["information"].size(), 6u);
  EXPECT_EQ(json["weak_directions"], 0);
  EXPECT_EQ(json["doubt"], "");
}

TEST_F(Register, SaysInWordsWhatItFound) {
  const Outcome outcome = planum({"scans/scan000.slices", "scans/scan001.slices", "--no-guess"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* part : {"target from source", "yaw pitch roll", "known to", "overlap"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << outcome.out;
}

TEST_F(Register, DoesNotCallAWrongPlaceAMatch) {
  const Outcome outcome = planum(
      {"scans/scan000.slices", "scans/scan001.slices", "--guess", "30", "0", "0", "0", "0", "0"});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.err.find("do not match: too few points have a pair"), std::string::npos)
      << outcome.err;
}

TEST_F(Register, NamesWhatItCannotRead) {
  const Outcome ending = planum({"scans/scan000.slices", "truth.tum"});
  EXPECT_EQ(ending.exit_code, 3);
  EXPECT_NE(ending.err.find("truth.tum: no file of points"), std::string::npos) << ending.err;
  const Outcome missing = planum({"scans/scan000.slices", "scans/nothing.slices"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_NE(missing.err.find("nothing.slices"), std::string::npos) << missing.err;
  EXPECT_EQ(planum({"scans/scan000.slices", "scans/scan001.slices", "--guess", "1"}).exit_code, 2);
}

}  // namespace
}  // namespace planum::testing
