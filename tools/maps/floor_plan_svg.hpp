#pragma once

#include <filesystem>

#include "tools/maps/plan_drawing.hpp"

namespace planum {

/// Writes a drawing to scale (SVG, 1:50, its unit is 1 cm of the building). Throws Error if the
/// file cannot be written.
void write_floor_plan_svg(const std::filesystem::path& path, const PlanDrawing& drawing);

}  // namespace planum
