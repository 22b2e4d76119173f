#include "slam/sensor/random_numbers.hpp"

#include <cmath>

#include "slam/core/hash.hpp"
#include "slam/core/pose.hpp"

namespace planum {
namespace {

constexpr std::uint64_t golden_gamma = 0x9e3779b97f4a7c15;

}  // namespace

RandomNumbers::RandomNumbers(std::initializer_list<std::uint64_t> key) {
  for (const std::uint64_t part : key) state_ = mixed(state_ + golden_gamma + mixed(part));
}

double RandomNumbers::uniform() {
  state_ += golden_gamma;
  return static_cast<double>(mixed(state_) >> 11) * 0x1p-53;
}

double RandomNumbers::uniform(double low, double high) { return low + (high - low) * uniform(); }

double RandomNumbers::normal() {
  // 1 - u lies in (0, 1]: its logarithm is finite.
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(2 * pi * uniform());
}

}  // namespace planum
