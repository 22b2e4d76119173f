#include "labeling/rooms/wall_faces.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "slam/core/pose.hpp"

namespace planum {
namespace {

constexpr int direction_bins = 180;  // 2 deg each
constexpr int points_per_cell = 8;   // kept for the search; all are used for the final fit

/// At most about points_per_cell points of each cell, spread over them.
std::vector<WallPoint> thinned(const std::vector<WallPoint>& points, const FloorGrid& grid) {
  std::vector<std::uint32_t> count(grid.size(), 0), seen(grid.size(), 0);
  std::vector<WallPoint> result;
  for (const WallPoint& p : points)
    if (const std::ptrdiff_t c = grid.find(p.position); c >= 0)
      ++count[static_cast<std::size_t>(c)];
  for (const WallPoint& p : points) {
    const std::ptrdiff_t c = grid.find(p.position);
    if (c < 0) continue;
    const auto cell = static_cast<std::size_t>(c);
    const std::uint32_t step = (count[cell] + points_per_cell - 1) / points_per_cell;
    if (seen[cell]++ % step == 0) result.push_back(p);
  }
  return result;
}

/// Index of the largest sum of `2 reach + 1` neighbouring bins; bins wrap around if `cyclic`.
int fullest(const std::vector<double>& histogram, int reach, bool cyclic) {
  const int n = static_cast<int>(histogram.size());
  int best = 0;
  double best_sum = -1;
  for (int bin = 0; bin < n; ++bin) {
    double sum = 0;
    for (int k = bin - reach; k <= bin + reach; ++k) {
      if (!cyclic && (k < 0 || k >= n)) continue;
      sum += histogram[static_cast<std::size_t>((k + n) % n)];
    }
    if (sum > best_sum) {
      best_sum = sum;
      best = bin;
    }
  }
  return best;
}

Eigen::Vector2d fullest_direction(const std::vector<WallPoint>& points) {
  std::vector<double> histogram(direction_bins, 0);
  for (const WallPoint& p : points) {
    const double turn = std::atan2(p.normal.y(), p.normal.x()) / (2 * pi) + 1;
    histogram[static_cast<std::size_t>(turn * direction_bins) % direction_bins] += 1;
  }
  const double angle = 2 * pi * (fullest(histogram, 2, true) + 0.5) / direction_bins;
  return {std::cos(angle), std::sin(angle)};
}

/// The offset where most points with about this normal lie.
std::optional<double> fullest_offset(const std::vector<WallPoint>& points,
                                     const Eigen::Vector2d& normal, double cos_turn) {
  constexpr double bin_width = 0.02;
  double low = 1e30, high = -1e30;
  for (const WallPoint& p : points) {
    if (p.normal.dot(normal) < cos_turn) continue;
    low = std::min(low, normal.dot(p.position));
    high = std::max(high, normal.dot(p.position));
  }
  if (low > high) return std::nullopt;
  std::vector<double> histogram(static_cast<std::size_t>((high - low) / bin_width) + 1, 0);
  for (const WallPoint& p : points)
    if (p.normal.dot(normal) >= cos_turn)
      histogram[static_cast<std::size_t>((normal.dot(p.position) - low) / bin_width)] += 1;
  return low + bin_width * (fullest(histogram, 2, false) + 0.5);
}

struct Line {
  Eigen::Vector2d normal;
  double offset;
};

/// Total least squares over the points near the line, with the normal kept on its side.
Line refitted(const Line& line, const std::vector<WallPoint>& points, double thickness,
              double cos_turn) {
  double count = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const WallPoint& p : points)
    if (std::abs(line.normal.dot(p.position) - line.offset) < thickness &&
        p.normal.dot(line.normal) >= cos_turn) {
      count += 1;
      sum += p.position;
    }
  if (count < 3) return line;
  const Eigen::Vector2d mean = sum / count;
  double xx = 0, xy = 0, yy = 0;
  for (const WallPoint& p : points)
    if (std::abs(line.normal.dot(p.position) - line.offset) < thickness &&
        p.normal.dot(line.normal) >= cos_turn) {
      const Eigen::Vector2d d = p.position - mean;
      xx += d.x() * d.x();
      xy += d.x() * d.y();
      yy += d.y() * d.y();
    }
  const double along = 0.5 * std::atan2(2 * xy, xx - yy);
  Eigen::Vector2d normal(-std::sin(along), std::cos(along));
  if (normal.dot(line.normal) < 0) normal = -normal;
  // Short faces (pillars) have no direction of their own.
  if (normal.dot(line.normal) < cos_turn) normal = line.normal;
  return {normal, normal.dot(mean)};
}

/// The pieces of a line that points cover, gaps up to bridged_gap closed.
std::vector<WallFace> covered_pieces(const Line& line, std::vector<double>& along,
                                     const WallFaceParams& params) {
  std::vector<WallFace> faces;
  std::sort(along.begin(), along.end());
  for (std::size_t i = 0; i < along.size();) {
    std::size_t end = i + 1;
    while (end < along.size() && along[end] - along[end - 1] < params.bridged_gap) ++end;
    const double length = along[end - 1] - along[i];
    if (length >= params.min_length && end - i >= static_cast<std::size_t>(params.min_points))
      faces.push_back({line.normal, line.offset, along[i], along[end - 1]});
    i = end;
  }
  return faces;
}

/// A face fitted to all its points, not to the thinned ones only.
void refit(WallFace& face, const std::vector<WallPoint>& all, const WallFaceParams& params) {
  const Eigen::Vector2d tangent = face.tangent();
  std::vector<WallPoint> own;
  for (const WallPoint& p : all) {
    const double along = tangent.dot(p.position);
    if (along >= face.begin && along <= face.end &&
        std::abs(face.signed_distance(p.position)) < params.thickness)
      own.push_back(p);
  }
  const Line line =
      refitted({face.normal, face.offset}, own, 0.6 * params.thickness, std::cos(params.max_turn));
  const Eigen::Vector2d from = face.at(face.begin), to = face.at(face.end);
  face.normal = line.normal;
  face.offset = line.offset;
  face.begin = face.tangent().dot(from);
  face.end = face.tangent().dot(to);
}

}  // namespace

