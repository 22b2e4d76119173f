#include "slam/registration/see_through.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/registration/icp.hpp"

namespace planum {
namespace {

/// How far a right pose may be off, and what the noise of a sample and of a return may make.
constexpr double pose_turn = radians(0.5);
constexpr double margin_per_noise = 3;

void check(const RangeViewParams& params) {
  const auto require = [](bool good, const char* option, double value, const char* limit) {
    if (!good) throw Error(fmt::format("range view: {} must be {}, got {}", option, limit, value));
  };
  require(params.bin >= radians(0.1) && params.bin <= radians(30), "bin", degrees(params.bin),
          "between 0.1 and 30 deg");
  require(params.cone >= 0 && params.cone <= radians(30), "cone", degrees(params.cone),
          "between 0 and 30 deg");
  require(params.spread >= 0 && std::isfinite(params.spread), "spread", params.spread, ">= 0 m");
  require(params.margin > 0 && std::isfinite(params.margin), "margin", params.margin, "> 0 m");
  require(params.max_tilt > 0 && params.max_tilt <= radians(90), "max_tilt",
          degrees(params.max_tilt), "between 0 and 90 deg");
}

/// Where a direction lies among the bins, as real numbers from 0.
struct Place {
  double row, column, elevation;
};

Place place_of(const Eigen::Vector3f& p, float range, std::size_t columns) {
  const double bins = static_cast<double>(columns) / (2 * pi);
  const double elevation = std::asin(std::clamp(p.z() / range, -1.0f, 1.0f));
  return {(elevation + pi / 2) * bins, (std::atan2(p.y(), p.x()) + pi) * bins, elevation};
}

std::size_t rows_of(std::size_t columns) { return (columns + 1) / 2; }

/// Calls body(bin) for all bins within `angle` of a place.
template <typename Body>
void for_each_bin(const Place& place, double angle, std::size_t columns, const Body& body) {
  const auto rows = static_cast<std::ptrdiff_t>(rows_of(columns));
  const auto turn = static_cast<std::ptrdiff_t>(columns);
  const double bins = static_cast<double>(columns) / (2 * pi), high = angle * bins;
  // Meridians meet at the poles; beyond a pole a disc of directions covers all of them.
  const double furthest = std::abs(place.elevation) + angle;
  const bool at_pole = furthest >= pi / 2 - 1e-6;
  const double wide = at_pole ? static_cast<double>(turn)
                              : std::asin(std::sin(angle) / std::cos(place.elevation)) * bins;
  const auto low_row = static_cast<std::ptrdiff_t>(std::floor(place.row - high));
  const auto high_row = static_cast<std::ptrdiff_t>(std::floor(place.row + high));
  const auto low_column = static_cast<std::ptrdiff_t>(std::floor(place.column - wide));
  const auto high_column =
      std::min(static_cast<std::ptrdiff_t>(std::floor(place.column + wide)), low_column + turn - 1);
  const auto first_row = std::clamp<std::ptrdiff_t>(low_row, 0, rows - 1);
  const auto last_row = std::clamp<std::ptrdiff_t>(high_row, 0, rows - 1);
  for (auto row = first_row; row <= last_row; ++row)
    for (auto column = low_column; column <= high_column; ++column)
      body(static_cast<std::size_t>(row * turn + (column % turn + turn) % turn));
}

std::size_t bin_at(const Place& place, std::size_t columns) {
  const auto row =
      std::min(static_cast<std::size_t>(std::max(place.row, 0.0)), rows_of(columns) - 1);
  return row * columns + static_cast<std::size_t>(std::max(place.column, 0.0)) % columns;
}

/// Spreads what each bin has to all bins that its returns count for.
void spread_returns(RangeView& view) {
  const std::vector<float> nearest = view.nearest, farthest = view.farthest;
  const double bins = static_cast<double>(view.columns) / (2 * pi);
  for (std::size_t from = 0; from < nearest.size(); ++from) {
    if (nearest[from] == 0) continue;
    const Place middle{
        .row = static_cast<double>(from / view.columns) + 0.5,
        .column = static_cast<double>(from % view.columns) + 0.5,
        .elevation = (static_cast<double>(from / view.columns) + 0.5) / bins - pi / 2};
    const double angle = std::min(
        view.params.cone + std::atan2(view.params.spread, static_cast<double>(nearest[from])),
        radians(45));
    for_each_bin(middle, angle, view.columns, [&](std::size_t to) {
      if (view.nearest[to] == 0 || nearest[from] < view.nearest[to])
        view.nearest[to] = nearest[from];
      view.farthest[to] = std::max(view.farthest[to], farthest[from]);
    });
  }
}

}  // namespace

double Visibility::contradicted() const {
  const std::size_t seen = contradictions + agreements;
  return seen == 0 ? 0 : static_cast<double>(contradictions) / static_cast<double>(seen);
}

double FreeSpaceCheck::contradicted(std::size_t least_seen) const {
  double worst = 0;
  for (const Visibility& way : {source_from_target, target_from_source})
    if (way.contradictions + way.agreements >= least_seen)
      worst = std::max(worst, way.contradicted());
  return worst;
}

RangeView range_view(const MatchingScan& scan, const RangeViewParams& params) {
  check(params);
  RangeView view;
  view.params = params;
  view.noise = std::max(scan.noise, least_noise);
  view.columns = static_cast<std::size_t>(std::ceil(2 * pi / params.bin));
  view.nearest.assign(rows_of(view.columns) * view.columns, 0);
  view.farthest.assign(view.nearest.size(), 0);
  for (const Eigen::Vector3f& point : scan.points) {
    const float range = point.norm();
    if (range == 0) continue;
    const std::size_t bin = bin_at(place_of(point, range, view.columns), view.columns);
    if (view.nearest[bin] == 0 || range < view.nearest[bin]) view.nearest[bin] = range;
    view.farthest[bin] = std::max(view.farthest[bin], range);
  }
  spread_returns(view);
  for (const std::uint32_t i : scan.selection(params.samples))
    if (scan.planes[i].known()) view.samples.push_back({scan.smoothed(i), scan.planes[i].normal});
  return view;
}

std::vector<RangeView> range_views(std::span<const MatchingScan> scans) {
  std::vector<RangeView> views(scans.size());
  parallel_for(scans.size(), 1,
               [&](std::size_t i, std::size_t) { views[i] = range_view(scans[i]); });
  return views;
}

Visibility visibility(const RangeView& source, const RangeView& target,
                      const Pose& target_from_source) {
  const Eigen::Isometry3f pose = target_from_source.cast<float>();
  const double noise = std::hypot(source.noise, target.noise);
  const double margin = target.params.margin + margin_per_noise * noise;
  const double least_cosine = std::cos(target.params.max_tilt);
  Visibility result;
  for (const RangeView::Sample& sample : source.samples) {
    const Eigen::Vector3f point = pose * sample.point;
    const float range = point.norm();
    if (range == 0) continue;
    const std::size_t bin = bin_at(place_of(point, range, target.columns), target.columns);
    const double nearest = target.nearest[bin], farthest = target.farthest[bin];
    const double cosine = std::abs((pose.linear() * sample.normal).dot(point)) / range;
    if (nearest == 0 || cosine < least_cosine) {
      ++result.unseen;
      continue;
    }
    // Across the surface, so that a ray along a wall needs to end farther behind than one onto it.
    const double touching = (margin + pose_turn * range) / cosine;
    if (nearest > range + touching)
      ++result.contradictions;
    else if (farthest < range - touching)
      ++result.occluded;
    else
      ++result.agreements;
  }
  return result;
}

FreeSpaceCheck check_free_space(const RangeView& source, const RangeView& target,
                                const Pose& target_from_source) {
  return {visibility(source, target, target_from_source),
          visibility(target, source, target_from_source.inverse())};
}

}  // namespace planum
