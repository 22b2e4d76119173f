#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "labeling/labels.hpp"
#include "labeling/plan/cell_lists.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// Whether a polygon with this label is a part of the building, not of what stands in it.
bool is_structure(Label label);

/// Tells which places lie on the building: each of its polygons is drawn in its own plane on a
/// grid, and space is cut into blocks that know the polygons they touch.
class StructureSearch {
 public:
  /// Looks at places within `bounds`; what is nearer to a polygon than `clearance` (m) lies on it.
  StructureSearch(const PolygonMap& map, const Labels& labels, const Eigen::AlignedBox3d& bounds,
                  double clearance);

  /// Whether a place is within the bounds and not on the building.
  bool is_clear(const Eigen::Vector3d& p) const;

 private:
  /// A polygon as cells of a grid in its plane.
  struct Drawing {
    Eigen::Vector3d normal;
    double offset = 0;                 ///< m, of the plane
    Eigen::Matrix<double, 2, 3> axes;  ///< 1/m, cells from the world
    Eigen::Vector2d low;               ///< cells, where the first is
    int columns = 0, rows = 0;
    std::vector<std::uint8_t> is_covered;

    bool covers(int column, int row) const;
  };
  using BlockPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  static Drawing drawn(const PolygonMap& map, const MapPolygon& polygon, double clearance);
  void add_blocks(std::uint32_t id, BlockPairs& pairs) const;
  BlockPairs all_blocks() const;
  Eigen::Vector3i block_of(const Eigen::Vector3d& p) const;
  std::size_t index(const Eigen::Vector3i& block) const;

  double clearance_;
  Eigen::AlignedBox3d bounds_;
  double block_size_;  ///< m
  Eigen::Vector3i blocks_;
  std::vector<Drawing> drawings_;
  CellLists drawings_of_block_;
};

}  // namespace planum
