#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "meshing/polygon_map.hpp"
#include "slam/core/cloud.hpp"
#include "slam/core/progress.hpp"
#include "slam/core/triangle_mesh.hpp"
#include "tools/workflow/labelled.hpp"
#include "tools/workflow/settings.hpp"

namespace planum {

/// The steps from a cloud to a labelled map, as the stages of a run and `planum polygonize` take
/// them. `cloud` has normals and a `scan` index into `origins` (m); without origins nothing is
/// known of free space, so that there are no shadows, rooms and objects.

/// The planes of a mesh as polygons, laser shadows in them filled.
PolygonMap polygon_map(const TriangleMesh& mesh, const Cloud& cloud,
                       std::span<const Eigen::Vector3d> origins, const Settings& settings,
                       const Progress& progress = {});

/// Labels, rooms with their openings, and objects, which are matched with the models of
/// `model_files` (empty: the built-in ones). There are no rooms where why_not_level says why.
Labelled labelled_map(const PolygonMap& map, const Cloud& cloud,
                      std::span<const Eigen::Vector3d> origins,
                      const std::vector<std::filesystem::path>& model_files,
                      const Settings& settings, const Progress& progress = {});

/// Rooms and floor plans are found in plan, so "up" must be z: what to tell the user where it is
/// not ("the world is 30 degrees from level").
std::optional<std::string> why_not_level(const Labels& labels);

}  // namespace planum
