#include "meshing/borders.hpp"

#include <unordered_map>

namespace planum {

std::uint32_t label_across(const HalfEdges& edges, const std::vector<std::uint32_t>& labels,
                           std::uint32_t half_edge) {
  const std::uint32_t back = edges.opposite[half_edge];
  return back == HalfEdges::none ? outside_mesh : labels[back / 3];
}

std::uint32_t next_on_border(const HalfEdges& edges, const std::vector<std::uint32_t>& labels,
                             std::uint32_t half_edge) {
  const std::uint32_t label = labels[half_edge / 3];
  std::uint32_t h = HalfEdges::next(half_edge);
  while (label_across(edges, labels, h) == label) h = HalfEdges::next(edges.opposite[h]);
  return h;
}

std::vector<std::uint8_t> border_degrees(const HalfEdges& edges,
                                         const std::vector<std::uint32_t>& labels) {
  std::vector<std::uint8_t> degree(edges.source.size(), 0);
  const auto count = [&](std::uint32_t v) {
    if (degree[v] < 255) ++degree[v];
  };
  for (std::uint32_t h = 0; h < edges.opposite.size(); ++h) {
    if (edges.is_degenerate(h / 3)) continue;
    const std::uint32_t back = edges.opposite[h];
    if (back != HalfEdges::none && (back < h || labels[back / 3] == labels[h / 3])) continue;
    count(edges.from(h));
    count(edges.to(h));
  }
  return degree;
}

std::vector<BorderChain> border_chains(const HalfEdges& edges,
                                       const std::vector<std::uint32_t>& labels) {
  const std::vector<std::uint8_t> degree = border_degrees(edges, labels);
  std::vector<bool> seen(edges.opposite.size(), false);
  std::vector<BorderChain> chains;
  // A region is on the left of its border to regions of higher number, the rest and the outside.
  const auto starts_chain = [&](std::uint32_t h) {
    const std::uint32_t label = labels[h / 3];
    return !seen[h] && label < outside_mesh && !edges.is_degenerate(h / 3) &&
           label_across(edges, labels, h) > label;
  };
  const auto follow = [&](std::uint32_t h) {
    BorderChain chain{labels[h / 3], label_across(edges, labels, h), {}, false};
    while (!seen[h]) {
      seen[h] = true;
      chain.half_edges.push_back(h);
      if (degree[edges.to(h)] != 2) break;
      h = next_on_border(edges, labels, h);
    }
    chain.closed = degree[edges.to(chain.half_edges.back())] == 2;
    chains.push_back(std::move(chain));
  };
  for (std::uint32_t h = 0; h < edges.opposite.size(); ++h)
    if (starts_chain(h) && degree[edges.from(h)] != 2) follow(h);
  for (std::uint32_t h = 0; h < edges.opposite.size(); ++h)
    if (starts_chain(h)) follow(h);
  return chains;
}

std::vector<BorderRing> border_rings(const HalfEdges& edges,
                                     const std::vector<std::uint32_t>& labels,
                                     const std::vector<BorderChain>& chains) {
  // Each use of a chain by the half-edge of its region that it begins with.
  std::unordered_map<std::uint32_t, std::uint32_t> use_of;
  std::vector<ChainUse> uses;
  std::vector<std::uint32_t> first, last;
  const auto add = [&](ChainUse use, std::uint32_t from, std::uint32_t to) {
    use_of.emplace(from, static_cast<std::uint32_t>(uses.size()));
    uses.push_back(use);
    first.push_back(from);
    last.push_back(to);
  };
  for (std::uint32_t c = 0; c < chains.size(); ++c) {
    const std::uint32_t front = chains[c].half_edges.front(), back = chains[c].half_edges.back();
    add({c, false}, front, back);
    if (chains[c].right < outside_mesh) add({c, true}, edges.opposite[back], edges.opposite[front]);
  }
  std::vector<BorderRing> rings;
  std::vector<bool> done(uses.size(), false);
  for (std::uint32_t begin = 0; begin < uses.size(); ++begin) {
    if (done[begin]) continue;
    BorderRing ring{first[begin] / 3, {}};
    for (std::uint32_t use = begin; !done[use];) {
      done[use] = true;
      ring.chains.push_back(uses[use]);
      use = use_of.at(next_on_border(edges, labels, last[use]));
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

}  // namespace planum
