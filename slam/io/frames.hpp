#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "slam/core/pose.hpp"

namespace planum {

/// Which step of 3DTK a frame stands for; its viewer colours scans by it.
enum class FrameKind { invalid = 0, icp = 1, inactive = 2, lum = 3 };

/// Where a scan was at one moment of the registration.
struct Frame {
  Pose world_from_scan = Pose::Identity();
  FrameKind kind = FrameKind::icp;
};

/// Writes `scanNNN.frames` of 3DTK: one line a frame, the last one is where the scan ends up. The
/// viewer wants as many frames for every scan.
void write_frames(const std::filesystem::path& path, std::span<const Frame> frames);

/// Reads the poses of such a file. Throws Error `path:line`.
std::vector<Frame> read_frames(const std::filesystem::path& path);

}  // namespace planum
