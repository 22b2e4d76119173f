#include "meshing/region_seeds.hpp"

#include <algorithm>
#include <cmath>

#include "slam/core/parallel.hpp"

namespace planum {
namespace {

/// Area-weighted sums over triangles.
struct Sum {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  double area = 0;

  Sum& operator+=(const Sum& other) {
    normal += other.normal;
    centroid += other.centroid;
    area += other.area;
    return *this;
  }
};

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// For each vertex, the sum of what its triangles hold.
std::vector<Sum> gathered(const Triangles& triangles, std::size_t vertices,
                          const std::vector<Sum>& of_face) {
  std::vector<Sum> of_vertex(vertices);
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (const std::uint32_t v : triangles[f]) of_vertex[v] += of_face[f];
  return of_vertex;
}

/// For each triangle, the sum of what its vertices hold.
std::vector<Sum> spread_out(const Triangles& triangles, const std::vector<Sum>& of_vertex) {
  std::vector<Sum> of_face(triangles.size());
  parallel_for(triangles.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      for (const std::uint32_t v : triangles[f]) of_face[f] += of_vertex[v];
  });
  return of_face;
}

Eigen::Vector3d unit_or_zero(const Eigen::Vector3d& v) {
  const double length = v.norm();
  return length > 0 ? Eigen::Vector3d(v / length) : Eigen::Vector3d::Zero();
}

}  // namespace

SmoothedFaces smoothed_faces(const HalfEdges& edges, const FaceGeometry& faces, double exact_area) {
  const std::size_t count = edges.triangles.size();
  std::vector<Sum> own(count);
  for (std::size_t f = 0; f < count; ++f)
    own[f] = {faces.area[f] * faces.normal[f], faces.area[f] * faces.centroid[f], faces.area[f]};
  const std::size_t vertices = edges.source.size();
  const auto ring = spread_out(edges.triangles, gathered(edges.triangles, vertices, own));
  const auto rings = spread_out(edges.triangles, gathered(edges.triangles, vertices, ring));
  SmoothedFaces smooth;
  smooth.normal.resize(count);
  smooth.broad_normal.resize(count);
  smooth.broad_centre.resize(count);
  smooth.spread.resize(count);
  parallel_for(count, 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      if (faces.area[f] > exact_area) {
        smooth.normal[f] = smooth.broad_normal[f] = faces.normal[f];
        smooth.broad_centre[f] = faces.centroid[f];
        smooth.spread[f] = 0;
        continue;
      }
      smooth.normal[f] = unit_or_zero(ring[f].normal);
      smooth.broad_normal[f] = unit_or_zero(rings[f].normal);
      const bool has_area = rings[f].area > 0;
      smooth.broad_centre[f] =
          has_area ? Eigen::Vector3d(rings[f].centroid / rings[f].area) : faces.centroid[f];
      // |mean normal| = 1 - s^2 / 2 for small angles of rms s.
      const double length = has_area ? rings[f].normal.norm() / rings[f].area : 0;
      smooth.spread[f] = std::sqrt(std::max(0.0, 2 * (1 - length)));
    }
  });
  return smooth;
}

std::vector<std::uint32_t> seeds(const SmoothedFaces& smooth, double max_spread) {
  constexpr std::size_t buckets = 1024;
  const auto bucket = [&](std::size_t f) {
    return std::min(buckets - 1, static_cast<std::size_t>(smooth.spread[f] / max_spread * buckets));
  };
  const auto is_seed = [&](std::size_t f) {
    return smooth.spread[f] < max_spread && !smooth.broad_normal[f].isZero();
  };
  std::vector<std::uint32_t> begin(buckets + 1, 0);
  for (std::size_t f = 0; f < smooth.spread.size(); ++f)
    if (is_seed(f)) ++begin[bucket(f) + 1];
  for (std::size_t b = 0; b < buckets; ++b) begin[b + 1] += begin[b];
  std::vector<std::uint32_t> order(begin[buckets]);
  for (std::size_t f = 0; f < smooth.spread.size(); ++f)
    if (is_seed(f)) order[begin[bucket(f)]++] = static_cast<std::uint32_t>(f);
  return order;
}

}  // namespace planum
