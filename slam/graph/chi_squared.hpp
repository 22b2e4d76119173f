#pragma once

#include <cmath>

namespace planum {

/// The chi-squared value that is `deviations` of a normal variable above the median, for so many
/// degrees of freedom (Wilson & Hilferty 1931).
inline double chi_squared(double deviations, int freedom) {
  const double a = 2.0 / (9.0 * freedom);
  return freedom * std::pow(1 - a + deviations * std::sqrt(a), 3);
}

}  // namespace planum
