#include "meshing/corner_snapping.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "meshing/borders.hpp"
#include "meshing/plane_meeting.hpp"

namespace planum {
namespace {

/// Consecutive triangles around a vertex with one label, counter-clockwise.
struct Sector {
  std::uint32_t label;
  std::vector<std::uint32_t> corners;  ///< half-edges that leave the vertex
  std::uint32_t first = SnappedCorners::none, last = SnappedCorners::none;  ///< points at its ends
};

bool is_region(std::uint32_t label) { return label < outside_mesh; }

class Snapper {
 public:
  Snapper(const std::vector<Region>& regions, const TriangleMesh& mesh, const HalfEdges& edges,
          const std::vector<std::uint32_t>& labels, const SnapParams& params)
      : regions_(regions), mesh_(mesh), edges_(edges), labels_(labels), params_(params) {
    result_.start.assign(edges.opposite.size(), SnappedCorners::none);
    result_.end.assign(edges.opposite.size(), SnappedCorners::none);
    result_.corner.assign(edges.opposite.size(), SnappedCorners::none);
  }

  SnappedCorners snapped() {
    const std::vector<std::uint8_t> degree = border_degrees(edges_, labels_);
    std::vector<bool> done(degree.size(), false);
    for (std::uint32_t h = 0; h < edges_.opposite.size(); ++h) {
      const std::uint32_t v = edges_.from(h);
      if (degree[v] == 0 || done[v] || edges_.is_degenerate(h / 3)) continue;
      done[v] = true;
      snap(v, h);
    }
    return std::move(result_);
  }

 private:
  void snap(std::uint32_t v, std::uint32_t out) {
    position_ = mesh_.vertices[edges_.source[v]].cast<double>();
    made_here_.clear();
    std::vector<Sector> sectors = sectors_around(out);
    std::vector<std::uint32_t> all;
    for (const Sector& sector : sectors)
      if (is_region(sector.label)) all.push_back(sector.label);
    if (all.empty()) return;  // the rim of the rest stays where it is
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    const std::uint32_t common = common_point(all);
    if (common != SnappedCorners::none)
      for (Sector& sector : sectors) sector.first = sector.last = common;
    else
      give_several_points(sectors, all);
    write(sectors);
  }

  /// Sectors in counter-clockwise order; at the rim of the mesh the first one begins there.
  std::vector<Sector> sectors_around(std::uint32_t out) {
    const auto clockwise = [&](std::uint32_t h) {
      const std::uint32_t back = edges_.opposite[h];
      return back == HalfEdges::none ? HalfEdges::none : HalfEdges::next(back);
    };
    // To the rim, or else to where a sector begins.
    std::uint32_t begin = out;
    for (std::uint32_t h = clockwise(out); h != HalfEdges::none && h != out; h = clockwise(h))
      begin = h;
    closed_ = clockwise(begin) != HalfEdges::none;
    if (closed_)
      while (labels_[clockwise(begin) / 3] == labels_[begin / 3]) begin = clockwise(begin);
    std::vector<Sector> sectors;
    std::uint32_t h = begin;
    do {
      if (sectors.empty() || sectors.back().label != labels_[h / 3])
        sectors.push_back({labels_[h / 3], {}});
      sectors.back().corners.push_back(h);
      h = edges_.opposite[HalfEdges::previous(h)];
    } while (h != HalfEdges::none && h != begin);
    return sectors;
  }

  /// The point where these regions (sorted) meet here, or none.
  std::uint32_t common_point(const std::vector<std::uint32_t>& group) {
    for (const auto& [made, point] : made_here_)
      if (made == group) return point;
    planes_.clear();
    for (const std::uint32_t region : group) planes_.push_back(regions_[region].plane);
    const double max_move =
        group.size() == 1 ? std::numeric_limits<double>::infinity() : params_.max_move;
    const auto meets = meeting(planes_, position_, max_move, params_.max_offset);
    if (!meets) return SnappedCorners::none;
    const auto add = [&] {
      result_.points.push_back(meets->point);
      return static_cast<std::uint32_t>(result_.points.size() - 1);
    };
    // Three planes have one point: every vertex where they meet becomes the same.
    std::uint32_t point;
    if (meets->rank == 3) {
      const auto [at, is_new] = corners_.try_emplace(group, 0);
      if (is_new) at->second = add();
      point = at->second;
    } else {
      point = add();
    }
    made_here_.emplace_back(group, point);
    return point;
  }

