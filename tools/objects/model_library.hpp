#pragma once

#include <filesystem>
#include <vector>

#include "labeling/objects/object_models.hpp"

namespace planum {

/// A table, a chair and a cabinet, which may be larger or smaller within the limits of their kinds.
std::vector<ObjectModel> built_in_models();

/// The .obj files of a directory, in the order of their names.
std::vector<std::filesystem::path> model_files(const std::filesystem::path& directory);

/// Models of these files, named after them: metres, z up, of fixed size. Throws Error for files
/// that cannot be read.
std::vector<ObjectModel> read_models(const std::vector<std::filesystem::path>& files);

}  // namespace planum
