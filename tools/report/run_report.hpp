#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "labeling/labels.hpp"
#include "labeling/objects/scene_object.hpp"
#include "labeling/rooms/rooms.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// What one stage of a run cost.
struct StageCost {
  std::string stage;
  double seconds = 0;         ///< when it last ran
  bool cached = false;        ///< it was fresh, so that this run did not repeat it
  double peak_memory_mb = 0;  ///< of the process, by the end of the stage
};

struct ScanFigures {
  std::size_t count = 0;
  std::size_t points = 0;
  std::size_t no_return = 0, not_finite = 0, out_of_range = 0;  ///< measurements that were dropped
};

struct RegistrationFigures {
  std::size_t pairs = 0;         ///< consecutive scans that matched
  std::size_t pairs_failed = 0;  ///< consecutive scans that kept their odometry
  double rms = 0;                ///< m, over the pairs
  std::size_t loops_accepted = 0, loops_rejected = 0;
  std::vector<std::vector<std::string>> components;  ///< ids of scans that hang together
};

/// Relative error per metre of the true path, means over segments of all lengths.
struct DriftFigures {
  double trans = 0;  ///< m/m
  double rot = 0;    ///< rad/m
  std::size_t segments = 0;
};

/// Errors of a trajectory against the truth, after alignment.
struct TrajectoryFigures {
  double ate_rmse = 0, ate_max = 0;   ///< m
  double rot_mean = 0, rot_max = 0;   ///< rad
  double rpe_trans = 0, rpe_rot = 0;  ///< m and rad, rmse from scan to scan
  std::optional<DriftFigures> drift;  ///< where the path is long enough
};

/// How far a loop edge is off the poses.
struct ResidualFigures {
  double translation = 0;  ///< m
  double rotation = 0;     ///< rad
  double deviations = 0;   ///< standard deviations
};

struct LoopFigures {
  std::uint32_t from = 0, to = 0;  ///< numbers of the scans
  bool accepted = false;
  std::string reason;             ///< why not
  ResidualFigures before, after;  ///< matched in order, relaxed
  std::optional<ResidualFigures> held_out;
};

/// How far apart the same walls are before and after a loop.
struct GapFigures {
  double median = 0, percentile_90 = 0;  ///< m
};

/// How good the map is, without a truth. NaN where there are too few points.
struct MapFigures {
  double entropy = 0;                             ///< nats
  double plane_thickness = 0;                     ///< m
  std::optional<GapFigures> walls_before, walls;  ///< where loops are seen from both sides
  std::vector<LoopFigures> loops;
};

struct MeshFigures {
  std::size_t vertices = 0, triangles = 0;
};

struct PolygonFigures {
  std::size_t count = 0, vertices = 0;
  double area = 0;           ///< m^2
  double inferred_area = 0;  ///< m^2, of filled laser shadows
  std::size_t rest_triangles = 0;
  double compression = 0;  ///< share of the mesh's triangles that the map does without, in [0, 1]
};

/// Everything report.json says; what is empty is left out of it.
struct RunReport {
  std::string version;
  int threads = 0;
  std::vector<StageCost> stages;
  std::optional<ScanFigures> scans;
  std::optional<RegistrationFigures> registration;
  std::optional<TrajectoryFigures> evaluation;           ///< of the result
  std::optional<TrajectoryFigures> odometry_evaluation;  ///< of the poses at the start
  std::optional<MapFigures> map_evaluation;
  std::optional<double> levelled;  ///< rad, how far the world was turned
  std::optional<MeshFigures> mesh;
  std::optional<PolygonFigures> polygons;
  const PolygonMap* map = nullptr;  ///< with labels: the areas by label
  const Labels* labels = nullptr;
  const RoomMap* rooms = nullptr;
  std::span<const SceneObject> objects = {};  ///< in `rooms`
};

/// Writes report.json (docs/formats-results.md).
void write_report_json(const std::filesystem::path& path, const RunReport& report);

}  // namespace planum
