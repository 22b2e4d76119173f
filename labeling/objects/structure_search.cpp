#include "labeling/objects/structure_search.hpp"

#include <algorithm>
#include <cmath>

#include "meshing/plane_geometry.hpp"

namespace planum {
namespace {

constexpr int cells_of_patch = 5;
constexpr double smallest_block = 0.25;  // m
constexpr double most_cells = 1 << 24;

std::vector<Ring2d> flat_rings(const PolygonMap& map, const MapPolygon& polygon,
                               const PlaneFrame& frame) {
  std::vector<Ring2d> rings;
  const auto add = [&](const Ring& ring) {
    rings.emplace_back();
    for (const std::uint32_t v : ring) rings.back().push_back(frame.flat(map.vertices[v]));
  };
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) add(hole);
  return rings;
}

/// Where a line of constant y crosses rings, ascending.
std::vector<double> crossings(const std::vector<Ring2d>& rings, double y) {
  std::vector<double> result;
  for (const Ring2d& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() > y) != (b.y() > y))
        result.push_back(a.x() + (y - a.y()) * (b.x() - a.x()) / (b.y() - a.y()));
    }
  std::sort(result.begin(), result.end());
  return result;
}

/// Each cell that is covered, and those beside it.
std::vector<std::uint8_t> widened(const std::vector<std::uint8_t>& cells, int columns, int rows) {
  std::vector<std::uint8_t> result(cells.size(), 0);
  for (int row = 1; row + 1 < rows; ++row)
    for (int column = 1; column + 1 < columns; ++column) {
      if (!cells[static_cast<std::size_t>(row * columns + column)]) continue;
      for (int r = row - 1; r <= row + 1; ++r)
        std::fill_n(result.begin() + r * columns + column - 1, 3, 1);
    }
  return result;
}

}  // namespace

bool is_structure(Label label) {
  return label == Label::floor || label == Label::ceiling || label == Label::wall ||
         label == Label::door || label == Label::window || label == Label::stair;
}

bool StructureSearch::Drawing::covers(int column, int row) const {
  return column >= 0 && row >= 0 && column < columns && row < rows &&
         is_covered[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(column)];
}

StructureSearch::Drawing StructureSearch::drawn(const PolygonMap& map, const MapPolygon& polygon,
                                                double clearance) {
  const PlaneFrame frame(polygon.plane);
  const std::vector<Ring2d> rings = flat_rings(map, polygon, frame);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : rings[0]) box.extend(p);
  const Eigen::Vector2d size = box.sizes();
  const double cell = std::max(clearance, std::sqrt(size.x() * size.y() / most_cells));

  Drawing result{.normal = polygon.plane.normal,
                 .offset = polygon.plane.offset,
                 .axes = {},
                 .low = box.min() / cell - Eigen::Vector2d::Constant(2),
                 .columns = static_cast<int>(size.x() / cell) + 5,
                 .rows = static_cast<int>(size.y() / cell) + 5,
                 .is_covered = {}};
  for (int axis = 0; axis < 3; ++axis)
    result.axes.col(axis) = frame.flat(Eigen::Vector3d::Unit(axis)) / cell;
  std::vector<std::uint8_t> inside(
      static_cast<std::size_t>(result.columns) * static_cast<std::size_t>(result.rows), 0);
  for (int row = 0; row < result.rows; ++row) {
    const std::vector<double> ends = crossings(rings, (result.low.y() + row + 0.5) * cell);
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
      // Cells whose centres lie between.
      const auto first = static_cast<int>(std::ceil(ends[i] / cell - result.low.x() - 0.5));
      const auto last = static_cast<int>(std::floor(ends[i + 1] / cell - result.low.x() - 0.5));
      if (first <= last)
        std::fill(inside.begin() + row * result.columns + first,
                  inside.begin() + row * result.columns + last + 1, 1);
    }
  }
  result.is_covered = widened(inside, result.columns, result.rows);
  return result;
}

StructureSearch::StructureSearch(const PolygonMap& map, const Labels& labels,
                                 const Eigen::AlignedBox3d& bounds, double clearance)
    : clearance_(clearance),
      bounds_(bounds),
      block_size_(std::max(smallest_block, std::cbrt(bounds.volume() / most_cells))),
      blocks_(Eigen::Vector3i::Ones() + (bounds.sizes() / block_size_).cast<int>()),
      drawings_([&] {
        std::vector<Drawing> drawings;
        for (std::size_t i = 0; i < map.polygons.size(); ++i)
          if (is_structure(labels.polygons[i].label))
            drawings.push_back(drawn(map, map.polygons[i], clearance));
        return drawings;
      }()),
      drawings_of_block_(static_cast<std::size_t>(blocks_.cast<double>().prod()), all_blocks()) {}

Eigen::Vector3i StructureSearch::block_of(const Eigen::Vector3d& p) const {
  return ((p - bounds_.min()) / block_size_).array().floor().cast<int>();
}

std::size_t StructureSearch::index(const Eigen::Vector3i& block) const {
  const auto at = block.cast<std::size_t>(), size = blocks_.cast<std::size_t>();
  return (at.z() * size.y() + at.y()) * size.x() + at.x();
}

StructureSearch::BlockPairs StructureSearch::all_blocks() const {
  BlockPairs pairs;
  for (std::uint32_t id = 0; id < drawings_.size(); ++id) add_blocks(id, pairs);
  return pairs;
}

void StructureSearch::add_blocks(std::uint32_t id, BlockPairs& pairs) const {
  const Drawing& drawing = drawings_[id];
  const double cell = 1 / drawing.axes.row(0).norm();
  const auto raised = [&](double column, double row) -> Eigen::Vector3d {
    return drawing.offset * drawing.normal +
           cell * cell * drawing.axes.transpose() * (drawing.low + Eigen::Vector2d(column, row));
  };
  const auto is_any_covered = [&](int column, int row) {
    for (int r = row; r < row + cells_of_patch; ++r)
      for (int c = column; c < column + cells_of_patch; ++c)
        if (drawing.covers(c, r)) return true;
    return false;
  };
  for (int row = 0; row < drawing.rows; row += cells_of_patch)
    for (int column = 0; column < drawing.columns; column += cells_of_patch) {
      if (!is_any_covered(column, row)) continue;
      Eigen::AlignedBox3d patch;
      for (const int r : {row, row + cells_of_patch})
        for (const int c : {column, column + cells_of_patch}) patch.extend(raised(c, r));
      const Eigen::Vector3d margin = clearance_ * drawing.normal.cwiseAbs();
      const Eigen::Vector3i first = block_of(patch.min() - margin).cwiseMax(0);
      const Eigen::Vector3i last =
          block_of(patch.max() + margin).cwiseMin(blocks_ - Eigen::Vector3i::Ones());
      for (int z = first.z(); z <= last.z(); ++z)
        for (int y = first.y(); y <= last.y(); ++y)
          for (int x = first.x(); x <= last.x(); ++x)
            pairs.emplace_back(static_cast<std::uint32_t>(index({x, y, z})), id);
    }
}

bool StructureSearch::is_clear(const Eigen::Vector3d& p) const {
  if (!bounds_.contains(p)) return false;
  for (const std::uint32_t id : drawings_of_block_.at(index(block_of(p)))) {
    const Drawing& drawing = drawings_[id];
    if (std::abs(drawing.normal.dot(p) - drawing.offset) > clearance_) continue;
    const Eigen::Vector2d at = drawing.axes * p - drawing.low;
    if (drawing.covers(static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y()))))
      return false;
  }
  return true;
}

}  // namespace planum
