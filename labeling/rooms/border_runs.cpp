#include "labeling/rooms/border_runs.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace planum {
namespace {

constexpr double snap_distance = 0.20;  // m between the border of the cells and a face
constexpr double snap_beyond = 0.15;    // m beyond the ends of a face
constexpr double tolerance = 0.08;      // m, of the border where no face was seen

}  // namespace

bool faces_meet(const WallFace& a, const WallFace& b, Eigen::Vector2d& meeting) {
  Eigen::Matrix2d normals;
  normals << a.normal.transpose(), b.normal.transpose();
  if (std::abs(normals.determinant()) < 0.2) return false;
  meeting = normals.inverse() * Eigen::Vector2d(a.offset, b.offset);
  return true;
}

BorderRuns::BorderRuns(const FloorGrid& grid, const std::vector<RegionFace>& own_faces,
                       const std::vector<WallFace>& faces, std::vector<Eigen::Vector2i> corners,
                       BorderSide side)
    : grid_(grid), corners_(std::move(corners)) {
  const double facing = side == BorderSide::around_room ? -1 : 1;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const WallFace* face = face_of_edge(i, own_faces, faces, facing);
    if (runs_.empty() || runs_.back().face != face) runs_.push_back({face, i, i + 1, 0});
    runs_.back().last = i + 1;
    runs_.back().length += grid_.cell;
  }
  join_ends();
}

const WallFace* BorderRuns::face_of_edge(std::size_t i, const std::vector<RegionFace>& own_faces,
                                         const std::vector<WallFace>& faces, double facing) const {
  const Eigen::Vector2d a = corner(i), b = corner(i + 1);
  const Eigen::Vector2d middle = 0.5 * (a + b);
  const Eigen::Vector2d outwards(b.y() - a.y(), a.x() - b.x());  // its length is one cell
  const WallFace* best = nullptr;
  double best_distance = snap_distance;
  for (const RegionFace& own : own_faces) {
    const WallFace& face = faces[own.face];
    const double along = face.tangent().dot(middle);
    const double distance = std::abs(face.signed_distance(middle));
    if (facing * outwards.dot(face.normal) > 0.3 * grid_.cell && distance < best_distance &&
        along > own.begin - snap_beyond && along < own.end + snap_beyond) {
      best = &face;
      best_distance = distance;
    }
  }
  return best;
}

/// The last run goes on in the first where both follow the same face.
void BorderRuns::join_ends() {
  if (runs_.size() < 2 || runs_.front().face != runs_.back().face) return;
  runs_.back().last = runs_.front().last + corners_.size();
  runs_.back().length += runs_.front().length;
  runs_.erase(runs_.begin());
}

void BorderRuns::join_equal_neighbours() {
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

void BorderRuns::drop(const MayGo& may_go) {
  for (std::size_t k = 0; k < runs_.size() && runs_.size() > 3;) {
    const BorderRun& before = runs_[(k + runs_.size() - 1) % runs_.size()];
    const BorderRun& after = runs_[(k + 1) % runs_.size()];
    if (before.face && after.face && may_go(before, runs_[k], after)) {
      runs_.erase(runs_.begin() + static_cast<std::ptrdiff_t>(k));
      join_equal_neighbours();
      k = 0;
    } else {
      ++k;
    }
  }
}

double BorderRuns::face_share() const {
  double with_face = 0, all = 0;
  for (const BorderRun& run : runs_) {
    all += run.length;
    if (run.face) with_face += run.length;
  }
  return all > 0 ? with_face / all : 0;
}

std::vector<Eigen::Vector2d> BorderRuns::ring() const {
  std::vector<Eigen::Vector2d> ring;
  for (std::size_t k = 0; k < runs_.size(); ++k) {
    if (!runs_[k].face) simplify(runs_[k].first, runs_[k].last, ring);
    add_joint(runs_[k], runs_[(k + 1) % runs_.size()], ring);
  }
  return ring;
}

/// Where two runs meet: the corner of two faces, else a step from one to the other.
void BorderRuns::add_joint(const BorderRun& run, const BorderRun& next,
                           std::vector<Eigen::Vector2d>& ring) const {
  const auto projected = [](const BorderRun& r, const Eigen::Vector2d& p) {
    return r.face ? Eigen::Vector2d(p - r.face->signed_distance(p) * r.face->normal) : p;
  };
  Eigen::Vector2d meeting;
  if (run.face && next.face && faces_meet(*run.face, *next.face, meeting)) {
    ring.push_back(meeting);
    return;
  }
  ring.push_back(projected(run, corner(run.last)));
  ring.push_back(projected(next, corner(next.first)));
}

/// Appends the corners between two that are far from the line between them (Douglas & Peucker
/// 1973).
void BorderRuns::simplify(std::size_t first, std::size_t last,
                          std::vector<Eigen::Vector2d>& kept) const {
  const Eigen::Vector2d a = corner(first), b = corner(last);
  const double length = (b - a).norm();
  const Eigen::Vector2d direction =
      length > 1e-9 ? Eigen::Vector2d((b - a) / length) : Eigen::Vector2d::Zero();
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

}  // namespace planum
