#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/cloud.hpp"
#include "slam/core/pose.hpp"

namespace planum {

/// When a ray counts as having ended before or behind a place.
struct SightParams {
  double margin = 0.1;             ///< m, by more than this,
  double margin_per_metre = 0.02;  ///< and by so much more for each metre: poses are a little off
  double max_tilt = radians(75);  ///< rad, rays that meet the surface flatter than this say nothing
};

/// What a scan says about a place.
enum class Sight {
  nothing,
  before,   ///< a ray ended before it
  at,       ///< a ray ended there
  through,  ///< a ray went through
  lost      ///< no ray came back, neither from there nor from a pixel beside
};

/// How far one scan sees in each direction: the nearest returns on the six faces of a cube around
/// the scanner. Pixels are about 0.7 degrees wide, or two or four times as wide where a scan has
/// fewer returns.
class RangeMap {
 public:
  RangeMap() = default;

  /// Of the points `own` (positions in `points`), all seen from `origin`.
  RangeMap(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> own,
           const Eigen::Vector3d& origin);

  /// Whether the rays about a place, within a pixel to all sides, all end behind it, and most have
  /// returns: so what is thin, or seen at a flat angle, is not taken for free. `normal` of the
  /// surface there may be zero.
  bool looks_through(const Eigen::Vector3f& place, const Eigen::Vector3f& normal,
                     const SightParams& params) const;

  /// Where the nearest ray in the pixel of a place on a surface ends: before it, at it, or behind
  /// it. Nothing is said of places farther than the farthest return.
  Sight sight(const Eigen::Vector3f& place, const Eigen::Vector3f& normal,
              const SightParams& params) const;

  const Eigen::Vector3f& origin() const { return origin_; }
  float farthest() const { return farthest_; }  ///< m, of all returns

 private:
  struct Pixel {
    int face, row, column;
  };
  static Pixel pixel_of(const Eigen::Vector3f& direction, int pixels);
  std::size_t at(const Pixel& p) const;
  void fill(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> own);
  double widen();
  bool is_empty_around(const Pixel& p) const;

  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  int pixels_ = 0;
  float farthest_ = 0;
  std::vector<float> nearest_;  ///< m, infinite where there is no return
  std::vector<float> widened_;  ///< m, the nearest of nine pixels; 0 where too few have returns
};

/// Calls visit with the range maps of all scans in their order, some dozens at a time, so that
/// memory does not grow with the scans. A cloud that does not say which scan a point is of is of
/// the first.
void visit_range_maps(const Cloud& cloud, std::span<const Eigen::Vector3d> scan_origins,
                      const std::function<void(std::span<const RangeMap>)>& visit);

}  // namespace planum
