#include "labeling/rooms/opening_edges.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace planum {
namespace {

constexpr double margin = 0.08;  // m, corners of an opening are left out: there both edges count

/// The mean of the values near their median, if there are enough.
std::optional<double> centre_of_peak(std::vector<double> values, double spread, int min_count) {
  if (values.size() < static_cast<std::size_t>(min_count)) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  double centre = *middle;
  for (int iteration = 0; iteration < 3; ++iteration) {
    double sum = 0, count = 0;
    for (const double v : values)
      if (std::abs(v - centre) <= spread) {
        sum += v;
        count += 1;
      }
    if (count < min_count) return std::nullopt;
    centre = sum / count;
  }
  return centre;
}

/// One edge: which coordinate it bounds, and on which side of it the opening lies.
struct Edge {
  bool vertical;   ///< a jamb (bounds u); else lintel or sill (bounds z)
  double inwards;  ///< +1: the opening lies at larger values, -1: at smaller ones
};

double refined_edge(const OpeningRectangle& rough, const OpeningEvidence& evidence,
                    const Edge& edge, double guess, const OpeningEdgeParams& params) {
  const auto value = [&](const OpeningSample& s) { return edge.vertical ? s.u : s.z; };
  const auto beside = [&](const OpeningSample& s) {  // the rest of the opening's extent
    return edge.vertical ? s.z > rough.bottom + margin && s.z < rough.top - margin
                         : s.u > rough.left + margin && s.u < rough.right - margin;
  };
  const auto near = [&](const std::vector<OpeningSample>& samples) {
    std::vector<double> values;
    for (const OpeningSample& s : samples)
      if (beside(s) && std::abs(value(s) - guess) < 2 * params.window) values.push_back(value(s));
    return values;
  };
  const std::vector<double> open = near(evidence.crossings), wall = near(evidence.hits);
  const EdgeInterval parted = edge.inwards > 0 ? parting_interval(wall, open, guess, params.window)
                                               : parting_interval(open, wall, guess, params.window);
  std::vector<double> reveal;
  for (const OpeningSample& s : evidence.reveal) {
    const double facing = edge.inwards * (edge.vertical ? s.normal_u : s.normal_z);
    if (beside(s) && facing > 0.6 && value(s) > parted.low - params.window &&
        value(s) < parted.high + params.window)
      reveal.push_back(value(s));
  }
  const auto peak =
      centre_of_peak(std::move(reveal), params.reveal_spread, params.min_reveal_points);
  const bool agrees = peak && *peak > parted.low - params.max_disagreement &&
                      *peak < parted.high + params.max_disagreement;
  return agrees ? *peak : parted.middle();
}

}  // namespace

EdgeInterval parting_interval(std::vector<double> below, std::vector<double> above, double guess,
                              double window) {
  std::sort(below.begin(), below.end());
  std::sort(above.begin(), above.end());
  std::vector<double> breaks{guess - window, guess + window};
  for (const std::vector<double>* values : {&below, &above})
    for (const double v : *values)
      if (std::abs(v - guess) < window) breaks.push_back(v);
  std::sort(breaks.begin(), breaks.end());
  const auto wrong_at = [&](double value) {
    return (below.end() - std::upper_bound(below.begin(), below.end(), value)) +
           (std::lower_bound(above.begin(), above.end(), value) - above.begin());
  };
  std::ptrdiff_t least = std::numeric_limits<std::ptrdiff_t>::max();
  double best_width = -1;
  EdgeInterval best{guess, guess};
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double width = breaks[i + 1] - breaks[i];
    const std::ptrdiff_t wrong = wrong_at(0.5 * (breaks[i] + breaks[i + 1]));
    if (wrong < least || (wrong == least && width > best_width)) {
      least = wrong;
      best_width = width;
      best = {breaks[i], breaks[i + 1]};
    }
  }
  return best;
}

OpeningRectangle refined(const OpeningRectangle& rough, const OpeningEvidence& evidence,
                         bool has_sill, const OpeningEdgeParams& params) {
  OpeningRectangle result = rough;
  result.left = refined_edge(rough, evidence, {true, 1}, rough.left, params);
  result.right = refined_edge(rough, evidence, {true, -1}, rough.right, params);
  result.top = refined_edge(rough, evidence, {false, -1}, rough.top, params);
  if (has_sill) result.bottom = refined_edge(rough, evidence, {false, 1}, rough.bottom, params);
  return result;
}

}  // namespace planum
