#include "meshing/regions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "meshing/curvature.hpp"
#include "meshing/face_geometry.hpp"
#include "meshing/half_edge.hpp"
#include "meshing/plane_refit.hpp"
#include "meshing/point_regions.hpp"
#include "meshing/region_merging.hpp"
#include "meshing/region_seeds.hpp"
#include "meshing/small_planes.hpp"
#include "slam/core/error.hpp"

namespace planum {
namespace {

void check(const RegionParams& params) {
  const auto at_least = [](const char* name, double value, double limit, bool allow_equal) {
    if (value > limit || (allow_equal && value == limit)) return;
    throw Error("regions: " + std::string(name) + " is " + std::to_string(value) + ", must be " +
                (allow_equal ? "at least " : "above ") + std::to_string(limit));
  };
  at_least("max_angle", params.max_angle, 0, false);
  at_least("max_distance", params.max_distance, 0, false);
  at_least("max_seed_spread", params.max_seed_spread, 0, false);
  at_least("min_area", params.min_area, 0, true);
  at_least("min_radius", params.min_radius, 0, true);
  at_least("merge_angle", params.merge_angle, 0, true);
  at_least("merge_distance", params.merge_distance, 0, true);
}

/// Grows one region after the other over a mesh.
class Grower {
 public:
  Grower(const TriangleMesh& mesh, const HalfEdges& edges, const RegionParams& params)
      : mesh_(mesh),
        edges_(edges),
        params_(params),
        faces_(face_geometry(mesh)),
        smooth_(smoothed_faces(edges, faces_, exact_area(params))),
        owner_(mesh.triangles.size(), Regions::rest),
        tried_(mesh.triangles.size(), false),
        asked_(mesh.triangles.size(), Regions::rest) {}

  Regions grown() {
    Regions regions;
    for (const std::uint32_t seed : seeds(smooth_, params_.max_seed_spread)) {
      if (owner_[seed] != Regions::rest || tried_[seed]) continue;
      const auto id = static_cast<std::uint32_t>(regions.regions.size());
      if (const auto region = grown_from(seed, id)) regions.regions.push_back(*region);
    }
    regions.of_triangle = owner_;
    return regions;
  }

 private:
  /// m^2; noise of max_distance does not turn a triangle of this size by much.
  static double exact_area(const RegionParams& params) {
    return 8 * params.max_distance * params.max_distance;
  }

  std::optional<Region> grown_from(std::uint32_t seed, std::uint32_t id) {
    start(seed, id);
    for (int round = 0; round < max_rounds && spread_from_front(); ++round) {
    }
    drop_misfits();
    Region region{plane_, 0};
    for (const std::uint32_t f : members_) region.area += faces_.area[f];
    const bool enough = members_.size() >= min_members || region.area >= exact_area(params_);
    if (enough && !is_bent()) return region;
    for (const std::uint32_t f : members_) owner_[f] = Regions::rest;
    return std::nullopt;
  }

  void start(std::uint32_t seed, std::uint32_t id) {
    id_ = id;
    ++growth_;
    origin_ = smooth_.broad_centre[seed];
    plane_ = {smooth_.broad_normal[seed], smooth_.broad_normal[seed].dot(origin_)};
    moments_ = {};
    members_.clear();
    front_.assign(1, seed);
    refit_at_ = first_refit;
  }

  bool fits(std::uint32_t f) const {
    return std::abs(plane_.signed_distance(faces_.centroid[f])) <= params_.max_distance &&
           (smooth_.normal[f].dot(plane_.normal) >= min_cosine_ || faces_.area[f] == 0);
  }

