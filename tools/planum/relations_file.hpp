#pragma once

#include <filesystem>
#include <vector>

#include "slam/evaluation/relations.hpp"

namespace planum {

/// Reads true relations: the edges of a .g2o file, or lines `from to x y z roll pitch yaw` (stamps,
/// m, rad, R = Rz(yaw) Ry(pitch) Rx(roll)) as the SLAM benchmark of Kuemmerle et al. has them.
/// Throws Error `path:line` for other lines and numbers that are not finite, and if there is no
/// relation.
std::vector<Relation> read_relations(const std::filesystem::path& path);

}  // namespace planum