  /// The point of `region`, and `other` if they meet, with as many more of `all` as meet there too,
  /// the largest first.
  std::uint32_t point_of(std::uint32_t region, std::uint32_t other, bool together,
                         const std::vector<std::uint32_t>& all) {
    std::vector<std::uint32_t> group{region};
    std::uint32_t point = common_point(group);
    const auto try_to_add = [&](std::uint32_t label) {
      std::vector<std::uint32_t> larger = group;
      larger.insert(std::upper_bound(larger.begin(), larger.end(), label), label);
      const std::uint32_t larger_point = common_point(larger);
      if (larger_point == SnappedCorners::none) return false;
      group = std::move(larger);
      point = larger_point;
      return true;
    };
    if (together && !try_to_add(other)) return SnappedCorners::none;
    for (const std::uint32_t label : all)
      if (label != region && label != other) try_to_add(label);
    return point;
  }

  void give_several_points(std::vector<Sector>& sectors, const std::vector<std::uint32_t>& all) {
    const std::size_t count = sectors.size();
    for (std::size_t i = closed_ ? 0 : 1; i < count; ++i)
      give_points(sectors[(i + count - 1) % count], sectors[i], all);
    for (Sector& sector : sectors) {  // beside the rim
      if (sector.first == SnappedCorners::none && is_region(sector.label))
        sector.first = point_of(sector.label, sector.label, false, all);
      if (sector.last == SnappedCorners::none && is_region(sector.label))
        sector.last = point_of(sector.label, sector.label, false, all);
      if (is_region(sector.label)) continue;
      // The rest hangs on one point.
      const std::uint32_t point = sector.first != SnappedCorners::none ? sector.first : sector.last;
      sector.first = sector.last = point;
    }
  }

  /// Points at the border between two sectors.
  void give_points(Sector& right, Sector& left, const std::vector<std::uint32_t>& all) {
    if (is_region(right.label) && is_region(left.label)) {
      const std::uint32_t both = point_of(right.label, left.label, true, all);
      if (both != SnappedCorners::none) {
        right.last = left.first = both;
        return;
      }
      right.last = point_of(right.label, left.label, false, all);
      left.first = point_of(left.label, right.label, false, all);
    } else if (is_region(right.label)) {
      right.last = left.first = point_of(right.label, right.label, false, all);
    } else {
      right.last = left.first = point_of(left.label, left.label, false, all);
    }
  }

  void write(const std::vector<Sector>& sectors) {
    std::vector<std::uint32_t> around;
    const auto meet = [&](std::uint32_t point) {
      if (point != SnappedCorners::none && (around.empty() || around.back() != point))
        around.push_back(point);
    };
    for (const Sector& sector : sectors) {
      result_.start[sector.corners.front()] = sector.first;
      result_.end[HalfEdges::previous(sector.corners.back())] = sector.last;
      if (sector.label == Regions::rest)
        for (const std::uint32_t h : sector.corners) result_.corner[h] = sector.first;
      meet(sector.first);
      meet(sector.last);
    }
    while (around.size() > 1 && around.back() == around.front()) around.pop_back();
    for (std::size_t i = 2; i < around.size(); ++i)
      result_.fill.push_back({around[0], around[i - 1], around[i]});
  }

  const std::vector<Region>& regions_;
  const TriangleMesh& mesh_;
  const HalfEdges& edges_;
  const std::vector<std::uint32_t>& labels_;
  const SnapParams& params_;
  SnappedCorners result_;
  std::map<std::vector<std::uint32_t>, std::uint32_t> corners_;  ///< points of three planes

  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();  ///< of the vertex at hand
  bool closed_ = true;                                  ///< it is not on the rim
  std::vector<std::pair<std::vector<std::uint32_t>, std::uint32_t>> made_here_;
  std::vector<Plane> planes_;
};

}  // namespace

SnappedCorners snapped_corners(const std::vector<Region>& regions, const TriangleMesh& mesh,
                               const HalfEdges& edges, const std::vector<std::uint32_t>& labels,
                               const SnapParams& params) {
  return Snapper(regions, mesh, edges, labels, params).snapped();
}

}  // namespace planum