  /// Takes what fits of the front and goes on from there; what does not fit is the new front. Says
  /// whether another round makes sense.
  bool spread_from_front() {
    const std::size_t before = members_.size();
    std::vector<std::uint32_t> queue;
    queue.swap(front_);
    for (std::size_t at = 0; at < queue.size(); ++at) {
      const std::uint32_t f = queue[at];
      if (owner_[f] != Regions::rest) continue;
      if (!fits(f)) {
        front_.push_back(f);
        continue;
      }
      take(f);
      for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        const std::uint32_t back = edges_.opposite[h];
        if (back == HalfEdges::none || owner_[back / 3] != Regions::rest) continue;
        if (asked_[back / 3] == growth_) continue;
        asked_[back / 3] = growth_;
        queue.push_back(back / 3);
      }
    }
    refit();
    return members_.size() > before && !front_.empty();
  }

  void take(std::uint32_t f) {
    owner_[f] = id_;
    tried_[f] = true;
    members_.push_back(f);
    // Weights in mm^2: fit_plane() counts points and wants three.
    add_triangle(moments_, mesh_, f, faces_.area[f] * 1e6, origin_);
    if (members_.size() < refit_at_) return;
    refit();
    refit_at_ = members_.size() * 3 / 2;
  }

  void refit() {
    if (const std::optional<PlaneFit> fit = fit_plane(moments_))
      plane_ = relative_to(facing(fit->plane, plane_.normal), -origin_);
  }

  /// What was taken by an earlier, poorer plane.
  void drop_misfits() {
    const auto misfit = [&](std::uint32_t f) {
      if (fits(f)) return false;
      owner_[f] = Regions::rest;
      return true;
    };
    const auto end = std::remove_if(members_.begin(), members_.end(), misfit);
    if (end == members_.end()) return;
    members_.erase(end, members_.end());
    moments_ = {};
    for (const std::uint32_t f : members_)
      add_triangle(moments_, mesh_, f, faces_.area[f] * 1e6, origin_);
    refit();
  }

  /// Triangles that lean away are left out: the rounded rim of a narrow plane would make it look
  /// bent.
  bool is_bent() const {
    if (params_.min_radius <= 0) return false;
    CurvatureFit fit(plane_, origin_);
    const double min_cosine = std::cos(params_.max_angle / 2);
    for (const std::uint32_t f : members_)
      if (smooth_.normal[f].dot(plane_.normal) >= min_cosine)
        fit.add(faces_.centroid[f], faces_.area[f]);
    return fit.curvature() * params_.min_radius > 1;
  }

  static constexpr int max_rounds = 10;
  static constexpr std::size_t first_refit = 24, min_members = 4;

  const TriangleMesh& mesh_;
  const HalfEdges& edges_;
  const RegionParams& params_;
  const FaceGeometry faces_;
  const SmoothedFaces smooth_;
  const double min_cosine_ = std::cos(params_.max_angle);
  std::vector<std::uint32_t> owner_;
  std::vector<bool> tried_;           ///< was once in a region: no seed again
  std::vector<std::uint32_t> asked_;  ///< the last growth that looked at this triangle

  std::uint32_t id_ = 0, growth_ = 0;
  Plane plane_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  PointMoments moments_;
  std::vector<std::uint32_t> members_, front_;
  std::size_t refit_at_ = 0;
};

}  // namespace

RegionParams region_params(double cell) {
  RegionParams params;
  const double scale = cell / 0.05;
  params.max_distance *= scale;
  params.min_area *= scale * scale;
  params.min_radius *= scale;
  params.merge_distance *= scale;
  return params;
}

Regions grow_planes(const TriangleMesh& mesh, const RegionParams& params) {
  check(params);
  const HalfEdges edges = half_edges(mesh);
  Regions regions = Grower(mesh, edges, params).grown();
  return merged(regions, mesh, edges, params);
}

Regions grow_planes(const TriangleMesh& mesh, const Cloud& cloud, const RegionParams& params) {
  const Regions of_mesh = grow_planes(mesh, params);
  const RefitParams refit{.max_distance = params.max_distance * 4 / 3};
  const PointRegions points =
      point_regions(of_mesh, mesh, cloud, refit.max_distance, refit.max_angle);
  return with_small_planes(refit_planes(of_mesh, mesh, cloud, points, refit), mesh, cloud, points,
                           params);
}

}  // namespace planum
