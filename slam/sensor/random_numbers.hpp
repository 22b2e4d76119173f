#pragma once

#include <cstdint>
#include <initializer_list>

namespace planum {

/// A short stream of random numbers that depends on its key alone, e.g. {seed, scan, slice, beam}:
/// what is drawn for one beam does not depend on which thread does it, or on what was drawn before.
/// The numbers are the same with every standard library, unlike those of std::normal_distribution.
/// Generator: SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators,
/// 2014).
class RandomNumbers {
 public:
  explicit RandomNumbers(std::initializer_list<std::uint64_t> key);

  double uniform();                         ///< in [0, 1)
  double uniform(double low, double high);  ///< in [low, high)
  double normal();                          ///< mean 0, standard deviation 1 (Box and Muller 1958)

 private:
  std::uint64_t state_ = 0;
};

}  // namespace planum
