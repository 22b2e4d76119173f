#include "labeling/plan/floor_grid.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <map>

namespace planum {
namespace {

constexpr std::size_t max_cells = std::size_t{1} << 26;

/// The angle in [0, 90) deg, in rad, that most wall normals have modulo a quarter turn.
double main_direction(const Cloud& cloud) {
  constexpr int bins = 90;
  std::array<double, bins> histogram{};
  const std::size_t step = 1 + cloud.normals.size() / 200000;
  const auto angle_of = [&](std::size_t i) {  // [0, 90) in degrees, or -1 where there is no wall
    const Eigen::Vector3f& n = cloud.normals[i];
    if (std::abs(n.z()) > 0.3f || n.head<2>().squaredNorm() < 0.5f) return -1.0;
    const double angle = degrees(std::atan2(double{n.y()}, double{n.x()}));
    return std::fmod(angle + 360.0, 90.0);
  };
  for (std::size_t i = 0; i < cloud.normals.size(); i += step)
    if (const double angle = angle_of(i); angle >= 0)
      histogram[static_cast<std::size_t>(angle) % bins] += 1;
  const auto around = [&](int bin) {
    double sum = 0;
    for (int k = -2; k <= 2; ++k)
      sum += histogram[static_cast<std::size_t>((bin + k + bins) % bins)];
    return sum;
  };
  int best = 0;
  for (int bin = 1; bin < bins; ++bin)
    if (around(bin) > around(best)) best = bin;
  // The mean over the peak, as a mean of unit vectors at four times the angle; the window follows
  // the mean, else it would be drawn to the middle of the bin.
  double mean = best + 0.5;
  for (int iteration = 0; iteration < 8; ++iteration) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < cloud.normals.size(); i += step) {
      const double angle = angle_of(i);
      if (angle >= 0 && std::abs(std::remainder(angle - mean, 90.0)) < 5)
        sum += std::polar(1.0, radians(4 * angle));
    }
    if (sum == 0.0) break;
    mean = degrees(std::arg(sum)) / 4;
  }
  return radians(mean);
}

/// Lower and upper corner of the 1 m tiles that hold more than stray points.
struct Box {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e30);
  Eigen::Vector2d high = Eigen::Vector2d::Constant(-1e30);
};

Box seen_area(const Cloud& cloud, double turn) {
  constexpr std::size_t min_points = 10;
  const double c = std::cos(turn), s = std::sin(turn);
  std::map<std::pair<int, int>, std::size_t> tiles;
  const std::size_t step = 1 + cloud.points.size() / 1000000;
  for (std::size_t i = 0; i < cloud.points.size(); i += step) {
    const Eigen::Vector3f& p = cloud.points[i];
    if (!p.allFinite()) continue;
    tiles[{static_cast<int>(std::floor(c * double{p.x()} - s * double{p.y()})),
           static_cast<int>(std::floor(s * double{p.x()} + c * double{p.y()}))}] += 1;
  }
  Box box;
  for (const auto& [tile, count] : tiles) {
    if (count < min_points) continue;
    const Eigen::Vector2d corner(tile.first, tile.second);
    box.low = box.low.cwiseMin(corner);
    box.high = box.high.cwiseMax(corner + Eigen::Vector2d::Ones());
  }
  return box;
}

}  // namespace

FloorGrid make_floor_grid(const Cloud& cloud, double cell) {
  FloorGrid grid;
  grid.cell = cell;
  const double turn = -main_direction(cloud);
  const Box box = seen_area(cloud, turn);
  if (box.low.x() > box.high.x()) return grid;
  const Eigen::Vector2d size = box.high - box.low;
  while (size.x() / grid.cell * size.y() / grid.cell > static_cast<double>(max_cells))
    grid.cell *= 1.25;
  grid.columns = static_cast<int>(std::ceil(size.x() / grid.cell)) + 1;
  grid.rows = static_cast<int>(std::ceil(size.y() / grid.cell)) + 1;
  grid.plan_from_world.linear() =
      Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  grid.plan_from_world.translation() = Eigen::Vector3d(-box.low.x(), -box.low.y(), 0);
  return grid;
}

}  // namespace planum
