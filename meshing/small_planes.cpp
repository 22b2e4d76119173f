#include "meshing/small_planes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "meshing/curvature.hpp"
#include "meshing/face_geometry.hpp"
#include "meshing/plane_refit.hpp"
#include "meshing/surfels.hpp"

namespace planum {
namespace {

constexpr double min_fill = 1.3;  // cubes that a plane passes through, times their area, per area
constexpr double same_plane = 0.002;            // m, planes this near to each other are one
constexpr std::size_t min_points = 40;          // to fit a plane to
const double max_lean = std::cos(radians(12));  // of the normals of these points
const double max_turn = std::cos(radians(60));  // of a triangle from the plane it is given to

std::vector<std::uint32_t> points_in_none(const PointRegions& points_in) {
  std::vector<std::uint32_t> points;
  for (std::uint32_t i = 0; i < points_in.of_point.size(); ++i)
    if (points_in.of_point[i] == PointRegions::none) points.push_back(i);
  return points;
}

/// Whether a surfel continues a region that the mesh breaks off beside it.
bool continues_a_region(const Surfel& surfel, const Eigen::Vector3d& origin, const Regions& regions,
                        const RegionLookup& lookup, const RegionParams& params) {
  const Eigen::Vector3d centre = surfel.moments.centroid() + origin;
  for (int k = 0; k < 27; ++k) {
    const Eigen::Vector3d off(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    const auto* candidates = lookup.near((centre + lookup.cube() * off).cast<float>());
    if (!candidates) continue;
    for (const std::uint32_t region : *candidates) {
      if (region == Regions::rest) continue;
      const Plane& plane = regions.regions[region].plane;
      if (std::abs(plane.signed_distance(centre)) <= params.max_distance &&
          plane.normal.dot(surfel.normal()) >= std::cos(params.max_angle))
        return true;
    }
  }
  return false;
}

struct GrownPlane {
  Plane plane;
  PointMoments moments;  ///< of its points, relative to Surfels::origin
};

/// Whether a plane fits points about as well as their own plane does.
bool is_same_plane(const Plane& plane, const GrownPlane& grown, const Eigen::Vector3d& origin,
                   const RegionParams& params) {
  if (plane.normal.dot(grown.plane.normal) < std::cos(params.merge_angle)) return false;
  const double own = rms_distance(grown.moments, relative_to(grown.plane, origin));
  return rms_distance(grown.moments, relative_to(plane, origin)) <= 1.1 * own + same_plane;
}

/// Grows planes over surfels.
class SurfelGrower {
 public:
  SurfelGrower(const Surfels& surfels, std::vector<bool> taken, const RegionParams& params,
               double cube)
      : surfels_(surfels),
        params_(params),
        min_count_(min_fill * params.min_area / (cube * cube)),
        owner_(surfels.all().size(), Regions::rest),
        taken_(std::move(taken)),
        tried_(taken_),
        asked_(surfels.all().size(), 0) {}

  std::vector<GrownPlane> grown() {
    std::vector<std::uint32_t> order(owner_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return surfel(a).moments.count > surfel(b).moments.count;
    });
    std::vector<GrownPlane> planes;
    for (const std::uint32_t seed : order) {
      if (owner_[seed] != Regions::rest || tried_[seed]) continue;
      grow(seed, static_cast<std::uint32_t>(planes.size()));
      if (is_plane()) {
        planes.push_back({plane_, moments_});
      } else {
        for (const std::uint32_t s : members_) owner_[s] = Regions::rest;
      }
    }
    return planes;
  }

  std::uint32_t owner(std::uint32_t surfel) const { return owner_[surfel]; }

 private:
  const Surfel& surfel(std::uint32_t s) const { return surfels_.all()[s]; }
  Eigen::Vector3d centre(std::uint32_t s) const {
    return surfel(s).moments.centroid() + surfels_.origin();
  }

  bool fits(std::uint32_t s) const {
    return surfel(s).normal().dot(plane_.normal) >= min_cosine_ &&
           std::abs(plane_.signed_distance(centre(s))) <= params_.max_distance;
  }

  void grow(std::uint32_t seed, std::uint32_t id) {
    ++growth_;
    plane_ = {surfel(seed).normal(), surfel(seed).normal().dot(centre(seed))};
    moments_ = {};
    members_.clear();
    std::size_t refit_at = 8;
    std::vector<std::uint32_t> queue{seed};
    for (std::size_t at = 0; at < queue.size(); ++at) {
      const std::uint32_t s = queue[at];
      if (owner_[s] != Regions::rest || !fits(s)) continue;
      owner_[s] = id;
      tried_[s] = true;
      members_.push_back(s);
      moments_ += surfel(s).moments;
      if (members_.size() == refit_at) {
        refit();
        refit_at = refit_at * 3 / 2;
      }
      surfels_.around(surfel(s).cube, [&](std::uint32_t other) {
        if (owner_[other] != Regions::rest || asked_[other] == growth_ || taken_[other]) return;
        asked_[other] = growth_;
        queue.push_back(other);
      });
    }
    refit();
  }

  void refit() {
    if (const std::optional<PlaneFit> fit = fit_plane(moments_))
      plane_ = relative_to(facing(fit->plane, plane_.normal), -surfels_.origin());
  }

  bool is_plane() const {
    if (static_cast<double>(members_.size()) < min_count_) return false;
    if (rms_distance(moments_, relative_to(plane_, surfels_.origin())) > params_.max_distance)
      return false;
    CurvatureFit fit(plane_, surfels_.origin() + moments_.centroid());
    for (const std::uint32_t s : members_)
      if (fits(s)) fit.add(centre(s), surfel(s).moments.count);
    return fit.curvature() * params_.min_radius <= 1;
  }

  const Surfels& surfels_;
  const RegionParams& params_;
  const double min_cosine_ = std::cos(params_.max_angle);
  const double min_count_;
  std::vector<std::uint32_t> owner_;
  const std::vector<bool> taken_;  ///< is of a region that there is already
  std::vector<bool> tried_;
  std::vector<std::uint32_t> asked_;
  std::uint32_t growth_ = 0;
  Plane plane_;
  PointMoments moments_;
  std::vector<std::uint32_t> members_;
};

/// Adds the planes that are not there yet to the regions. Returns for each plane its region.
std::vector<std::uint32_t> add_planes(const std::vector<GrownPlane>& planes,
                                      const Eigen::Vector3d& origin, const RegionParams& params,
                                      Regions& regions) {
  std::vector<std::uint32_t> region_of;
  for (const GrownPlane& plane : planes) {
    std::uint32_t region = 0;
    while (region < regions.regions.size() &&
           !is_same_plane(regions.regions[region].plane, plane, origin, params))
      ++region;
    if (region == regions.regions.size()) regions.regions.push_back({plane.plane, 0});
    region_of.push_back(region);
  }
  return region_of;
}

/// Fits the new regions to the points of their surfels whose normals agree well: those of the edges
/// do not.
void refit(Regions& regions, std::size_t first_new, const std::vector<std::uint32_t>& region_of,
           const Cloud& cloud, const std::vector<std::uint32_t>& points) {
  std::vector<std::vector<std::uint32_t>> of_region(regions.regions.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::uint32_t region = region_of[k];
    if (region == Regions::rest || region < first_new) continue;
    const Plane& plane = regions.regions[region].plane;
    if (cloud.normals[points[k]].cast<double>().dot(plane.normal) > max_lean)
      of_region[region].push_back(points[k]);
  }
  for (std::size_t r = first_new; r < of_region.size(); ++r)
    if (of_region[r].size() >= min_points)
      regions.regions[r].plane = robust_plane(regions.regions[r].plane, cloud, of_region[r]);
}

/// Sorts regions by area and drops those below the limit.
Regions sorted(const Regions& regions, const FaceGeometry& faces, double min_area) {
  std::vector<double> area(regions.regions.size(), 0);
  for (std::size_t f = 0; f < regions.of_triangle.size(); ++f)
    if (regions.of_triangle[f] != Regions::rest) area[regions.of_triangle[f]] += faces.area[f];
  std::vector<std::uint32_t> order(area.size()), rank(area.size(), Regions::rest);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return area[a] > area[b]; });
  Regions result;
  for (const std::uint32_t r : order) {
    if (area[r] < min_area || area[r] == 0) continue;
    rank[r] = static_cast<std::uint32_t>(result.regions.size());
    result.regions.push_back({regions.regions[r].plane, area[r]});
  }
  result.of_triangle = regions.of_triangle;
  for (std::uint32_t& label : result.of_triangle)
    if (label != Regions::rest) label = rank[label];
  return result;
}

}  // namespace

