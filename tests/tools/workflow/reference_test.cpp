#include <algorithm>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tools/workflow/project_keys.hpp"
#include "tools/workflow/stage.hpp"

namespace planum {
namespace {

std::string page(const std::string& name) {
  std::ifstream stream(std::string(PLANUM_SOURCE_DIR) + "/docs/" + name);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string reference_row(const Key& key) {
  const std::string value = value_text(key, Settings());
  return fmt::format("| `{}.{}` | {} | {} | {} |\n", key.section, key.name,
                     value.empty() ? "not set" : "`" + value + "`", allowed_values(key), key.help);
}

TEST(Reference, HasEveryKeyOfTheProjectFileAsItIs) {
  const std::string text = page("command-line.md");
  std::string missing;
  for (const Key& key : project_keys()) {
    const std::string row = reference_row(key);
    if (text.find(row) == std::string::npos) missing += row;
  }
  EXPECT_EQ(missing, "") << "docs/command-line.md lacks these rows";
}

TEST(Reference, NamesEveryStage) {
  const std::string text = page("workflow.md");
  for (const Stage& stage : stages()) {
    EXPECT_NE(text.find("| " + stage.name + " | "), std::string::npos) << stage.name;
  }
}

TEST(Stages, ReadOnlyParametersThatExistAndStagesBeforeThem) {
  std::vector<std::string> before;
  for (const Stage& stage : stages()) {
    for (const std::string& need : stage.needs) {
      EXPECT_NE(std::find(before.begin(), before.end(), need), before.end())
          << stage.name << " needs " << need;
    }
    for (const std::string& name : stage.parameters) {
      bool known = find_key(name) != nullptr;
      for (const Section& section : project_sections()) known = known || section.name == name;
      EXPECT_TRUE(known) << stage.name << " reads " << name;
    }
    EXPECT_EQ(stage_index(stage.name), before.size());
    before.push_back(stage.name);
  }
}

}  // namespace
}  // namespace planum
