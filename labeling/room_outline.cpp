#include "labeling/room_outline.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace planum {
namespace {

constexpr double snap_distance = 0.20;  // m between the border of the cells and a face
constexpr double short_run = 0.30;      // m, interruptions of a face that are ignored
constexpr double tolerance = 0.08;      // m, of the border where no face was seen

/// Corners of cells along the border of a region, which lies to the left.
std::vector<Eigen::Vector2i> border_corners(const FloorGrid& grid, const RoomRegions& regions,
                                            std::size_t region) {
  const auto inside = [&](int x, int y) {
    return grid.contains(x, y) &&
           regions.of_cell[grid.index(x, y)] == static_cast<std::int32_t>(region);
  };
  const auto first =
      std::find(regions.of_cell.begin(), regions.of_cell.end(), static_cast<std::int32_t>(region));
  if (first == regions.of_cell.end()) return {};
  const auto seed = static_cast<std::size_t>(first - regions.of_cell.begin());
  const std::array<Eigen::Vector2i, 4> step{Eigen::Vector2i(1, 0), Eigen::Vector2i(0, 1),
                                            Eigen::Vector2i(-1, 0), Eigen::Vector2i(0, -1)};
  // Cells ahead of a corner, to the left and to the right of each direction.
  const std::array<Eigen::Vector2i, 4> left{Eigen::Vector2i(0, 0), Eigen::Vector2i(-1, 0),
                                            Eigen::Vector2i(-1, -1), Eigen::Vector2i(0, -1)};
  const std::array<Eigen::Vector2i, 4> right{Eigen::Vector2i(0, -1), Eigen::Vector2i(0, 0),
                                             Eigen::Vector2i(-1, 0), Eigen::Vector2i(-1, -1)};
  const Eigen::Vector2i start(grid.column(seed), grid.row(seed));
  std::vector<Eigen::Vector2i> corners;
  Eigen::Vector2i at = start;
  std::size_t direction = 0;  // below the first cell of the lowest row: the region is above
  do {
    corners.push_back(at);
    at += step[direction];
    const Eigen::Vector2i l = at + left[direction], r = at + right[direction];
    if (!inside(l.x(), l.y()))
      direction = (direction + 1) % 4;
    else if (inside(r.x(), r.y()))
      direction = (direction + 3) % 4;
  } while (at != start || direction != 0);
  return corners;
}

/// A stretch of the border that follows one face (or none: -1).
struct Run {
  int face = -1;
  std::size_t first = 0, last = 0;  ///< corners
  double length = 0;                ///< m
};

class OutlineBuilder {
 public:
  OutlineBuilder(const FloorGrid& grid, const std::vector<RegionFace>& own_faces,
                 const std::vector<WallFace>& faces, std::vector<Eigen::Vector2i> corners)
      : grid_(grid), own_faces_(own_faces), faces_(faces), corners_(std::move(corners)) {}

  std::vector<Eigen::Vector2d> run() {
    make_runs();
    merge_short_runs();
    std::vector<Eigen::Vector2d> ring;
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      const Run& run = runs_[k];
      const Run& next = runs_[(k + 1) % runs_.size()];
      if (run.face < 0) add_free_corners(run, ring);
      add_joint(run, next, ring);
    }
    return ring;
  }

 private:
  Eigen::Vector2d corner(std::size_t i) const {
    return corners_[i % corners_.size()].cast<double>() * grid_.cell;
  }

  const WallFace& face_of(const Run& run) const {
    return faces_[own_faces_[static_cast<std::size_t>(run.face)].face];
  }

  /// The own face that the border follows from corner i to the next, or -1.
  int face_of_edge(std::size_t i) const {
    const Eigen::Vector2d a = corner(i), b = corner(i + 1);
    const Eigen::Vector2d middle = 0.5 * (a + b);
    const Eigen::Vector2d outwards(b.y() - a.y(), a.x() - b.x());  // length: one cell
    int best = -1;
    double best_distance = snap_distance;
    for (std::size_t f = 0; f < own_faces_.size(); ++f) {
      const WallFace& face = faces_[own_faces_[f].face];
      const double along = face.tangent().dot(middle);
      const double distance = std::abs(face.signed_distance(middle));
      if (outwards.dot(face.normal) < -0.3 * grid_.cell && distance < best_distance &&
          along > own_faces_[f].begin - 0.15 && along < own_faces_[f].end + 0.15) {
        best = static_cast<int>(f);
        best_distance = distance;
      }
    }
    return best;
  }