Regions with_small_planes(const Regions& regions, const TriangleMesh& mesh, const Cloud& cloud,
                          const PointRegions& points_in, const RegionParams& params) {
  if (cloud.normals.empty()) return regions;
  const double cube = params.max_distance * 5 / 3;
  const std::vector<std::uint32_t> points = points_in_none(points_in);
  const Surfels surfels(cloud, points, cube);
  std::vector<bool> taken;
  for (const Surfel& surfel : surfels.all())
    taken.push_back(
        continues_a_region(surfel, surfels.origin(), regions, points_in.lookup, params));
  SurfelGrower grower(surfels, taken, params, cube);
  const std::vector<GrownPlane> planes = grower.grown();
  if (planes.empty()) return regions;
  Regions result = regions;
  const std::vector<std::uint32_t> of_plane = add_planes(planes, surfels.origin(), params, result);
  const auto region_of_surfel = [&](std::uint32_t s) {
    return grower.owner(s) == Regions::rest ? Regions::rest : of_plane[grower.owner(s)];
  };
  std::vector<std::uint32_t> region_of_point;
  for (const std::uint32_t s : surfels.of_point())
    region_of_point.push_back(s == Surfels::none ? Regions::rest : region_of_surfel(s));
  refit(result, regions.regions.size(), region_of_point, cloud, points);
  const FaceGeometry faces = face_geometry(mesh);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (result.of_triangle[f] != Regions::rest) continue;
    double nearest = params.max_distance;
    surfels.around(surfels.cube_of(faces.centroid[f]), [&](std::uint32_t s) {
      const std::uint32_t region = region_of_surfel(s);
      if (region == Regions::rest) return;
      const Plane& plane = result.regions[region].plane;
      const double off = std::abs(plane.signed_distance(faces.centroid[f]));
      if (off >= nearest || faces.normal[f].dot(plane.normal) < max_turn) return;
      nearest = off;
      result.of_triangle[f] = region;
    });
  }
  // Half of a narrow plane's triangles lean away and wait for the creases to be closed.
  return sorted(result, faces, params.min_area / 4);
}

}  // namespace planum
