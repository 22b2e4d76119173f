#include "labeling/rooms/wall_hole.hpp"

#include <algorithm>

namespace planum {
namespace {

/// How much of the shorter of two intervals they share.
double overlap(double a0, double a1, double b0, double b1) {
  return (std::min(a1, b1) - std::max(a0, b0)) / std::min(a1 - a0, b1 - b0);
}

/// The same hole seen from the other side of the wall?
std::optional<double> thickness_between(const std::vector<WallFace>& faces, const FaceOpening& a,
                                        const FaceOpening& b, double max_thickness) {
  const WallFace& front = faces[a.face];
  const WallFace& back = faces[b.face];
  if (front.normal.dot(back.normal) > -0.98) return std::nullopt;
  const double thickness = -front.signed_distance(back.at(0.5 * (b.begin + b.end)));
  if (thickness < 0.01 || thickness > max_thickness) return std::nullopt;
  const double b0 = front.tangent().dot(back.at(b.end));
  const double b1 = front.tangent().dot(back.at(b.begin));
  if (overlap(a.begin, a.end, b0, b1) < 0.6 || overlap(a.bottom, a.top, b.bottom, b.top) < 0.6)
    return std::nullopt;
  return thickness;
}

/// The limits as both sides show them: what one side does not see the other may. Those of a side
/// that shows no frame count only if the other shows none either.
OpeningRectangle rough_rectangle(const WallHole& hole, const std::vector<WallFace>& faces) {
  const double half = 0.5 * (hole.front.end - hole.front.begin);
  OpeningRectangle result{-half, half, hole.front.bottom, hole.front.top};
  if (!hole.back || (hole.front.frame.complete() && !hole.back->frame.complete())) return result;
  const WallFace& back = faces[hole.back->face];
  const OpeningRectangle other{hole.u_of(back.at(hole.back->end)),
                               hole.u_of(back.at(hole.back->begin)), hole.back->bottom,
                               hole.back->top};
  if (hole.back->frame.complete() && !hole.front.frame.complete()) return other;
  return {std::min(result.left, other.left), std::max(result.right, other.right),
          std::min(result.bottom, other.bottom), std::max(result.top, other.top)};
}

}  // namespace

std::vector<WallHole> wall_holes(const std::vector<WallFace>& faces,
                                 const std::vector<FaceOpening>& holes, double max_thickness) {
  std::vector<WallHole> result;
  std::vector<std::uint8_t> used(holes.size(), 0);
  for (std::size_t i = 0; i < holes.size(); ++i) {
    if (used[i]) continue;
    WallHole hole;
    hole.front = holes[i];
    std::size_t partner = holes.size();
    for (std::size_t k = i + 1; k < holes.size(); ++k) {
      if (used[k]) continue;
      const auto thickness = thickness_between(faces, holes[i], holes[k], max_thickness);
      if (!thickness || (partner < holes.size() && *thickness >= hole.thickness)) continue;
      partner = k;
      hole.thickness = *thickness;
    }
    if (partner < holes.size()) {
      used[partner] = 1;
      hole.back = holes[partner];
    }
    const WallFace& face = faces[hole.front.face];
    hole.centre = face.at(0.5 * (holes[i].begin + holes[i].end));
    hole.tangent = face.tangent();
    hole.inwards = -face.normal;
    hole.frame = holes[i].frame;
    if (hole.back) {
      hole.frame.left = hole.frame.left || hole.back->frame.right;
      hole.frame.right = hole.frame.right || hole.back->frame.left;
      hole.frame.above = hole.frame.above || hole.back->frame.above;
    }
    hole.rectangle = rough_rectangle(hole, faces);
    result.push_back(hole);
  }
  return result;
}

}  // namespace planum
