#include "tools/planum/scan_file.hpp"

#include "slam/io/ply.hpp"
#include "slam/io/slices.hpp"
#include "slam/io/uos.hpp"
#include "slam/io/vtk.hpp"
#include "slam/io/xyz.hpp"
#include "slam/sensor/tilted_laser.hpp"

namespace planum {

std::optional<Cloud> read_points_file(const std::filesystem::path& file) {
  const std::filesystem::path ending = file.extension();
  if (ending == ".slices" || (ending == ".txt" && looks_like_slices(file)))
    return points_from_slices(read_slices(file), {.min_range = 0, .max_range = 0}).cloud;
  if (ending == ".3d") return read_uos_scan(file);
  if (ending == ".xyz" || ending == ".pts" || ending == ".asc" || ending == ".dat" ||
      ending == ".txt")
    return read_xyz(file);
  if (ending == ".vtk") return read_vtk(file);
  if (ending == ".ply") return read_ply_cloud(file);
  return std::nullopt;
}

}  // namespace planum
