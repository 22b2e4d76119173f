#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/tools/planum/program.hpp"

namespace planum::testing {
namespace {

/// The lines of all ```sh blocks of a page.
std::vector<std::string> commands_of(const std::filesystem::path& page) {
  std::istringstream lines(file_text(page));
  std::vector<std::string> commands;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      inside = line == "```sh";
    } else if (inside) {
      commands.push_back(line);
    }
  }
  return commands;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

// The first command is the demonstration: this is its end-to-end test too.
TEST(Tutorial, CommandsDoWhatThePageSays) {
  const TemporaryDirectory directory;
  const Program planum(directory.path());
  const auto commands = commands_of(std::filesystem::path(PLANUM_SOURCE_DIR) / "docs/tutorial.md");
  ASSERT_GT(commands.size(), 8u);
  for (const std::string& command : commands) {
    auto words = words_of(command);
    ASSERT_EQ(words.front(), "planum") << command;
    words.erase(words.begin());
    const Outcome outcome = planum(words);
    ASSERT_EQ(outcome.exit_code, 0) << command << "\n" << outcome.out << outcome.err;
    if (command == "planum demo") {
      std::printf("%s", outcome.out.c_str());
      EXPECT_EQ(outcome.out.find("not found"), std::string::npos) << outcome.out;
    }
  }
  const auto report = nlohmann::json::parse(file_text(directory / "planum-demo/out/report.json"));
  const auto& errors = report["evaluation"];
  EXPECT_LT(errors["ate_rmse_m"], 0.03);
  EXPECT_LT(errors["rot_mean_deg"], 0.3);
  EXPECT_GT(errors["odometry"]["ate_rmse_m"], 5 * errors["ate_rmse_m"].get<double>());
  EXPECT_EQ(report["rooms"].size(), 7u);

  const Outcome again = planum({"demo"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.err.find("never run"), std::string::npos) << again.err;
  EXPECT_SAYS(again.err, "mesh          fresh");
}

}  // namespace
}  // namespace planum::testing
