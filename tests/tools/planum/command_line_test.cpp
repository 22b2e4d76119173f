#include <gtest/gtest.h>

#include "tests/tools/planum/program.hpp"

namespace planum::testing {
namespace {

class CommandLine : public ::testing::Test {
 protected:
  TemporaryDirectory directory_;
  Program planum_{directory_.path()};
};

TEST_F(CommandLine, AloneShowsTheCommandsAndAnExample) {
  const Outcome outcome = planum_({});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_SAYS(outcome.out, "usage: planum COMMAND");
  EXPECT_SAYS(outcome.out, "planum demo");
  EXPECT_SAYS(outcome.out, "bring every stage of a project up to date");
  EXPECT_EQ(planum_({"--help"}).out, outcome.out);
  EXPECT_EQ(planum_({"help"}).out, outcome.out);
}

TEST_F(CommandLine, KnowsItsVersion) {
  const Outcome outcome = planum_({"--version"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out, "planum 0.1.0\n");
}

TEST_F(CommandLine, ExplainsEveryCommandThatItLists) {
  const std::string overview = planum_({}).out;
  for (const char* name : {"demo", "init", "check", "run", "status", "config", "evaluate", "view",
                           "optimize", "simulate", "convert", "polygonize"}) {
    EXPECT_SAYS(overview, std::string("\n  ") + name + " ");
    const Outcome outcome = planum_({name, "--help"});
    EXPECT_EQ(outcome.exit_code, 0) << name;
    EXPECT_SAYS(outcome.out, std::string("planum ") + name);
  }
}

TEST_F(CommandLine, SuggestsTheNearestCommandAndOption) {
  Outcome outcome = planum_({"rnu"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_SAYS(outcome.err, "planum: error: unknown command 'rnu', did you mean 'run'?");

  outcome = planum_({"run", "--frce"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_SAYS(outcome.err, "unknown option '--frce', did you mean '--force'?");

  outcome = planum_({"init"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_SAYS(outcome.err, "SCAN_DIR");

  outcome = planum_({"status", "project.toml", "more"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_SAYS(outcome.err, "'more' is one argument too many");
}

TEST_F(CommandLine, SaysThatThereIsNoProjectFile) {
  const Outcome outcome = planum_({"run", "nowhere.toml"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_SAYS(outcome.err, "nowhere.toml: no such project file; `planum init SCAN_DIR` writes one");
}

}  // namespace
}  // namespace planum::testing
