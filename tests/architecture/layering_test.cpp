#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

// Who may include whom: docs/architecture.md. The test walks every #include of the sources.
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> allowed = {
    {"slam/core", {}},
    {"slam/io", {"slam/core"}},
    {"slam/sensor", {"slam/core"}},
    {"slam/evaluation", {"slam/core"}},
    {"slam/registration", {"slam/core", "slam/io", "slam/sensor"}},
    {"slam/graph", {"slam/core", "slam/io", "slam/sensor", "slam/registration"}},
    {"slam/localization", {"slam/core"}},
    {"meshing", {"slam/core"}},
    {"labeling", {"slam/core", "meshing"}},
};

// Libraries that must not show in headers: a change of one must not reach the users of ours.
const std::vector<std::string> hidden_libraries = {
    "flann/", "ceres/",  "cholmod", "OpenMesh/", "embree",   "geos",   "nlohmann", "toml++",
    "CLI",    "spdlog/", "png.h",   "omp.h",     "octomap/", "Recast", "Detour",   "sdf/"};

/// The layer of a path relative to the root, "tools" for all of tools, "" for what is no layer.
std::string layer_of(const std::string& path) {
  for (const auto& [layer, unused] : allowed)
    if (path.starts_with(layer + "/")) return layer;
  return path.starts_with("tools/") ? "tools" : "";
}

struct Include {
  std::string file, target;
  int line;
  bool quoted;
};

std::vector<Include> includes_below(const std::string& folder) {
  std::vector<Include> found;
  const fs::path root = PLANUM_SOURCE_DIR;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".hpp" && extension != ".cpp") continue;
    std::ifstream in(entry.path());
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      std::istringstream words(line);
      std::string directive, target;
      words >> directive >> target;
      if (directive != "#include" || target.size() < 3) continue;
      found.push_back({fs::relative(entry.path(), root).string(),
                       target.substr(1, target.size() - 2), number, target.front() == '"'});
    }
  }
  return found;
}

std::vector<Include> all_includes() {
  std::vector<Include> all;
  for (const char* folder : {"slam", "meshing", "labeling", "tools"})
    for (Include& include : includes_below(folder)) all.push_back(std::move(include));
  return all;
}

TEST(Layers, IncludeOnlyWhatIsBelowThem) {
  int checked = 0;
  for (const Include& include : all_includes()) {
    if (!include.quoted) continue;
    const std::string from = layer_of(include.file), to = layer_of(include.target);
    ASSERT_NE(from, "") << include.file << " is in no layer of this test";
    EXPECT_NE(to, "") << include.file << ":" << include.line << ": \"" << include.target
                      << "\" is no path from the root of the project";
    if (from == to || from == "tools") continue;
    ++checked;
    EXPECT_TRUE(allowed.at(from).contains(to))
        << include.file << ":" << include.line << ": " << from << " must not include " << to;
  }
  EXPECT_GT(checked, 50) << "the walk found too little to mean anything";
}

TEST(Layers, HeadersShowNoLibraryButEigen) {
  for (const Include& include : all_includes()) {
    if (!include.file.ends_with(".hpp") || include.file.starts_with("tools/")) continue;
    for (const std::string& library : hidden_libraries)
      EXPECT_FALSE(include.target.starts_with(library))
          << include.file << ":" << include.line << ": " << include.target
          << " belongs in a .cpp file";
  }
}

TEST(Layers, LibrariesNeitherPrintNorExit) {
  for (const char* folder : {"slam", "meshing", "labeling"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(PLANUM_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
      std::ifstream in(entry.path());
      std::string line;
      for (int number = 1; std::getline(in, line); ++number)
        for (const char* word : {"std::cout", "std::cerr", "std::exit(", "std::abort(", " printf("})
          EXPECT_EQ(line.find(word), std::string::npos)
              << entry.path().string() << ":" << number << ": " << word;
    }
  }
}

}  // namespace
