#include "meshing/polygon_drafts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "meshing/rings.hpp"

namespace planum {
namespace {

constexpr double min_ring_area = 1e-9;  // m^2, less is a line

struct Loop {
  Ring ring;
  double area;  ///< m^2, negative for holes
};

/// The rings of a connected part of a region.
struct Part {
  std::uint32_t region = 0;
  std::vector<Loop> outer, holes;
  std::vector<std::uint32_t> chains;
};

Ring points_of(const BorderRing& border, const BorderNetwork& network) {
  Ring ring;
  for (const ChainUse use : border.chains) {
    std::vector<std::uint32_t> points = network.shapes[use.chain].kept_points(use.reversed);
    if (use.reversed) std::reverse(points.begin(), points.end());
    ring.insert(ring.end(), points.begin(), points.end());
  }
  return ring;
}

/// Whether only the rim of the mesh bounds a hole.
bool is_gap(const BorderRing& border, const BorderNetwork& network) {
  const BorderChain& chain = network.chains[border.chains.front().chain];
  return border.chains.size() == 1 && chain.closed && chain.right == outside_mesh;
}

std::vector<Part> parts_of_regions(const BorderNetwork& network, const DraftParams& params) {
  std::map<std::uint32_t, Part> by_component;
  for (const BorderRing& border : network.rings) {
    Part& part = by_component[network.component_of[border.triangle]];
    part.region = network.labels[border.triangle];
    for (const ChainUse use : border.chains) part.chains.push_back(use.chain);
    const PlaneFrame frame(network.regions[part.region].plane);
    for (Ring& ring : simple_rings(points_of(border, network))) {
      Ring2d flat;
      for (const std::uint32_t v : ring) flat.push_back(frame.flat(network.corners.points[v]));
      const double area = signed_area(flat);
      if (std::abs(area) < min_ring_area) continue;
      if (area < 0 && -area < params.min_hole && is_gap(border, network)) continue;
      (area > 0 ? part.outer : part.holes).push_back({std::move(ring), area});
    }
  }
  std::vector<Part> parts;
  for (auto& [component, part] : by_component)
    if (!part.outer.empty()) parts.push_back(std::move(part));
  return parts;
}

/// The place of the smallest outer ring around a hole.
std::size_t outer_of(const Ring& hole, const Part& part, const BorderNetwork& network) {
  if (part.outer.size() == 1) return 0;
  const PlaneFrame frame(network.regions[part.region].plane);
  const auto at = [&](std::uint32_t v) { return frame.flat(network.corners.points[v]); };
  std::size_t best = 0;
  double best_area = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < part.outer.size(); ++i) {
    const Ring& outer = part.outer[i].ring;
    const auto is_free = [&](std::uint32_t v) {
      return std::find(outer.begin(), outer.end(), v) == outer.end();
    };
    const auto v = std::find_if(hole.begin(), hole.end(), is_free);
    if (v == hole.end() || part.outer[i].area >= best_area) continue;
    Ring2d flat;
    for (const std::uint32_t w : outer) flat.push_back(at(w));
    if (!is_inside(flat, at(*v))) continue;
    best = i;
    best_area = part.outer[i].area;
  }
  return best;
}

}  // namespace

std::vector<Ring2d> flat_rings(const std::vector<Ring>& rings, const Plane& plane,
                               const std::vector<Eigen::Vector3d>& points) {
  const PlaneFrame frame(plane);
  std::vector<Ring2d> flat(rings.size());
  for (std::size_t r = 0; r < rings.size(); ++r)
    for (const std::uint32_t v : rings[r]) flat[r].push_back(frame.flat(points[v]));
  return flat;
}

std::vector<PolygonDraft> polygon_drafts(const BorderNetwork& network, const DraftParams& params) {
  std::vector<PolygonDraft> drafts;
  for (Part& part : parts_of_regions(network, params)) {
    const std::size_t first = drafts.size();
    std::vector<double> area;
    for (Loop& outer : part.outer) {
      area.push_back(outer.area);
      drafts.push_back({part.region, {outer.ring}, part.chains, false});
    }
    for (const Loop& hole : part.holes) {
      const std::size_t outer = outer_of(hole.ring, part, network);
      area[outer] += hole.area;
      drafts[first + outer].rings.push_back(hole.ring);
    }
    for (std::size_t i = 0; i < area.size(); ++i)
      drafts[first + i].is_scrap = area[i] < params.min_area;
  }
  return drafts;
}

}  // namespace planum
