#include "meshing/simplification.hpp"

#include <algorithm>
#include <utility>

#include "meshing/plane_geometry.hpp"

namespace planum {
namespace {

/// The vertex strictly between two (wrapping around) that is farthest from the segment of the two
/// in one of the lines, and the square of how far.
std::pair<std::size_t, double> farthest(std::span<const Polyline> lines, std::size_t from,
                                        std::size_t to) {
  const std::size_t count = lines.front().size();
  std::pair<std::size_t, double> worst{from, -1};
  for (std::size_t i = from + 1; i < to; ++i)
    for (const Polyline& line : lines) {
      const double off =
          squared_distance_to_segment(line[i % count], line[from % count], line[to % count]);
      if (off > worst.second) worst = {i, off};
    }
  return worst;
}

/// Marks what to keep between two kept vertices.
void keep_between(std::span<const Polyline> lines, std::size_t from, std::size_t to,
                  double max_error, std::vector<bool>& keep) {
  const std::size_t count = lines.front().size();
  std::vector<std::pair<std::size_t, std::size_t>> open{{from, to}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    const auto [split, off] = farthest(lines, a, b);
    if (off <= max_error * max_error) continue;
    keep[split % count] = true;
    open.emplace_back(a, split);
    open.emplace_back(split, b);
  }
}

std::size_t farthest_from(const Polyline& line, std::size_t from) {
  std::size_t best = from;
  for (std::size_t i = 0; i < line.size(); ++i)
    if ((line[i] - line[from]).squaredNorm() > (line[best] - line[from]).squaredNorm()) best = i;
  return best;
}

}  // namespace

std::vector<std::size_t> kept_vertices(std::span<const Polyline> lines, double max_error,
                                       bool closed) {
  if (lines.empty() || lines.front().empty()) return {};
  const Polyline& line = lines.front();
  std::vector<bool> keep(line.size(), false);
  if (closed) {
    const std::size_t a = farthest_from(line, 0), b = farthest_from(line, a);
    const auto [first, second] = std::minmax(a, b);
    keep[first] = keep[second] = true;
    keep_between(lines, first, second, max_error, keep);
    keep_between(lines, second, first + line.size(), max_error, keep);
  } else {
    keep.front() = keep.back() = true;
    keep_between(lines, 0, line.size() - 1, max_error, keep);
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i]) kept.push_back(i);
  return kept;
}

Polyline simplified(const Polyline& line, double max_error, bool closed) {
  Polyline result;
  for (const std::size_t i : kept_vertices({&line, 1}, max_error, closed))
    result.push_back(line[i]);
  return result;
}

}  // namespace planum
