#include "tools/maps/occupancy_map.hpp"

#include <string>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"

namespace planum {
namespace {

char grey(Occupancy cell) {
  switch (cell) {
    case Occupancy::free:
      return static_cast<char>(254);
    case Occupancy::occupied:
      return 0;
    case Occupancy::unknown:
      break;
  }
  return static_cast<char>(205);
}

}  // namespace

void write_occupancy_map(const std::filesystem::path& path, const OccupancyGrid& map) {
  const FloorGrid& grid = map.grid;
  if (map.cells.empty() || map.cells.size() != grid.size())
    throw Error(fmt::format("{}: a map of {} x {} cells with {} values", path.string(),
                            grid.columns, grid.rows, map.cells.size()));
  std::filesystem::path image = path;
  image.replace_extension(".pgm");
  std::string pixels = fmt::format("P5\n{} {}\n255\n", grid.columns, grid.rows);
  for (int row = grid.rows; row-- > 0;)  // an image begins at the top
    for (int column = 0; column < grid.columns; ++column)
      pixels += grey(map.cells[grid.index(column, row)]);
  write_file_atomically(image, pixels);
  write_file_atomically(
      path, fmt::format("image: {}\nmode: trinary\nresolution: {:.6g}\n"
                        "origin: [{:.6f}, {:.6f}, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
                        "free_thresh: 0.196\n",
                        image.filename().string(), grid.cell, map.corner().x(), map.corner().y()));
}

}  // namespace planum
