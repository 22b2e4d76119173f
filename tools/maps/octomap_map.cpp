#include "tools/maps/octomap_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/atomic_file.hpp"
#include "tools/maps/octree_file.hpp"
#include "tools/maps/octree_rays.hpp"

namespace planum {
namespace {

constexpr std::size_t scans_per_batch = 16;  // whose cells are in memory at the same time
constexpr std::size_t bricks_per_block = 64;
constexpr double cells_each_way = 32768;       // of an octree with 16 levels, from 0
constexpr double most_cells_of_a_ray = 99990;  // that OctoMap itself has room for

// Log odds as OctoMap has them: of a hit, of a miss, and where they end.
float log_odds(double probability) {
  return static_cast<float>(std::log(probability / (1 - probability)));
}
const float hit = log_odds(0.7), miss = log_odds(0.4);
const float least = log_odds(0.1192), most = log_odds(0.971);

void check(const std::filesystem::path& path, const Cloud& cloud,
           std::span<const Eigen::Vector3d> origins, double cell) {
  const auto fail = [&](const std::string& what) { throw Error(path.string() + ": " + what); };
  if (!(cell > 0) || !std::isfinite(cell)) fail(fmt::format("cells cannot have {} m", cell));
  if (cloud.points.empty()) fail("there are no points for it");
  if (origins.empty()) fail("it is not known where the scans were taken");
  if (cloud.scan.empty() && origins.size() > 1)
    fail(fmt::format("the points do not say which of {} scans they are of", origins.size()));
  if (!cloud.scan.empty() && cloud.scan.size() != cloud.points.size())
    fail(fmt::format("{} points with {} scan indices", cloud.points.size(), cloud.scan.size()));
  for (const std::uint32_t scan : cloud.scan)
    if (scan >= origins.size())
      fail(fmt::format("a point is of scan {} of {}", scan, origins.size()));

  Eigen::Array3d low = Eigen::Array3d::Constant(HUGE_VAL), high = -low;
  const auto add = [&](const Eigen::Array3d& p) {
    if (!p.isFinite().all()) fail("a point or an origin is not finite");
    low = low.min(p);
    high = high.max(p);
  };
  for (const Eigen::Vector3f& p : cloud.points) add(p.cast<double>().array());
  for (const Eigen::Vector3d& p : origins) add(p.array());
  const double reach = std::max(-low.minCoeff(), high.maxCoeff()) / cell;
  if (reach > cells_each_way - 1 || (high - low).sum() / cell > most_cells_of_a_ray)
    fail(
        fmt::format("the scans reach {:.1f} m from the origin of the world and OctoMap no farther "
                    "than {} cells, which are {:.1f} m: larger cells reach farther",
                    reach * cell, cells_each_way, cells_each_way * cell));
}

/// The points of each scan.
std::vector<std::vector<Eigen::Vector3f>> points_of_scans(const Cloud& cloud, std::size_t scans) {
  std::vector<std::vector<Eigen::Vector3f>> result(scans);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    result[cloud.scan.empty() ? 0 : cloud.scan[i]].push_back(cloud.points[i]);
  return result;
}

void add_seen(const SeenBrick& seen, BrickOdds& odds) {
  const auto add = [&](std::size_t cell, float change) {
    odds.log_odds[cell] = std::clamp(odds.log_odds[cell] + change, least, most);
  };
  seen.free.for_each([&](std::size_t cell) { add(cell, miss); });
  seen.occupied.for_each([&](std::size_t cell) { add(cell, hit); });
  odds.known.add_all(seen.free);
  odds.known.add_all(seen.occupied);
}

/// The bricks of all scans in the order of their paths. Each brick takes the scans one after
/// another: odds are clamped, so that their order matters.
class OddsOfScans {
 public:
  void add(const std::vector<std::vector<SeenBrick>>& scans) {
    std::vector<Visit> visits;
    for (std::size_t scan = 0; scan < scans.size(); ++scan)
      for (const SeenBrick& seen : scans[scan]) visits.push_back({path_of(seen.key), scan, &seen});
    std::sort(visits.begin(), visits.end(), [](const Visit& a, const Visit& b) {
      return a.path != b.path ? a.path < b.path : a.scan < b.scan;
    });
    std::vector<std::size_t> first_visit, brick;
    for (std::size_t i = 0; i < visits.size(); ++i) {
      if (i != 0 && visits[i].path == visits[i - 1].path) continue;
      first_visit.push_back(i);
      brick.push_back(place_of(visits[i].path));
    }
    first_visit.push_back(visits.size());
    parallel_for(brick.size(), bricks_per_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b)
        for (std::size_t i = first_visit[b]; i < first_visit[b + 1]; ++i)
          add_seen(*visits[i].seen, bricks_[brick[b]]);
    });
  }

  /// In the order of their paths.
  std::vector<const BrickOdds*> sorted() const {
    std::vector<const BrickOdds*> result;
    for (const BrickOdds& brick : bricks_) result.push_back(&brick);
    std::sort(result.begin(), result.end(),
              [](const BrickOdds* a, const BrickOdds* b) { return a->path < b->path; });
    return result;
  }

 private:
  struct Visit {
    std::uint64_t path;
    std::size_t scan;
    const SeenBrick* seen;
  };

  std::size_t place_of(std::uint64_t path) {
    const auto [found, is_new] = places_.try_emplace(path, bricks_.size());
    if (is_new) bricks_.push_back({.path = path, .known = {}, .log_odds = {}});
    return found->second;
  }

  std::unordered_map<std::uint64_t, std::size_t> places_;
  std::vector<BrickOdds> bricks_;
};

}  // namespace

void write_octomap(const std::filesystem::path& path, const Cloud& cloud,
                   std::span<const Eigen::Vector3d> scan_origins, const OctomapParams& params) {
  check(path, cloud, scan_origins, params.cell);
  const auto points = points_of_scans(cloud, scan_origins.size());
  OddsOfScans odds;
  for (std::size_t first = 0; first < points.size(); first += scans_per_batch) {
    std::vector<std::vector<SeenBrick>> scans(std::min(scans_per_batch, points.size() - first));
    parallel_for(scans.size(), 1, [&](std::size_t i, std::size_t) {
      scans[i] = seen_cells(points[first + i], scan_origins[first + i].cast<float>(), params.cell);
    });
    odds.add(scans);
  }
  const std::vector<const BrickOdds*> bricks = odds.sorted();
  std::filesystem::path full = path;
  write_file_atomically(full.replace_extension(".ot"), octree_file(bricks, params.cell));
  write_file_atomically(path, binary_octree_file(bricks, params.cell));
}

}  // namespace planum
