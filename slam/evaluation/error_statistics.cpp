#include "slam/evaluation/error_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace planum {

ErrorStatistics statistics(std::span<const double> errors) {
  ErrorStatistics result;
  if (errors.empty()) return result;
  result.count = errors.size();
  const double count = static_cast<double>(errors.size());
  double sum = 0;
  for (const double e : errors) {
    sum += e;
    result.sse += e * e;
  }
  result.mean = sum / count;
  result.rmse = std::sqrt(result.sse / count);
  double squared = 0;
  for (const double e : errors) squared += (e - result.mean) * (e - result.mean);
  result.std = std::sqrt(squared / count);
  std::vector<double> sorted(errors.begin(), errors.end());
  std::sort(sorted.begin(), sorted.end());
  result.min = sorted.front();
  result.max = sorted.back();
  result.median = quantile(sorted, 0.5);
  return result;
}

double quantile(std::span<const double> ascending, double share) {
  if (ascending.empty()) return 0;
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  const double rest = at - static_cast<double>(below);
  return (1 - rest) * ascending[below] + rest * ascending[above];
}

}  // namespace planum
