#pragma once

#include <filesystem>

#include "labeling/rooms.hpp"

namespace planum {

/// Writes the rooms as a drawing to scale (SVG, 1:50, its unit is 1 cm of the building): outlines,
/// names, areas, width and depth between walls as dimension lines, doors with a leaf and its swing
/// (which side it is hung on is not known: the drawing assumes one), windows, passages. The main
/// direction of the largest room is horizontal. Throws Error if there are no rooms, or if the file
/// cannot be written.
void write_floor_plan_svg(const std::filesystem::path& path, const RoomMap& rooms);

}  // namespace planum
