#pragma once

#include <vector>

#include <Eigen/Core>

#include "meshing/surface.hpp"
#include "meshing/voxel_blocks.hpp"

namespace planum {

/// The surface passes between two corners; whether there are points near that place.
inline constexpr std::uint8_t crossing = 1, crossing_near_data = 1 | 8;

/// Signed distances to a surface at the corners of cells, where they are known. Corner (i, j, k) is
/// the lowest corner of cell (i, j, k), and is stored in the block of that cell.
struct DistanceField {
  Lattice lattice;
  BlockSet blocks;
  std::vector<float> distance;  ///< m, positive in free space; not a number: unknown
  /// `crossing << a`: between this corner and the next one along axis a there is surface.
  std::vector<std::uint8_t> crossings;
};

/// Distances to tangent planes (Hoppe et al. 1992), those of the points around averaged, as far as
/// they belong to the same sheet of surface: neither planes that face elsewhere (creases stay
/// sharp) nor those of the other side of a thin wall take part. Only corners near points are
/// stored, and known; so memory grows with surface.
///
/// Throws as reconstruct does.
DistanceField distance_field(const Cloud& cloud, const SurfaceParams& params = {},
                             const Progress& progress = {});

}  // namespace planum
