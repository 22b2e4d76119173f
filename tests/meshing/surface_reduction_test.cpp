#include "meshing/surface_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "slam/core/pose.hpp"

namespace planum {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

struct Surface {
  std::vector<Eigen::Vector3d> points;
  std::vector<Triangle> triangles;
};

/// A grid of rows x columns vertices laid onto a shape; `closed`: the last column joins the first.
template <class Shape>
Surface grid(std::uint32_t rows, std::uint32_t columns, bool closed, const Shape& shape) {
  Surface result;
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) result.points.push_back(shape(r, c));
  const std::uint32_t steps = closed ? columns : columns - 1;
  for (std::uint32_t r = 0; r + 1 < rows; ++r)
    for (std::uint32_t c = 0; c < steps; ++c) {
      const std::uint32_t d = (c + 1) % columns;
      const std::uint32_t v00 = r * columns + c, v01 = r * columns + d, v10 = v00 + columns,
                          v11 = v01 + columns;
      result.triangles.push_back({v00, v01, v11});
      result.triangles.push_back({v00, v11, v10});
    }
  return result;
}

Surface column(double noise) {
  std::mt19937 random(4);
  std::normal_distribution<double> off(0, 1);
  return grid(50, 26, true, [&](std::uint32_t r, std::uint32_t c) {
    const double angle = 2 * pi * c / 26, radius = 0.2 + noise * off(random);
    return Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.05 * r);
  });
}

std::vector<Triangle> reduced(const Surface& surface, double max_error) {
  return reduced_surface(surface.points, surface.triangles,
                         std::vector<bool>(surface.points.size(), false), max_error);
}

/// Edges with the number of triangles that run along them one way less the other.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> rim(const std::vector<Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  std::erase_if(balance, [](const auto& edge) { return edge.second == 0; });
  return balance;
}

std::size_t most_triangles_at_an_edge(const std::vector<Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> count;
  std::size_t most = 0;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      most = std::max(most, ++count[std::minmax(t[k], t[(k + 1) % 3])]);
  return most;
}

double area(const Surface& surface, const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles)
    sum += (surface.points[b] - surface.points[a])
               .cross(surface.points[c] - surface.points[a])
               .norm() /
           2;
  return sum;
}

double to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double t = std::clamp((b - a).dot(p - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + t * (b - a) - p).norm();
}

