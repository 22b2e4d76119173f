#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "meshing/polygon_map.hpp"
#include "slam/core/cloud.hpp"
#include "slam/core/progress.hpp"
#include "slam/graph/pose_graph.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/registration/sequence.hpp"
#include "slam/sensor/range_limits.hpp"
#include "tools/workflow/cache_layout.hpp"
#include "tools/workflow/digest.hpp"
#include "tools/workflow/labelled.hpp"

namespace planum {

/// A result of a stage: in memory once made, else read from disk when first asked for.
template <class T>
class Held {
 public:
  explicit Held(std::function<T()> load) : load_(std::move(load)) {}
  void set(T value) { value_ = std::move(value); }
  void forget() { value_.reset(); }
  const T& get() {
    if (!value_) value_ = load_();
    return *value_;
  }

 private:
  std::optional<T> value_;
  std::function<T()> load_;
};

/// What `import` makes: scans in the scanner's frame, at the poses that came with them.
struct Imported {
  std::vector<Scan> scans;
  std::vector<ImportCounts> counts;  ///< for each scan
  std::vector<Digest> digests;       ///< of the clouds
  std::string pose_source;           ///< "pose files", the name of a file, or "none"
};

Digest digest_of(const Cloud& cloud);

/// One imported scan as its unit keeps it.
struct ImportedUnit {
  Cloud cloud;
  ImportCounts counts;
};

/// What `relax` makes: all edges, and the poses that suit them best.
struct Relaxed {
  PoseGraph graph;
  double residual_before = 0, residual_after = 0;  ///< m, rms over all links; 0: not relaxed
  int iterations = 0;
  bool converged = true;
  std::vector<std::vector<std::size_t>>
      components;  ///< scans that hang together, the largest first
};

/// Where the scans are in the world of all results; part of what `cloud` makes.
struct World {
  std::vector<std::uint32_t> numbers;        ///< of the scans, ascending or not, each once
  std::vector<Pose> odometry;                ///< world_from_scan, as the poses came
  std::vector<Pose> poses;                   ///< world_from_scan, as they are now
  std::vector<std::uint8_t> is_mapped;       ///< for each scan; others hang on nothing
  Pose world_from_input = Pose::Identity();  ///< how the world was turned to be level
  double up_confidence = 0;                  ///< in [0, 1]; 0: not levelled
};

/// The results of all stages of one run.
class Results {
 public:
  Results(const CacheLayout& layout, const MatchingScanParams& matching);

  Held<Imported> imported;
  Held<SequenceMatch> registered;
  Held<Relaxed> relaxed;
  Held<World> world;
  Held<Cloud> cloud;
  Held<TriangleMesh> mesh;
  Held<PolygonMap> polygons;
  Held<Labelled> labelled;

  /// The imported scans made ready for matching; never stored.
  const std::vector<MatchingScan>& matching_scans(const Progress& progress = {});

 private:
  MatchingScanParams matching_;
  std::optional<std::vector<MatchingScan>> matching_scans_;
};

/// Writes a result as Results will read it.
template <class T>
void write_result(const std::filesystem::path& file, const T& result);

/// Where the scans of a world were taken, as functions of clouds want it.
std::vector<Eigen::Vector3d> scan_origins(const World& world);

/// A cloud whose points know their scans by position, as one that people and programs join with
/// trajectory.tum: by number. Nothing changes where scans are numbered from 0 without gaps.
Cloud with_scan_numbers(Cloud cloud, const World& world);

/// The way back.
Cloud with_scan_positions(Cloud cloud, const World& world);

}  // namespace planum
