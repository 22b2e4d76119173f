#include "tools/report/run_report.hpp"

#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"
#include "slam/io/atomic_file.hpp"
#include "tools/maps/object_json.hpp"
#include "tools/maps/room_json.hpp"

namespace planum {
namespace {

using Json = nlohmann::ordered_json;

Json stages_json(const std::vector<StageCost>& stages) {
  Json json = Json::object();
  for (const StageCost& cost : stages)
    json[cost.stage] = {{"seconds", cost.seconds},
                        {"cached", cost.cached},
                        {"peak_memory_mb", cost.peak_memory_mb}};
  return json;
}

Json scans_json(const ScanFigures& scans) {
  return {{"count", scans.count},
          {"points", scans.points},
          {"no_return", scans.no_return},
          {"not_finite", scans.not_finite},
          {"out_of_range", scans.out_of_range}};
}

Json registration_json(const RegistrationFigures& registration) {
  return {{"pairs", registration.pairs},
          {"pairs_failed", registration.pairs_failed},
          {"rms_m", registration.rms},
          {"loops_accepted", registration.loops_accepted},
          {"loops_rejected", registration.loops_rejected},
          {"components", registration.components.size()},
          {"scans_of_components", registration.components}};
}

Json trajectory_json(const TrajectoryFigures& errors) {
  Json json = {{"ate_rmse_m", errors.ate_rmse},
               {"ate_max_m", errors.ate_max},
               {"rot_mean_deg", degrees(errors.rot_mean)},
               {"rot_max_deg", degrees(errors.rot_max)},
               {"rpe_trans_m", errors.rpe_trans},
               {"rpe_rot_deg", degrees(errors.rpe_rot)}};
  if (errors.drift)
    json["rpe_per_metre"] = {{"trans_m", errors.drift->trans},
                             {"rot_deg", degrees(errors.drift->rot)},
                             {"segments", errors.drift->segments}};
  return json;
}

Json residual_json(const ResidualFigures& residual) {
  return {{"trans_m", residual.translation},
          {"rot_deg", degrees(residual.rotation)},
          {"deviations", residual.deviations}};
}

Json loop_json(const LoopFigures& loop) {
  Json json = {{"from", loop.from}, {"to", loop.to}, {"accepted", loop.accepted}};
  if (!loop.reason.empty()) json["reason"] = loop.reason;
  json["before"] = residual_json(loop.before);
  json["after"] = residual_json(loop.after);
  if (loop.held_out) json["held_out"] = residual_json(*loop.held_out);
  return json;
}

void add_map(const MapFigures& map, Json& json) {
  json["mme"] = map.entropy;
  json["plane_thickness_m"] = map.plane_thickness;
  if (map.walls_before) {
    json["double_wall_gap_before_m"] = map.walls_before->median;
    json["double_wall_gap_before_90_m"] = map.walls_before->percentile_90;
  }
  if (map.walls) {
    json["double_wall_gap_m"] = map.walls->median;
    json["double_wall_gap_90_m"] = map.walls->percentile_90;
  }
  json["loops"] = Json::array();
  for (const LoopFigures& loop : map.loops) json["loops"].push_back(loop_json(loop));
}

Json evaluation_json(const RunReport& report) {
  Json json = Json::object();
  if (report.evaluation) json = trajectory_json(*report.evaluation);
  if (report.odometry_evaluation) json["odometry"] = trajectory_json(*report.odometry_evaluation);
  if (report.map_evaluation) add_map(*report.map_evaluation, json);
  return json;
}

Json polygons_json(const PolygonFigures& polygons) {
  return {{"count", polygons.count},
          {"vertices", polygons.vertices},
          {"area_m2", polygons.area},
          {"inferred_area_m2", polygons.inferred_area},
          {"rest_triangles", polygons.rest_triangles},
          {"compression", polygons.compression}};
}

/// Every label, so that a reader finds a zero where there is no floor.
Json labels_json(const PolygonMap& map, const Labels& labels) {
  if (labels.polygons.size() != map.polygons.size())
    throw Error("report: labels and polygons do not match");
  Json json = Json::object();
  for (const Label label : all_labels) {
    std::size_t count = 0;
    double area = 0;
    for (std::size_t i = 0; i < map.polygons.size(); ++i) {
      if (labels.polygons[i].label != label) continue;
      ++count;
      area += map.polygons[i].area;
    }
    json[name(label)] = {{"count", count}, {"area_m2", area}};
  }
  return json;
}

}  // namespace

void write_report_json(const std::filesystem::path& path, const RunReport& report) {
  Json json;
  json["planum"] = {{"version", report.version}};
  json["threads"] = report.threads;
  json["stages"] = stages_json(report.stages);
  if (report.scans) json["scans"] = scans_json(*report.scans);
  if (report.registration) json["registration"] = registration_json(*report.registration);
  if (report.evaluation || report.map_evaluation) json["evaluation"] = evaluation_json(report);
  if (report.levelled) json["world"] = {{"levelled_deg", degrees(*report.levelled)}};
  if (report.mesh)
    json["mesh"] = {{"vertices", report.mesh->vertices}, {"triangles", report.mesh->triangles}};
  if (report.polygons) json["polygons"] = polygons_json(*report.polygons);
  if (report.map && report.labels) json["labels"] = labels_json(*report.map, *report.labels);
  if (report.rooms) {
    json["rooms"] = rooms_json(*report.rooms);
    json["openings"] = openings_json(*report.rooms);
    json["objects"] = objects_json(report.objects, *report.rooms);
  }
  // Scans are named after files, whose names may be of any encoding.
  write_file_atomically(path, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace planum
