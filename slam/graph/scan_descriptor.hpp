#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "slam/registration/matching_scan.hpp"

namespace planum {

/// What a place looks like, wherever in it the scanner stood and whichever way it faced: how often
/// surfaces lie across from each other, beside each other, above the floor and below the ceiling at
/// which distances. Parts of unit length; scans of one place are near each other (Euclidean).
struct ScanDescriptor {
  static constexpr std::size_t across = 40;   ///< walls that face each other, 0.2 m a bin
  static constexpr std::size_t beside = 24;   ///< parallel walls that face alike, 0.2 m a bin
  static constexpr std::size_t heights = 60;  ///< of what faces up, and of what faces down, 0.1 m
  static constexpr std::size_t ranges = 20;  ///< of any two surfaces, 0.5 m, in 3 classes of angles
  static constexpr std::size_t size = across + beside + 2 * heights + 3 * ranges;

  std::array<float, size> values = {};
};

struct ScanDescriptorParams {
  std::size_t samples = 500;  ///< points; all pairs of them are looked at
};

/// Needs the scanner's z upward within 20 degrees. Zero for a scan without surfaces. Throws Error
/// if a parameter is out of range.
ScanDescriptor scan_descriptor(const MatchingScan& scan, const ScanDescriptorParams& params = {});

/// Another scan, and how far its descriptor is.
struct SimilarScan {
  std::size_t scan = 0;
  double distance = 0;
};

/// For each descriptor the `count` nearest others, nearest first (FLANN's exact search tree: Muja &
/// Lowe, PAMI 2014).
std::vector<std::vector<SimilarScan>> similar_scans(std::span<const ScanDescriptor> descriptors,
                                                    std::size_t count);

}  // namespace planum