/// m, from a point to the nearest place on the triangles: by barycentric coordinates of its foot.
double distance(const Surface& surface, const std::vector<Triangle>& triangles,
                const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : triangles) {
    const Eigen::Vector3d &a = surface.points[i], &b = surface.points[j], &c = surface.points[k];
    Eigen::Matrix<double, 3, 2> sides;
    sides << b - a, c - a;
    const Eigen::Vector2d foot =
        (sides.transpose() * sides).inverse() * (sides.transpose() * (p - a));
    if (foot.minCoeff() >= 0 && foot.sum() <= 1)
      least = std::min(least, (a + sides * foot - p).norm());
    least = std::min({least, to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
  }
  return least;
}

TEST(SurfaceReduction, AFlatGridKeepsItsRimAndItsArea) {
  const Surface plane = grid(20, 30, false, [](std::uint32_t r, std::uint32_t c) {
    return Eigen::Vector3d(0.05 * c, 0.05 * r, 1);
  });
  const auto few = reduced(plane, 1e-6);
  std::set<std::uint32_t> used;
  for (const Triangle& t : few) used.insert(t.begin(), t.end());
  EXPECT_LT(used.size(), 96u + 20);  // the rim has 96 vertices
  EXPECT_EQ(rim(few), rim(plane.triangles));
  EXPECT_NEAR(area(plane, few), area(plane, plane.triangles), 1e-9);
}

TEST(SurfaceReduction, AColumnKeepsFewTrianglesWithinTheError) {
  for (const double noise : {0.0, 0.001}) {
    const Surface surface = column(noise);
    for (const double max_error : {0.005, 0.01, 0.02}) {
      const auto few = reduced(surface, max_error);
      EXPECT_LT(few.size(), surface.triangles.size() / 4) << noise << " " << max_error;
      EXPECT_EQ(rim(few), rim(surface.triangles));
      EXPECT_EQ(most_triangles_at_an_edge(few), 2u);
      for (std::size_t i = 0; i < surface.points.size(); ++i)
        EXPECT_LE(distance(surface, few, surface.points[i]), max_error + 1e-9);
    }
  }
}

TEST(SurfaceReduction, AClosedSurfaceStaysClosedAndWhole) {
  // A torus: V - E + F is 0.
  Surface torus = grid(40, 60, true, [](std::uint32_t r, std::uint32_t c) {
    const double across = 2 * pi * r / 40, along = 2 * pi * c / 60;
    const double radius = 1 + 0.3 * std::cos(across);
    return Eigen::Vector3d(radius * std::cos(along), radius * std::sin(along),
                           0.3 * std::sin(across));
  });
  for (std::uint32_t c = 0; c < 60; ++c) {  // the last row joins the first
    const std::uint32_t d = (c + 1) % 60, last = 39 * 60;
    torus.triangles.push_back({last + c, last + d, d});
    torus.triangles.push_back({last + c, d, c});
  }
  ASSERT_TRUE(rim(torus.triangles).empty());
  const auto few = reduced(torus, 0.02);
  EXPECT_LT(few.size(), torus.triangles.size() / 3);
  EXPECT_TRUE(rim(few).empty());
  EXPECT_EQ(most_triangles_at_an_edge(few), 2u);
  std::set<std::uint32_t> vertices;
  for (const Triangle& t : few) vertices.insert(t.begin(), t.end());
  EXPECT_EQ(2 * vertices.size(), few.size());  // V - 3/2 F + F = 0
}

TEST(SurfaceReduction, FixedVerticesStay) {
  const Surface surface = column(0);
  std::vector<bool> fixed(surface.points.size(), false);
  std::mt19937 random(2);
  std::set<std::uint32_t> wanted;
  for (int k = 0; k < 40; ++k) wanted.insert(static_cast<std::uint32_t>(random() % fixed.size()));
  for (const std::uint32_t v : wanted) fixed[v] = true;
  const auto few = reduced_surface(surface.points, surface.triangles, fixed, 0.02);
  std::set<std::uint32_t> used;
  for (const Triangle& t : few) used.insert(t.begin(), t.end());
  EXPECT_TRUE(std::includes(used.begin(), used.end(), wanted.begin(), wanted.end()));
}

TEST(SurfaceReduction, ThinFoldsAreNotTurnedOver) {
  // A strip that goes out, bends sharply, and comes back 2 cm above itself.
  const Surface strip = grid(10, 41, false, [](std::uint32_t r, std::uint32_t c) {
    const double s = 0.05 * c;
    return c <= 20 ? Eigen::Vector3d(s, 0.05 * r, 0) : Eigen::Vector3d(2 - s, 0.05 * r, 0.02);
  });
  const auto few = reduced(strip, 0.03);
  EXPECT_EQ(rim(few), rim(strip.triangles));
  double lower = 0, upper = 0;
  for (const auto& [a, b, c] : few) {
    const Eigen::Vector3d normal =
        (strip.points[b] - strip.points[a]).cross(strip.points[c] - strip.points[a]) / 2;
    (normal.z() > 0 ? lower : upper) += normal.z();
  }
  EXPECT_NEAR(lower, 0.45, 0.03);
  EXPECT_NEAR(upper, -0.45, 0.03);
}

TEST(SurfaceReduction, WithoutAnErrorNothingChanges) {
  const Surface surface = column(0.001);
  EXPECT_EQ(reduced(surface, 0), surface.triangles);
  EXPECT_TRUE(reduced({}, 0.01).empty());
  // Edges with three triangles are left alone.
  const Surface fins{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                     {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  EXPECT_EQ(reduced(fins, 10), fins.triangles);
}

}  // namespace
}  // namespace planum
