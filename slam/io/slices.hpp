#pragma once

#include <filesystem>

#include "slam/core/raw_scan.hpp"

namespace planum {

/// Reads a raw scan of a tilting 2D laser: header lines `# key value`, then one line a slice,
/// `time_s tilt_deg r0 r1 ...` with ranges in metres, which are returned as they are
/// (docs/formats.md has the keys). Throws Error `path:line` if a line has other than numbers, no
/// finite time and tilt, fewer than two ranges or not as many as the first one, and if there is no
/// slice.
RawScan read_slices(const std::filesystem::path& path);

/// Writes a raw scan; ranges and times come back exactly. All slices must have as many ranges.
void write_slices(const std::filesystem::path& path, const RawScan& scan);

/// Whether a text file looks like this format: it has a known header key, or its first line of
/// numbers is too long for a point. Throws Error if it cannot be read.
bool looks_like_slices(const std::filesystem::path& path);

}  // namespace planum
