#include "meshing/border_repair.hpp"

#include <algorithm>
#include <set>

#include "meshing/geos_polygons.hpp"
#include "meshing/ring_crossings.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr int max_rounds = 8;
constexpr std::size_t max_loop = 12;  ///< vertices; a loop of more is no fold of the border

class BorderRepair {
 public:
  BorderRepair(BorderNetwork& network, const DraftParams& params, double max_error)
      : network_(network), params_(params), max_error_(network.chains.size(), max_error) {
    chain_of_.assign(network.corners.points.size(), no_chain);
    for (std::uint32_t c = 0; c < network.shapes.size(); ++c) {
      const ChainShape& shape = network.shapes[c];
      const std::size_t ends = shape.closed ? 0 : 1;
      for (std::size_t i = ends; i + ends < shape.left.size(); ++i) {
        chain_of_[shape.left[i]] = c;
        if (!shape.right.empty()) chain_of_[shape.right[i]] = c;
      }
    }
  }

  std::size_t repaired() {
    std::size_t invalid = 0;
    for (int round = 0; round < max_rounds; ++round) {
      dropped_.clear();
      refined_.clear();
      invalid = look_for_crossings();
      if (invalid == 0 || (dropped_.empty() && refined_.empty())) break;
      change_borders();
    }
    return invalid;
  }

 private:
  static constexpr std::uint32_t no_chain = HalfEdges::none;

  std::size_t look_for_crossings() {
    const std::vector<PolygonDraft> drafts = polygon_drafts(network_, params_);
    std::vector<std::uint8_t> valid(drafts.size());
    std::vector<std::vector<Ring2d>> flat(drafts.size());
    parallel_for(drafts.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        flat[i] = flat_rings(drafts[i].rings, network_.regions[drafts[i].region].plane,
                             network_.corners.points);
        valid[i] = is_valid_polygon(flat[i]);
      }
    });
    std::size_t invalid = 0;
    for (std::size_t i = 0; i < drafts.size(); ++i) {
      if (valid[i]) continue;
      ++invalid;
      for (const RingCrossing& crossing : ring_crossings(drafts[i].rings, flat[i]))
        undo(crossing, drafts[i].rings);
    }
    return invalid;
  }

  void undo(const RingCrossing& crossing, const std::vector<Ring>& rings) {
    const Ring& ring = rings[crossing.first_ring];
    if (crossing.first_ring != crossing.second_ring) {
      refine(ring, crossing.first_edge);
      refine(rings[crossing.second_ring], crossing.second_edge);
      return;
    }
    // The vertices between the two edges, on the shorter way.
    const auto [low, high] = std::minmax(crossing.first_edge, crossing.second_edge);
    std::size_t from = low + 1, count = high - low;
    if (ring.size() - count < count) {
      from = high + 1;
      count = ring.size() - count;
    }
    bool any = false;
    for (std::size_t i = from; count <= max_loop && i < from + count; ++i) {
      const std::uint32_t point = ring[i % ring.size()];
      if (chain_of_[point] == no_chain) continue;
      dropped_.insert(point);
      any = true;
    }
    if (any) return;
    refine(ring, crossing.first_edge);
    refine(ring, crossing.second_edge);
  }

  void refine(const Ring& ring, std::size_t edge) {
    for (const std::size_t i : {edge, (edge + 1) % ring.size()})
      if (chain_of_[ring[i]] != no_chain) refined_.insert(chain_of_[ring[i]]);
  }

  void change_borders() {
    for (const std::uint32_t c : refined_) {
      max_error_[c] /= 2;
      simplify(network_.shapes[c], network_.corners.points, max_error_[c]);
    }
    std::set<std::uint32_t> touched;
    for (const std::uint32_t point : dropped_) touched.insert(chain_of_[point]);
    for (const std::uint32_t c : touched) {
      ChainShape& shape = network_.shapes[c];
      std::erase_if(shape.kept, [&](std::size_t i) {
        if (!shape.closed && (i == 0 || i + 1 == shape.left.size())) return false;
        return dropped_.contains(shape.left[i]) ||
               (!shape.right.empty() && dropped_.contains(shape.right[i]));
      });
    }
  }

  BorderNetwork& network_;
  const DraftParams& params_;
  std::vector<double> max_error_;        ///< m, of the chains
  std::vector<std::uint32_t> chain_of_;  ///< for each point inside a chain (not at its ends) that
  std::set<std::uint32_t> dropped_;      ///< points
  std::set<std::uint32_t> refined_;      ///< chains
};

}  // namespace

std::size_t uncross_borders(BorderNetwork& network, const DraftParams& params, double max_error) {
  return BorderRepair(network, params, max_error).repaired();
}

}  // namespace planum
