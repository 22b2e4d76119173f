#include "labeling/plan/grid_morphology.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace planum {
namespace {

constexpr double far = 1e12;  // squared cells, larger than any grid

/// Lower envelope of parabolas: out[q] = min over p of (q - p)^2 + in[p].
class DistanceLine {
 public:
  void transform(std::vector<double>& values) {
    const int n = static_cast<int>(values.size());
    apex_.assign(values.size(), 0);
    from_.assign(values.size() + 1, 0);
    int k = 0;
    from_[0] = -far;
    from_[1] = far;
    for (int q = 1; q < n; ++q) {
      double s = meeting(values, q, apex_[at(k)]);
      while (s <= from_[at(k)]) s = meeting(values, q, apex_[at(--k)]);
      apex_[at(++k)] = q;
      from_[at(k)] = s;
      from_[at(k + 1)] = far;
    }
    result_.resize(values.size());
    k = 0;
    for (int q = 0; q < n; ++q) {
      while (from_[at(k + 1)] < q) ++k;
      const double d = q - apex_[at(k)];
      result_[at(q)] = d * d + values[at(apex_[at(k)])];
    }
    values.swap(result_);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  static double meeting(const std::vector<double>& f, int q, int p) {
    return ((f[at(q)] + double(q) * q) - (f[at(p)] + double(p) * p)) / (2.0 * q - 2.0 * p);
  }
  std::vector<int> apex_;
  std::vector<double> from_, result_;
};

CellMask inverted(const CellMask& mask) {
  CellMask result(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) result[i] = !mask[i];
  return result;
}

/// Calls visit(neighbour) for the cells left, right, below and above.
template <typename Visit>
void for_each_neighbour(std::size_t cell, int columns, int rows, Visit&& visit) {
  const auto width = static_cast<std::size_t>(columns);
  const std::size_t column = cell % width, row = cell / width;
  if (column > 0) visit(cell - 1);
  if (column + 1 < width) visit(cell + 1);
  if (row > 0) visit(cell - width);
  if (row + 1 < static_cast<std::size_t>(rows)) visit(cell + width);
}

}  // namespace

std::vector<float> distance_to_unset(const CellMask& mask, int columns, int rows) {
  const auto width = static_cast<std::size_t>(columns), height = static_cast<std::size_t>(rows);
  std::vector<float> result(mask.size());
  DistanceLine line;
  // One cell of 0 around the grid stands for what lies beyond the border.
  std::vector<double> values(height + 2);
  std::vector<float> squared(mask.size());
  for (std::size_t x = 0; x < width; ++x) {
    values.assign(height + 2, 0);
    for (std::size_t y = 0; y < height; ++y) values[y + 1] = mask[y * width + x] ? far : 0;
    line.transform(values);
    for (std::size_t y = 0; y < height; ++y)
      squared[y * width + x] = static_cast<float>(values[y + 1]);
  }
  for (std::size_t y = 0; y < height; ++y) {
    values.assign(width + 2, 0);
    for (std::size_t x = 0; x < width; ++x) values[x + 1] = double{squared[y * width + x]};
    line.transform(values);
    for (std::size_t x = 0; x < width; ++x)
      result[y * width + x] = static_cast<float>(std::sqrt(values[x + 1]));
  }
  return result;
}

CellMask dilated(const CellMask& mask, int columns, int rows, double radius) {
  // Where nothing is set the border of the inverse would count as set: pad by the radius.
  const int pad = static_cast<int>(std::ceil(radius)) + 1;
  const int wide = columns + 2 * pad, high = rows + 2 * pad;
  CellMask unset(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high), 1);
  const auto padded = [&](int x, int y) {
    return static_cast<std::size_t>(y + pad) * static_cast<std::size_t>(wide) +
           static_cast<std::size_t>(x + pad);
  };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      unset[padded(x, y)] = !mask[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                                  static_cast<std::size_t>(x)];
  const std::vector<float> distance = distance_to_unset(unset, wide, high);
  CellMask result(mask.size());
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      result[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
             static_cast<std::size_t>(x)] = double{distance[padded(x, y)]} <= radius;
  return result;
}

CellMask closed(const CellMask& mask, int columns, int rows, double radius) {
  const CellMask background = inverted(dilated(mask, columns, rows, radius));
  return inverted(dilated(background, columns, rows, radius));
}

CellComponents connected_components(const CellMask& mask, int columns, int rows) {
  CellComponents result;
  result.of_cell.assign(mask.size(), -1);
  std::vector<std::size_t> stack;
  for (std::size_t seed = 0; seed < mask.size(); ++seed) {
    if (!mask[seed] || result.of_cell[seed] >= 0) continue;
    const auto id = static_cast<std::int32_t>(result.sizes.size());
    result.sizes.push_back(0);
    result.of_cell[seed] = id;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const std::size_t cell = stack.back();
      stack.pop_back();
      ++result.sizes.back();
      for_each_neighbour(cell, columns, rows, [&](std::size_t next) {
        if (!mask[next] || result.of_cell[next] >= 0) return;
        result.of_cell[next] = id;
        stack.push_back(next);
      });
    }
  }
  return result;
}

void spread_labels(std::vector<std::int32_t>& labels, const CellMask& mask, int columns, int rows,
                   int max_steps) {
  std::vector<std::size_t> front, next_front;
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (labels[i] >= 0) front.push_back(i);
  std::vector<std::int32_t> arriving(labels.size(), -1);
  for (int step = 0; step < max_steps && !front.empty(); ++step) {
    next_front.clear();
    for (const std::size_t cell : front)
      for_each_neighbour(cell, columns, rows, [&](std::size_t next) {
        if (!mask[next] || labels[next] >= 0) return;
        if (arriving[next] < 0) next_front.push_back(next);
        if (arriving[next] < 0 || labels[cell] < arriving[next]) arriving[next] = labels[cell];
      });
    for (const std::size_t cell : next_front) labels[cell] = arriving[cell];
    front.swap(next_front);
  }
}

}  // namespace planum
