#pragma once

#include <filesystem>

#include "tools/maps/plan_drawing.hpp"

namespace planum {

/// Writes a drawing as ASCII DXF of AutoCAD 2000 (AC1015), in metres at full size: rooms as closed
/// polylines on layer ROOMS, doors and passages on DOORS, then WINDOWS, DIMENSIONS and TEXT; x and
/// y are those of the drawing. Throws Error if the file cannot be written.
void write_floor_plan_dxf(const std::filesystem::path& path, const PlanDrawing& drawing);

}  // namespace planum
