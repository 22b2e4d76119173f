#pragma once

#include <filesystem>

#include "tools/maps/labelled_map.hpp"

namespace planum {

/// Writes the map as CityJSON 2.0: a Building with its BuildingStoreys, a BuildingRoom for each
/// room, and pieces of furniture and stairs, all as MultiSurfaces whose rings are those of
/// polygons.json (counter-clockwise seen from free space). See docs/maps.md for what becomes what.
/// Throws Error if there is no polygon, if labels or rooms do not match the polygons, if a polygon
/// is not plane, or if the file cannot be written.
void write_city_json(const std::filesystem::path& path, const LabelledMap& map);

}  // namespace planum
