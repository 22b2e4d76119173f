#pragma once

#include <filesystem>

#include "tools/maps/labelled_map.hpp"

namespace planum {

/// Writes polygons.json (docs/formats-results.md). Throws Error if labels and polygons do not
/// match, or if the file cannot be written.
void write_polygons_json(const std::filesystem::path& path, const LabelledMap& map);

}  // namespace planum
