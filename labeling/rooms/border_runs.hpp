#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "labeling/plan/floor_grid.hpp"
#include "labeling/rooms/region_faces.hpp"

namespace planum {

/// A stretch of a border of cells that follows one face.
struct BorderRun {
  const WallFace* face = nullptr;   ///< null: no face was seen there
  std::size_t first = 0, last = 0;  ///< corners; last may go beyond the end and round again
  double length = 0;                ///< m along the cells
};

/// On which side of a border its faces stand: round a room they look inwards, round a pillar
/// outwards.
enum class BorderSide { around_room, around_pillar };

/// A border of cells as stretches that follow wall faces, from which a ring of straight sides is
/// made.
class BorderRuns {
 public:
  BorderRuns(const FloorGrid& grid, const std::vector<RegionFace>& own_faces,
             const std::vector<WallFace>& faces, std::vector<Eigen::Vector2i> corners,
             BorderSide side);

  const std::vector<BorderRun>& runs() const { return runs_; }
  Eigen::Vector2d corner(std::size_t i) const {
    return corners_[i % corners_.size()].cast<double>() * grid_.cell;
  }

  /// Drops each run between two faces for which `may_go(before, run, after)`; its neighbours then
  /// meet directly.
  using MayGo = std::function<bool(const BorderRun&, const BorderRun&, const BorderRun&)>;
  void drop(const MayGo& may_go);

  /// Share of the border's length that follows faces.
  double face_share() const;

  /// Corners where faces meet, and the simplified border of cells where no face is.
  std::vector<Eigen::Vector2d> ring() const;

 private:
  const WallFace* face_of_edge(std::size_t i, const std::vector<RegionFace>& own_faces,
                               const std::vector<WallFace>& faces, double facing) const;
  void join_equal_neighbours();
  void join_ends();
  void add_joint(const BorderRun& run, const BorderRun& next,
                 std::vector<Eigen::Vector2d>& ring) const;
  void simplify(std::size_t first, std::size_t last, std::vector<Eigen::Vector2d>& kept) const;

  const FloorGrid& grid_;
  std::vector<Eigen::Vector2i> corners_;
  std::vector<BorderRun> runs_;
};

/// Where the lines of two faces meet; the limit of what is near parallel is about 12 degrees.
bool faces_meet(const WallFace& a, const WallFace& b, Eigen::Vector2d& meeting);

}  // namespace planum
