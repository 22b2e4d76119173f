#include "labeling/plan/plan_ring.hpp"

#include <algorithm>
#include <cmath>

#include "meshing/plane_geometry.hpp"

namespace planum {

double ring_area(const std::vector<Eigen::Vector2d>& ring) {
  double doubled = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& a = ring[i];
    const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
    doubled += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * doubled;
}

bool ring_contains(const std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& a = ring[i];
    const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y()))
      inside = !inside;
  }
  return inside;
}

bool rings_contain(const std::vector<std::vector<Eigen::Vector2d>>& rings,
                   const Eigen::Vector2d& p) {
  bool inside = false;
  for (const Ring2d& ring : rings) inside ^= is_inside(ring, p);
  return inside;
}

std::vector<Eigen::Vector2d> without_slits(std::vector<Eigen::Vector2d> ring, double width,
                                           int max_steps) {
  constexpr double min_detour = 4;  // times the way across: shorter ones are corners
  const auto drop_one = [&] {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      std::vector<Eigen::Vector2d> stretch = {ring[i]};
      double length = 0;
      for (std::size_t s = 1; s <= static_cast<std::size_t>(max_steps) && s + 3 < ring.size();
           ++s) {
        stretch.push_back(ring[(i + s) % ring.size()]);
        length += (stretch[s] - stretch[s - 1]).norm();
        const double across = (stretch.back() - stretch.front()).norm();
        if (s < 2 || across > width || length < std::max(min_detour * across, 2 * width) ||
            std::abs(ring_area(stretch)) > width * length / 2)
          continue;
        std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(i), ring.end());
        ring.erase(ring.begin() + 1, ring.begin() + static_cast<std::ptrdiff_t>(s));
        return true;
      }
    }
    return false;
  };
  while (drop_one()) {
  }
  return ring;
}

}  // namespace planum
