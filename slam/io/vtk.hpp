#pragma once

#include <filesystem>

#include "slam/core/cloud.hpp"

namespace planum {

/// Reads the points of a legacy VTK file (version 1 to 4.2, ASCII; POLYDATA or UNSTRUCTURED_GRID),
/// in metres, as libpointmatcher and ParaView write them. Cells, normals and other attributes are
/// passed over. Points may be nan or inf. Throws Error for files that are binary, cut short or
/// something else.
Cloud read_vtk(const std::filesystem::path& path);

}  // namespace planum
