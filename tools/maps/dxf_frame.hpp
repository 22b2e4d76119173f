#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "tools/maps/dxf_document.hpp"

namespace planum::dxf {

inline constexpr unsigned model_space = 0x1F;  ///< handle of the block that owns all entities
inline constexpr unsigned first_layer = 0x40;  ///< handle of layer 0, those of the others follow

/// What an AutoCAD 2000 file must have around its entities: header, tables, blocks before them, and
/// objects after them. `extent` is what is shown first, `comment` one line, `next_handle` the first
/// handle that nothing has.
std::string before_entities(const std::vector<DxfLayer>& layers, const Eigen::AlignedBox2d& extent,
                            const std::string& comment, unsigned next_handle);
std::string after_entities();

}  // namespace planum::dxf
