#pragma once

#include <span>

namespace planum {

/// The value in the middle (of an even number the upper of the two); moves values about. There must
/// be one.
double upper_median(std::span<double> values);
double upper_median(std::span<float> values);

/// Tukey's biweight (Holland & Welsch 1977): 1 for no residual, falling smoothly to 0 at the limit.
double biweight(double residual, double limit);

/// The limit of the biweight for residuals (absolute values, moved about) of which most are
/// Gaussian: 4.685 standard deviations, these from the median.
double biweight_limit(std::span<double> absolute_residuals);

}  // namespace planum
