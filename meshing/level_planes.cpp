#include "meshing/level_planes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "slam/core/error.hpp"
#include "slam/core/plane.hpp"
#include "slam/core/robust.hpp"

namespace planum {
namespace {

constexpr int rounds = 6;
constexpr std::size_t most_levels = 16, min_points = 100;
/// Neighbouring points of a scan share their errors: so many of them say as much as one.
constexpr double redundancy = 25;

/// A point on something level, and the side it was seen from.
struct LevelPoint {
  Eigen::Vector3d place;
  bool faces_up;
};

std::vector<LevelPoint> level_points(const Cloud& cloud, const Eigen::Vector3d& up,
                                     const Eigen::Vector3d& origin, double max_tilt) {
  const double least = std::cos(max_tilt);
  std::vector<LevelPoint> result;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const double cosine = cloud.normals[i].cast<double>().dot(up);
    if (std::abs(cosine) >= least)
      result.push_back({cloud.points[i].cast<double>() - origin, cosine > 0});
  }
  return result;
}

/// The points of one floor or ceiling.
using Level = std::vector<Eigen::Vector3d>;

/// Floors (or ceilings) by their heights: again and again the band with most of the points that are
/// left.
void find_levels(const std::vector<LevelPoint>& points, bool facing_up, const Eigen::Vector3d& up,
                 const LevelParams& params, std::vector<Level>& levels) {
  const double bin = params.band / 2;
  std::map<long, std::vector<std::size_t>> bins;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].faces_up == facing_up)
      bins[std::lround(points[i].place.dot(up) / bin)].push_back(i);
  for (std::size_t level = 0; level < most_levels; ++level) {
    const auto around = [&](long height, const auto& visit) {
      for (auto at = bins.lower_bound(height - 2); at != bins.end() && at->first <= height + 2;
           ++at)
        visit(at->second);
    };
    std::size_t most = 0;
    long best = 0;
    for (const auto& [height, members] : bins) {
      std::size_t count = 0;
      around(height, [&](const auto& near) { count += near.size(); });
      if (count > most) most = count, best = height;
    }
    if (most < min_points) return;
    Level found;
    around(best, [&](auto& near) {
      for (const std::size_t i : near) found.push_back(points[i].place);
      near.clear();
    });
    levels.push_back(std::move(found));
  }
}

/// What a level says about the tilt of up towards u and v: normal equations, per variance.
struct TiltEquations {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
};

/// Heights h of the points over the plane through u and v satisfy h = c - a u - b v if up leans by
/// (a, b); weights fall off smoothly from the median height (Tukey).
void add_level(const Level& level, const Eigen::Matrix3d& axes, double band, TiltEquations& sum) {
  std::vector<double> heights;
  for (const Eigen::Vector3d& p : level) heights.push_back(p.dot(axes.col(2)));
  std::vector<double> some = heights;
  const double middle = upper_median(some);
  for (double& h : some) h = std::abs(h - middle);
  const double limit = std::clamp(biweight_limit(some), 1e-4, 2 * band);
  PointMoments moments;  // of (u, v, h - middle)
  for (std::size_t i = 0; i < level.size(); ++i) {
    const double weight = biweight(heights[i] - middle, limit);
    if (weight == 0) continue;
    moments.add({level[i].dot(axes.col(0)), level[i].dot(axes.col(1)), heights[i] - middle},
                weight);
  }
  if (moments.count < 3) return;
  const Eigen::Matrix3d covariance = moments.covariance();
  const double variance = std::max(covariance(2, 2), 1e-8);
  const double per_variance = moments.count / (redundancy * variance);
  sum.information += per_variance * covariance.topLeftCorner<2, 2>();
  sum.gradient += per_variance * covariance.topRightCorner<2, 1>();
}

/// Two directions across `up`, and up.
Eigen::Matrix3d axes_about(const Eigen::Vector3d& up) {
  Eigen::Matrix3d axes;
  axes.col(0) = up.unitOrthogonal();
  axes.col(1) = up.cross(axes.col(0));
  axes.col(2) = up;
  return axes;
}

}  // namespace

Eigen::Vector3d up_of_planes(const Cloud& cloud, const Eigen::Vector3d& up,
                             const LevelParams& params) {
  if (cloud.normals.size() != cloud.points.size())
    throw Error("levelling: the cloud has " + std::to_string(cloud.points.size()) + " points and " +
                std::to_string(cloud.normals.size()) + " normals");
  if (!(up.norm() > 0)) throw Error("levelling: up has no direction");
  const Eigen::Vector3d prior = up.normalized();
  if (cloud.points.empty()) return prior;
  const Eigen::Vector3d origin = cloud.points.front().cast<double>();
  const std::vector<LevelPoint> points = level_points(cloud, prior, origin, params.max_tilt);
  Eigen::Vector3d result = prior;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Level> levels;
    for (const bool facing_up : {true, false})
      find_levels(points, facing_up, result, params, levels);
    std::size_t largest = 0;
    for (const Level& level : levels) largest = std::max(largest, level.size());
    std::erase_if(levels, [&](const Level& level) {
      return static_cast<double>(level.size()) < params.min_share * static_cast<double>(largest);
    });
    const Eigen::Matrix3d axes = axes_about(result);
    TiltEquations sum;
    for (const Level& level : levels) add_level(level, axes, params.band, sum);
    const double prior_information = 1 / (params.prior_error * params.prior_error);
    const Eigen::Vector2d back = (axes.transpose() * prior).head<2>();
    sum.information += prior_information * Eigen::Matrix2d::Identity();
    sum.gradient -= prior_information * back;
    const Eigen::Vector2d lean = -sum.information.ldlt().solve(sum.gradient);
    if (!lean.allFinite() || lean.norm() > params.max_tilt) return result;
    result = (axes * Eigen::Vector3d(lean.x(), lean.y(), 1)).normalized();
    if (lean.norm() < 1e-7) break;
  }
  return result;
}

}  // namespace planum
