#include "meshing/laser_shadows.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "meshing/plane_gaps.hpp"
#include "meshing/scan_indices.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr double most_samples = 300;                // of one hole
constexpr double beside = 0.08, border_step = 0.1;  // m, of places on the polygon around a hole
constexpr double min_border_seen = 0.25;  // share of these that a scan sees, to miss the rest

void check(const Cloud& cloud, std::span<const Eigen::Vector3d> origins,
           const ShadowParams& params) {
  const auto fail = [](const std::string& what) { throw Error("laser shadows: " + what); };
  if (!(params.max_area >= 0))
    fail("max_area must be at least 0, is " + std::to_string(params.max_area) + " m2");
  if (!(params.sample > 0))
    fail("sample must be positive, is " + std::to_string(params.sample) + " m");
  check_scan_indices(cloud, origins.size(), "laser shadows");
}

/// A place in a gap, and what all scans together say about it.
struct Sample {
  Eigen::Vector3f place = Eigen::Vector3f::Zero();
  bool before = false, at = false, through = false, lost = false;
};

/// Where a gap is judged.
struct GapSamples {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  std::vector<Sample> inside;
  std::vector<Eigen::Vector3f> border;  ///< on the polygon, just beside the gap
};

std::vector<Sample> samples_inside(const std::vector<Ring2d>& rings, const PlaneFrame& frame,
                                   double step) {
  Eigen::Array2d low = rings.front().front(), high = low;
  for (const Eigen::Vector2d& p : rings.front()) {
    low = low.min(p.array());
    high = high.max(p.array());
  }
  std::vector<Sample> samples;
  for (double y = low.y() + step / 2; y < high.y(); y += step)
    for (double x = low.x() + step / 2; x < high.x(); x += step) {
      const Eigen::Vector2d p(x, y);
      if (is_inside(rings.front(), p) &&
          std::none_of(rings.begin() + 1, rings.end(),
                       [&](const Ring2d& island) { return is_inside(island, p); }))
        samples.push_back({.place = frame.raised(p).cast<float>()});
    }
  return samples;
}

/// Beside the edges of the polygon; those that close a notch have nothing beside them.
std::vector<Eigen::Vector3f> samples_beside(const PlaneGap& gap, const Ring2d& outer,
                                            const PlaneFrame& frame) {
  const std::size_t edges = gap.edges > 0 ? gap.edges : outer.size();
  std::vector<Eigen::Vector3f> places;
  for (std::size_t i = 0; i < edges; ++i) {
    const Eigen::Vector2d &a = outer[i], along = outer[(i + 1) % outer.size()] - a;
    const double length = along.norm();
    if (!(length > 0)) continue;
    const Eigen::Vector2d outwards = Eigen::Vector2d(along.y(), -along.x()) / length;
    const double count = std::ceil(length / border_step);
    for (double k = 0.5; k < count; ++k) {
      const Eigen::Vector2d p = a + k / count * along + beside * outwards;
      places.push_back(frame.raised(p).cast<float>());
    }
  }
  return places;
}

GapSamples samples_of(const PlaneGap& gap, const PolygonMap& map, double distance) {
  const Plane& plane = map.polygons[gap.polygon].plane;
  const PlaneFrame frame(plane);
  const std::vector<Ring2d> rings = rings_of(gap, map, frame);
  const double step = std::max(distance, std::sqrt(gap.area / most_samples));
  return {.normal = plane.normal.cast<float>(),
          .inside = samples_inside(rings, frame, step),
          .border = samples_beside(gap, rings.front(), frame)};
}

/// Whether a scan sees the polygon beside the gap, so that rays into the gap should come back.
bool sees_border(const RangeMap& map, const SightParams& params, const GapSamples& gap) {
  double seen = 0;
  for (const Eigen::Vector3f& place : gap.border)
    seen += map.sight(place, gap.normal, params) == Sight::at;
  return seen >= min_border_seen * static_cast<double>(gap.border.size());
}

/// Adds what one scan says.
void look(const RangeMap& map, const SightParams& params, GapSamples& gap) {
  if (gap.border.empty()) return;
  const Eigen::Vector3f way = map.origin() - gap.border.front();
  if (gap.normal.dot(way) <= 0 || way.norm() > map.farthest()) return;
  const bool is_witness = sees_border(map, params, gap);
  for (Sample& s : gap.inside) {
    const Sight sight = map.sight(s.place, gap.normal, params);
    s.before |= sight == Sight::before;
    s.at |= sight == Sight::at;
    s.through |= sight == Sight::through;
    s.lost |= sight == Sight::lost && is_witness;
  }
}

void look(std::vector<GapSamples>& gaps, const Cloud& cloud,
          std::span<const Eigen::Vector3d> origins, const SightParams& params) {
  visit_range_maps(cloud, origins, [&](std::span<const RangeMap> maps) {
    parallel_for(gaps.size(), 1, [&](std::size_t g, std::size_t) {
      for (const RangeMap& map : maps) look(map, params, gaps[g]);
    });
  });
}

bool is_shadow(const std::vector<Sample>& samples, const ShadowParams& params) {
  double open = 0, hidden = 0, known = 0;
  for (const Sample& s : samples) {
    const bool is_open = s.through || s.lost;
    open += is_open;
    hidden += s.before && !s.at && !is_open;
    known += s.before || s.at || s.through;
  }
  const auto all = static_cast<double>(samples.size());
  return all > 0 && open <= params.max_open * all && hidden >= params.min_hidden * all &&
         known >= params.min_known * all;
}

InferredPatch patch_of(const PlaneGap& gap, PolygonMap& map) {
  InferredPatch patch{.polygon = gap.polygon,
                      .shape = {map.polygons[gap.polygon].plane, gap.names, {}, gap.area}};
  for (std::size_t i = 0; i < gap.names.size(); ++i) {
    if (gap.names[i] != PlaneGap::unnamed) continue;
    patch.shape.outer[i] = static_cast<std::uint32_t>(map.vertices.size());
    map.vertices.push_back(gap.outer[i]);
  }
  for (const std::uint32_t island : gap.islands) {
    const Ring& outer = map.polygons[island].outer;
    patch.shape.holes.emplace_back(outer.rbegin(), outer.rend());
  }
  return patch;
}

}  // namespace

PolygonMap with_shadows_filled(PolygonMap map, const Cloud& cloud,
                               std::span<const Eigen::Vector3d> origins,
                               const ShadowParams& params) {
  check(cloud, origins, params);
  map.inferred.clear();
  if (params.max_area == 0) return map;
  std::vector<PlaneGap> gaps = plane_gaps(map, {.min_area = params.min_area,
                                                .max_area = params.max_area,
                                                .min_free_border = params.min_free_border});
  std::stable_sort(gaps.begin(), gaps.end(),
                   [](const PlaneGap& a, const PlaneGap& b) { return a.area > b.area; });
  std::vector<GapSamples> samples;
  for (const PlaneGap& gap : gaps) samples.push_back(samples_of(gap, map, params.sample));
  look(samples, cloud, origins, params.sight);
  std::vector<const PlaneGap*> filled;
  for (std::uint32_t g = 0; g < gaps.size(); ++g) {
    if (!is_shadow(samples[g].inside, params)) continue;
    if (std::none_of(filled.begin(), filled.end(),
                     [&](const PlaneGap* other) { return overlap(gaps[g], *other, map); }))
      filled.push_back(&gaps[g]);
  }
  for (const PlaneGap* gap : filled) map.inferred.push_back(patch_of(*gap, map));
  return map;
}

}  // namespace planum
