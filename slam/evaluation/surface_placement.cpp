#include "slam/evaluation/surface_placement.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/robust.hpp"
#include "slam/evaluation/error_statistics.hpp"
#include "slam/evaluation/mesh_corners.hpp"
#include "slam/evaluation/sampling.hpp"

namespace planum {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Where walls are: the sum of their normals with angles times four, so that those at right angles
/// count as one.
class WallDirection {
 public:
  void add(const Eigen::Vector3d& normal, double weight) {
    if (std::abs(normal.z()) > 0.2) return;
    sum_ += weight * std::polar(1.0, 4 * std::atan2(normal.y(), normal.x()));
  }
  double angle() const { return std::arg(sum_) / 4; }

 private:
  std::complex<double> sum_ = 0;
};

double wall_angle(const Cloud& cloud) {
  WallDirection walls;
  for (const Eigen::Vector3f& normal : cloud.normals)
    if (!normal.isZero()) walls.add(normal.cast<double>(), 1);
  return walls.angle();
}

double wall_angle(const TriangleMesh& mesh) {
  WallDirection walls;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners c = corners_of(mesh, t);
    const Eigen::Vector3d n = (c[1] - c[0]).cross(c[2] - c[0]);
    if (n.norm() > 0) walls.add(n.normalized(), n.norm());
  }
  return walls.angle();
}

Points some_points(const Cloud& cloud, std::size_t wanted) {
  Points points;
  for (const std::size_t i : evenly_chosen(cloud.points.size(), wanted))
    points.push_back(cloud.points[i].cast<double>());
  return points;
}

/// The box of most points: those that glass or the open air misled are left out.
Eigen::AlignedBox3d usual_box(const Points& points) {
  Eigen::Vector3d low, high;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : points) values.push_back(p[axis]);
    std::sort(values.begin(), values.end());
    low[axis] = quantile(values, 0.01);
    high[axis] = quantile(values, 0.99);
  }
  return {low, high};
}

/// From which to which shift a range lies within another, give or take the margin.
std::vector<double> shifts(double low, double high, double model_low, double model_high,
                           const SurfacePlacementParams& params) {
  const double first = std::min(model_low - low, model_high - high);
  const double last = std::max(model_low - low, model_high - high);
  std::vector<double> result;
  for (double shift = first - params.margin; shift <= last + params.margin; shift += params.step)
    result.push_back(shift);
  return result;
}

std::vector<Pose> places(const Cloud& cloud, const TriangleMesh& mesh, const Points& points,
                         const SurfacePlacementParams& params) {
  Eigen::AlignedBox3d model;
  for (const Eigen::Vector3f& vertex : mesh.vertices) model.extend(vertex.cast<double>());
  const double turn = wall_angle(mesh) - wall_angle(cloud);
  std::vector<Pose> result;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Pose turned = pose_from_xyz_ypr(Eigen::Vector3d::Zero(), turn + quarter * pi / 2, 0, 0);
    Points there = points;
    for (Eigen::Vector3d& p : there) p = turned * p;
    const Eigen::AlignedBox3d box = usual_box(there);
    const double up = model.min().z() - box.min().z();
    for (const double x :
         shifts(box.min().x(), box.max().x(), model.min().x(), model.max().x(), params))
      for (const double y :
           shifts(box.min().y(), box.max().y(), model.min().y(), model.max().y(), params))
        result.push_back(Eigen::Translation3d(x, y, up) * turned);
  }
  return result;
}

/// How many points lie on the surface, those at half the limit counting about half.
double suitability(const Points& points, const SurfaceTree& surface, const Pose& pose,
                   double limit) {
  double sum = 0;
  for (const Eigen::Vector3d& p : points)
    if (const auto nearest = surface.nearest(pose * p, limit))
      sum += biweight(nearest->distance, limit);
  return sum;
}

std::vector<Pose> best_places(std::vector<Pose> all, const Points& points,
                              const SurfaceTree& surface, const SurfacePlacementParams& params) {
  std::vector<std::pair<double, std::size_t>> order(all.size());
  parallel_for(all.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      order[k] = {-suitability(points, surface, all[k], params.step), k};
  });
  std::sort(order.begin(), order.end());
  std::vector<Pose> best;
  for (std::size_t k = 0; k < std::min(params.refined, order.size()); ++k)
    best.push_back(all[order[k].second]);
  return best;
}

}  // namespace

SurfaceFit place_on_surface(const Cloud& cloud, const TriangleMesh& mesh,
                            const SurfaceTree& surface, const SurfacePlacementParams& params) {
  if (cloud.normals.size() != cloud.points.size() || cloud.points.empty())
    throw Error(fmt::format("evaluation: {} points have {} normals", cloud.points.size(),
                            cloud.normals.size()));
  if (!(params.step > 0))
    throw Error(fmt::format("evaluation: step must be > 0 m, got {}", params.step));
  const Points few = some_points(cloud, params.points),
               many = some_points(cloud, 5 * params.points);
  std::optional<Pose> best;
  double most = 0;
  for (const Pose& place : best_places(places(cloud, mesh, few, params), few, surface, params)) {
    SurfaceFit fit;
    try {
      fit = fit_to_surface(many, surface, place, {.first_gate = 2 * params.step});
    } catch (const Error&) {
      continue;  // nothing there
    }
    const double suits = suitability(many, surface, fit.surface_from_points, params.step / 5);
    if (best && suits <= most) continue;
    best = fit.surface_from_points;
    most = suits;
  }
  return fit_to_surface(some_points(cloud, params.fit_points), surface,
                        best.value_or(Pose::Identity()));
}

}  // namespace planum
