#include "meshing/scan_indices.hpp"

#include <algorithm>

#include "slam/core/error.hpp"

namespace planum {

void check_scan_indices(const Cloud& cloud, std::size_t scan_origins, const std::string& step) {
  if (cloud.scan.empty()) {
    if (scan_origins > 1)
      throw Error(step + ": " + std::to_string(scan_origins) +
                  " scan origins, but the points do not say which scan they are from");
    return;
  }
  if (cloud.scan.size() != cloud.points.size())
    throw Error(step + ": " + std::to_string(cloud.points.size()) + " points, but " +
                std::to_string(cloud.scan.size()) + " scan indices");
  const auto highest = std::max_element(cloud.scan.begin(), cloud.scan.end());
  if (*highest >= scan_origins)
    throw Error(step + ": point " + std::to_string(highest - cloud.scan.begin()) +
                " is from scan " + std::to_string(*highest) + ", but there are only " +
                std::to_string(scan_origins) + " scan origins");
}

}  // namespace planum