  void make_runs() {
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const int face = face_of_edge(i);
      if (runs_.empty() || runs_.back().face != face) runs_.push_back({face, i, i + 1, 0});
      runs_.back().last = i + 1;
      runs_.back().length += grid_.cell;
    }
    join_ends();
  }

  /// The last run goes on in the first where both follow the same face.
  void join_ends() {
    if (runs_.size() < 2 || runs_.front().face != runs_.back().face) return;
    runs_.back().last = runs_.front().last + corners_.size();
    runs_.back().length += runs_.front().length;
    runs_.erase(runs_.begin());
  }

  /// Short runs without a face between two with one vanish; neighbours with the same face become
  /// one.
  void merge_short_runs() {
    for (std::size_t k = 0; k < runs_.size() && runs_.size() > 3;) {
      const std::size_t before = (k + runs_.size() - 1) % runs_.size();
      const std::size_t after = (k + 1) % runs_.size();
      const bool between_faces = runs_[before].face >= 0 && runs_[after].face >= 0;
      const double limit = runs_[k].face < 0 ? short_run : 1.5 * grid_.cell;
      if (between_faces && runs_[k].length <= limit) {
        runs_.erase(runs_.begin() + static_cast<std::ptrdiff_t>(k));
        k = k > 1 ? k - 2 : 0;
        merge_equal_neighbours();
      } else {
        ++k;
      }
    }
  }

  void merge_equal_neighbours() {
    for (std::size_t k = 0; k + 1 < runs_.size();) {
      if (runs_[k].face != runs_[k + 1].face) {
        ++k;
        continue;
      }
      runs_[k].last = runs_[k + 1].last;
      runs_[k].length += runs_[k + 1].length;
      runs_.erase(runs_.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    }
    join_ends();
  }

  Eigen::Vector2d projected(const Run& run, const Eigen::Vector2d& p) const {
    if (run.face < 0) return p;
    const WallFace& face = face_of(run);
    return p - face.signed_distance(p) * face.normal;
  }

  /// Where two runs meet: the corner of two faces, else a step from one to the other.
  void add_joint(const Run& run, const Run& next, std::vector<Eigen::Vector2d>& ring) const {
    const Eigen::Vector2d end = corner(run.last), begin = corner(next.first);
    if (run.face >= 0 && next.face >= 0) {
      const WallFace& a = face_of(run);
      const WallFace& b = face_of(next);
      Eigen::Matrix2d normals;
      normals << a.normal.transpose(), b.normal.transpose();
      if (std::abs(normals.determinant()) > 0.2) {
        const Eigen::Vector2d meeting = normals.inverse() * Eigen::Vector2d(a.offset, b.offset);
        if ((meeting - 0.5 * (begin + end)).norm() < 2 * snap_distance + short_run) {
          ring.push_back(meeting);
          return;
        }
      }
    }
    ring.push_back(projected(run, end));
    ring.push_back(projected(next, begin));
  }

  /// The border of cells between both ends of a run, simplified (Douglas & Peucker 1973).
  void add_free_corners(const Run& run, std::vector<Eigen::Vector2d>& ring) const {
    std::vector<Eigen::Vector2d> kept;
    simplify(run.first, run.last, kept);
    ring.insert(ring.end(), kept.begin(), kept.end());
  }

  void simplify(std::size_t first, std::size_t last, std::vector<Eigen::Vector2d>& kept) const {
    const Eigen::Vector2d a = corner(first), b = corner(last);
    const Eigen::Vector2d direction =
        (b - a).norm() > 1e-9 ? Eigen::Vector2d((b - a).normalized()) : Eigen::Vector2d::Zero();
    double farthest = 0;
    std::size_t at = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const Eigen::Vector2d d = corner(i) - a;
      const double distance = (d - direction.dot(d) * direction).norm();
      if (distance > farthest) {
        farthest = distance;
        at = i;
      }
    }
    if (farthest <= tolerance) return;
    simplify(first, at, kept);
    kept.push_back(corner(at));
    simplify(at, last, kept);
  }

  const FloorGrid& grid_;
  const std::vector<RegionFace>& own_faces_;
  const std::vector<WallFace>& faces_;
  std::vector<Eigen::Vector2i> corners_;
  std::vector<Run> runs_;
};

/// The region in front of a place on a face, or -1.
std::int32_t region_before(const FloorGrid& grid, const RoomRegions& regions, const WallFace& face,
                           double along) {
  for (const double distance : {0.08, 0.13, 0.18, 0.25}) {
    const std::ptrdiff_t cell = grid.find(face.at(along) + distance * face.normal);
    if (cell < 0) return -1;
    const std::int32_t region = regions.of_cell[static_cast<std::size_t>(cell)];
    if (region >= 0) return region;
  }
  return -1;
}

}  // namespace

std::vector<RegionFace> faces_of_regions(const FloorGrid& grid, const RoomRegions& regions,
                                         const std::vector<WallFace>& faces) {
  std::vector<RegionFace> result;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const double step = 0.5 * grid.cell;
    std::int32_t current = -1;
    for (double along = faces[f].begin; along <= faces[f].end; along += step) {
      const std::int32_t region = region_before(grid, regions, faces[f], along);
      if (region >= 0 && region == current) {
        result.back().end = along;
      } else if (region >= 0) {
        result.push_back({static_cast<std::size_t>(region), f, along, along});
        current = region;
      }
    }
  }
  std::erase_if(result, [](const RegionFace& f) { return f.length() < 0.1; });
  std::stable_sort(result.begin(), result.end(),
                   [](const RegionFace& a, const RegionFace& b) { return a.region < b.region; });
  return result;
}

std::vector<Eigen::Vector2d> region_outline(const FloorGrid& grid, const RoomRegions& regions,
                                            std::size_t region,
                                            const std::vector<RegionFace>& own_faces,
                                            const std::vector<WallFace>& faces) {
  std::vector<Eigen::Vector2i> corners = border_corners(grid, regions, region);
  if (corners.empty()) return {};
  return OutlineBuilder(grid, own_faces, faces, std::move(corners)).run();
}

double ring_area(const std::vector<Eigen::Vector2d>& ring) {
  double doubled = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& a = ring[i];
    const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
    doubled += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * doubled;
}

bool ring_contains(const std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& a = ring[i];
    const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y()))
      inside = !inside;
  }
  return inside;
}

}  // namespace planum
