#include "meshing/creases.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "meshing/components.hpp"

namespace planum {
namespace {

/// A triangle of the rest and a region beside it.
struct Offer {
  double distance;  ///< m, of the centroid from the plane
  std::uint32_t triangle, region;
  bool operator>(const Offer& other) const {
    if (distance != other.distance) return distance > other.distance;
    return triangle != other.triangle ? triangle > other.triangle : region > other.region;
  }
};

class CreaseCloser {
 public:
  CreaseCloser(const Regions& regions, const HalfEdges& edges, const FaceGeometry& faces,
               const CreaseParams& params)
      : regions_(regions),
        edges_(edges),
        faces_(faces),
        params_(params),
        label_(regions.of_triangle),
        open_(label_.size(), true) {}

  std::vector<std::uint32_t> closed() {
    flood(params_.reach, std::cos(params_.max_angle));
    dissolve_islands();
    flood(params_.reach, std::cos(params_.max_angle));
    fill_dents();
    cut_teeth();
    dissolve_islands();
    fill_dents();
    return label_;
  }

 private:
  double distance(std::uint32_t f, std::uint32_t region) const {
    return std::abs(regions_.regions[region].plane.signed_distance(faces_.centroid[f]));
  }

  double cosine(std::uint32_t f, std::uint32_t region) const {
    return regions_.regions[region].plane.normal.dot(faces_.normal[f]);
  }

  /// The normal of a sliver says nothing.
  bool is_sliver(std::uint32_t f) const {
    return faces_.area[f] < 0.01 * params_.reach * params_.reach;
  }

  /// Gives open triangles of the rest to the regions they touch, the nearest first.
  void flood(double reach, double min_cosine) {
    std::priority_queue<Offer, std::vector<Offer>, std::greater<>> offers;
    const auto offer_around = [&](std::uint32_t f) {
      for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        const std::uint32_t back = edges_.opposite[h];
        if (back == HalfEdges::none) continue;
        const std::uint32_t g = back / 3;
        if (label_[g] != Regions::rest || !open_[g]) continue;
        const double off = distance(g, label_[f]);
        if (off > reach) continue;
        if (cosine(g, label_[f]) < min_cosine && !is_sliver(g)) continue;
        offers.push({off, g, label_[f]});
      }
    };
    for (std::uint32_t f = 0; f < label_.size(); ++f)
      if (label_[f] != Regions::rest) offer_around(f);
    while (!offers.empty()) {
      const Offer best = offers.top();
      offers.pop();
      if (label_[best.triangle] != Regions::rest) continue;
      label_[best.triangle] = best.region;
      offer_around(best.triangle);
    }
  }

  void dissolve_islands() {
    for (const auto& component : components(edges_, label_).triangles) {
      if (label_[component.front()] == Regions::rest) continue;
      double area = 0;
      for (const std::uint32_t f : component) area += faces_.area[f];
      if (area >= params_.min_component) continue;
      for (const std::uint32_t f : component) label_[f] = Regions::rest;
    }
  }

  /// Parts of the rest that lie wholly near the planes around them go to these, however they are
  /// turned.
  void fill_dents() {
    std::fill(open_.begin(), open_.end(), false);
    for (const auto& component : components(edges_, label_).triangles) {
      if (label_[component.front()] != Regions::rest) continue;
      const std::vector<std::uint32_t> around = regions_around(component);
      const auto near_a_plane = [&](std::uint32_t f) {
        return std::any_of(around.begin(), around.end(), [&](std::uint32_t region) {
          return distance(f, region) <= params_.reach;
        });
      };
      if (std::all_of(component.begin(), component.end(), near_a_plane))
        for (const std::uint32_t f : component) open_[f] = true;
    }
    flood(params_.reach, -2);
    std::fill(open_.begin(), open_.end(), true);
  }

  std::vector<std::uint32_t> regions_around(const std::vector<std::uint32_t>& component) const {
    std::vector<std::uint32_t> around;
    for (const std::uint32_t f : component)
      for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        const std::uint32_t back = edges_.opposite[h];
        if (back != HalfEdges::none && label_[back / 3] != Regions::rest)
          around.push_back(label_[back / 3]);
      }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    return around;
  }

  /// A triangle with two neighbours in one other region joins it.
  void cut_teeth() {
    std::vector<std::uint8_t> flips(label_.size(), 0);
    std::vector<std::uint32_t> queue(label_.size());
    for (std::uint32_t f = 0; f < queue.size(); ++f) queue[f] = f;
    for (std::size_t at = 0; at < queue.size(); ++at) {
      const std::uint32_t f = queue[at], better = majority_around(f);
      if (better == label_[f] || flips[f] == 2) continue;
      if (distance(f, better) > params_.reach) continue;
      if (cosine(f, better) < 0 && !is_sliver(f)) continue;
      label_[f] = better;
      ++flips[f];
      for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h)
        if (edges_.opposite[h] != HalfEdges::none) queue.push_back(edges_.opposite[h] / 3);
    }
  }

  /// The region of at least two of the three neighbours, or else the label as it is.
  std::uint32_t majority_around(std::uint32_t f) const {
    std::uint32_t around[3];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t back = edges_.opposite[3 * f + k];
      around[k] = back == HalfEdges::none ? Regions::rest : label_[back / 3];
    }
    if (around[0] != Regions::rest && (around[0] == around[1] || around[0] == around[2]))
      return around[0];
    if (around[1] != Regions::rest && around[1] == around[2]) return around[1];
    return label_[f];
  }

  const Regions& regions_;
  const HalfEdges& edges_;
  const FaceGeometry& faces_;
  const CreaseParams& params_;
  std::vector<std::uint32_t> label_;
  std::vector<bool> open_;  ///< may be given away by flood()
};

}  // namespace

std::vector<std::uint32_t> closed_creases(const Regions& regions, const HalfEdges& edges,
                                          const FaceGeometry& faces, const CreaseParams& params) {
  return CreaseCloser(regions, edges, faces, params).closed();
}

}  // namespace planum
