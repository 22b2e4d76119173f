#include "tools/workflow/results.hpp"

#include <unordered_map>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/input_file.hpp"
#include "slam/io/ply.hpp"
#include "tools/workflow/cache_layout.hpp"
#include "tools/workflow/stored_types.hpp"
#include "tools/workflow/unit_cache.hpp"

namespace planum {
namespace {

/// `load`, and how to get out of it if a stored file is missing or damaged.
template <class Load>
auto loader(const std::string& stage, Load load) {
  return [stage, load] {
    try {
      return load();
    } catch (const Error& error) {
      throw Error(
          fmt::format("the stored result of {} cannot be read ({}); redo it with "
                      "--from {} --force",
                      stage, error.what(), stage));
    }
  };
}

template <class T>
std::function<T()> archive_loader(const CacheLayout& layout, const std::string& stage) {
  const auto file = layout.result(stage);
  return loader(stage, [file] { return unarchived<T>(read_file(file)); });
}

/// The clouds are read from the units, the rest from the result file.
Imported load_imported(const CacheLayout& layout) {
  Imported imported = unarchived<Imported>(read_file(layout.result("import")));
  UnitCache units(layout.units("import"));
  for (std::size_t i = 0; i < imported.scans.size(); ++i) {
    Scan& scan = imported.scans[i];
    const auto bytes = units.read(scan.id);
    if (bytes) scan.cloud = unarchived<ImportedUnit>(*bytes).cloud;
    if (digest_of(scan.cloud) != imported.digests[i]) {
      throw Error("the points of " + scan.id + " are not those of the last import");
    }
  }
  return imported;
}

/// The file has the numbers of the scans.
Cloud load_cloud(const CacheLayout& layout) {
  return with_scan_positions(read_ply_cloud(layout.output / "cloud.ply"),
                             unarchived<World>(read_file(layout.result("cloud"))));
}

}  // namespace

Results::Results(const CacheLayout& layout, const MatchingScanParams& matching)
    : imported(loader("import", [layout] { return load_imported(layout); })),
      registered(archive_loader<SequenceMatch>(layout, "register")),
      relaxed(archive_loader<Relaxed>(layout, "relax")),
      world(archive_loader<World>(layout, "cloud")),
      cloud(loader("cloud", [layout] { return load_cloud(layout); })),
      mesh(loader("mesh", [layout] { return read_ply_mesh(layout.output / "mesh.ply"); })),
      polygons(archive_loader<PolygonMap>(layout, "polygons")),
      labelled(archive_loader<Labelled>(layout, "labels")),
      matching_(matching) {}

const std::vector<MatchingScan>& Results::matching_scans(const Progress& progress) {
  if (matching_scans_) return *matching_scans_;
  const std::vector<Scan>& scans = imported.get().scans;
  std::vector<std::optional<MatchingScan>> ready(scans.size());
  const auto make_ready = [&](std::size_t i, std::size_t) {
    ready[i] = matching_scan(scans[i].cloud, matching_);
  };
  parallel_for(scans.size(), 1, make_ready, progress);
  matching_scans_.emplace();
  for (auto& scan : ready) matching_scans_->push_back(std::move(*scan));
  return *matching_scans_;
}

Digest digest_of(const Cloud& cloud) {
  return Hasher().list(cloud.points).list(cloud.intensity).result();
}

template <class T>
void write_result(const std::filesystem::path& file, const T& result) {
  write_file_atomically(file, archived(result));
}

template void write_result(const std::filesystem::path&, const Imported&);
template void write_result(const std::filesystem::path&, const SequenceMatch&);
template void write_result(const std::filesystem::path&, const Relaxed&);
template void write_result(const std::filesystem::path&, const World&);
template void write_result(const std::filesystem::path&, const PolygonMap&);
template void write_result(const std::filesystem::path&, const Labelled&);

std::vector<Eigen::Vector3d> scan_origins(const World& world) {
  std::vector<Eigen::Vector3d> origins;
  for (const Pose& pose : world.poses) origins.push_back(pose.translation());
  return origins;
}

Cloud with_scan_numbers(Cloud cloud, const World& world) {
  for (std::uint32_t& scan : cloud.scan) scan = world.numbers[scan];
  return cloud;
}

Cloud with_scan_positions(Cloud cloud, const World& world) {
  std::unordered_map<std::uint32_t, std::uint32_t> position;
  for (std::uint32_t i = 0; i < world.numbers.size(); ++i) position[world.numbers[i]] = i;
  for (std::uint32_t& scan : cloud.scan) {
    const auto found = position.find(scan);
    if (found == position.end())
      throw Error(fmt::format("cloud.ply: there is no scan {}, which a point is of", scan));
    scan = found->second;
  }
  return cloud;
}

}  // namespace planum
