#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/workflow/settings.hpp"

namespace planum {

/// The version of the project file that this program reads and writes.
inline constexpr int project_version = 1;

/// A project file that was read and checked.
struct Project {
  std::filesystem::path file;       ///< as it was given, for messages
  std::filesystem::path directory;  ///< absolute; relative paths in the file start here
  Settings settings;
  std::map<std::string, std::string>
      origins;  ///< of every key that was given: "project.toml:7", "--set"
};

/// Reads a project file (a directory stands for the project.toml in it), then applies overrides
/// such as `mesh.voxel_m=0.1`. Throws Error with file, line and column for what is not TOML, an
/// unknown table or key (naming the nearest one), a wrong type, a value out of range, a version
/// that is too new.
Project read_project(const std::filesystem::path& file,
                     const std::vector<std::string>& overrides = {});

/// The settings of a project file that sets nothing, then overrides. Throws as read_project does.
Settings default_settings(const std::vector<std::string>& overrides);

/// A path of the project file, absolute.
std::filesystem::path resolved(const Project& project, const std::string& path);

/// Where results go, absolute.
std::filesystem::path output_directory(const Project& project);

/// A project file with every key explained; those in `values` (full name -> value as TOML) are set,
/// the others are comments that show the default.
std::string project_template(const std::map<std::string, std::string>& values);

}  // namespace planum
