#include "slam/core/robust.hpp"

#include <algorithm>
#include <cstddef>

namespace planum {
namespace {

template <class Value>
double middle_of(std::span<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double upper_median(std::span<double> values) { return middle_of(values); }
double upper_median(std::span<float> values) { return middle_of(values); }

double biweight(double residual, double limit) {
  const double ratio = residual / limit;
  const double rest = 1 - ratio * ratio;
  return rest > 0 ? rest * rest : 0;
}

double biweight_limit(std::span<double> absolute_residuals) {
  return 4.685 * 1.4826 * upper_median(absolute_residuals);
}

}  // namespace planum