std::vector<WallFace> find_wall_faces(const std::vector<WallPoint>& all, const FloorGrid& grid,
                                      const WallFaceParams& params) {
  std::vector<WallPoint> left = thinned(all, grid);
  const double cos_turn = std::cos(params.max_turn);
  std::vector<WallFace> faces;
  int poor_lines = 0;
  while (left.size() >= static_cast<std::size_t>(params.min_points) && poor_lines < 30) {
    Line line{fullest_direction(left), 0};
    const std::optional<double> offset = fullest_offset(left, line.normal, cos_turn);
    if (!offset) break;
    line.offset = *offset;
    for (const double factor : {1.5, 1.0, 0.8})
      line = refitted(line, left, factor * params.thickness, cos_turn);
    std::vector<double> along;
    std::vector<WallPoint> rest;
    const Eigen::Vector2d tangent(-line.normal.y(), line.normal.x());
    for (const WallPoint& p : left) {
      const bool near = std::abs(line.normal.dot(p.position) - line.offset) < params.thickness &&
                        p.normal.dot(line.normal) >= cos_turn;
      if (near)
        along.push_back(tangent.dot(p.position));
      else
        rest.push_back(p);
    }
    if (along.empty()) break;
    const std::vector<WallFace> pieces = covered_pieces(line, along, params);
    faces.insert(faces.end(), pieces.begin(), pieces.end());
    poor_lines += pieces.empty();
    left.swap(rest);
  }
  for (WallFace& face : faces) refit(face, all, params);
  return faces;
}

}  // namespace planum
