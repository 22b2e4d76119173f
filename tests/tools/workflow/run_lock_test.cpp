#include "tools/workflow/run_lock.hpp"

#include <unistd.h>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

TEST(RunLock, KeepsASecondRunOutAndNamesTheFirst) {
  const testing::TemporaryDirectory directory;
  std::filesystem::create_directories(directory / "out/.cache");
  const auto file = directory / "out/.cache/lock";
  {
    const RunLock lock(file);
    try {
      const RunLock second(file);
      FAIL() << "two runs at once";
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("another run"), std::string::npos) << message;
      EXPECT_NE(message.find(std::to_string(getpid())), std::string::npos) << message;
      EXPECT_NE(message.find((directory / "out").string() + ";"), std::string::npos) << message;
      EXPECT_EQ(error.kind(), ErrorKind::environment);
    }
  }
  EXPECT_NO_THROW(RunLock{file});
}

}  // namespace
}  // namespace planum
