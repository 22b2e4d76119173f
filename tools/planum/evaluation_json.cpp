#include <nlohmann/json.hpp>

#include "tools/planum/evaluation_output.hpp"

namespace planum {
namespace {

using Json = nlohmann::ordered_json;

Json statistics_json(const ErrorStatistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
          {"min", s.min},   {"max", s.max},   {"sse", s.sse},       {"count", s.count}};
}

Json segments_json(const SegmentError& error) {
  const auto figures = [](const ErrorStatistics& translation, const ErrorStatistics& rotation) {
    return Json{{"translation_m_per_m", statistics_json(translation)},
                {"rotation_deg_per_m", statistics_json(rotation)}};
  };
  Json json = figures(error.translation, error.rotation);
  json["path_m"] = error.path;
  json["lengths"] = Json::array();
  for (const SegmentsOfLength& s : error.lengths) {
    json["lengths"].push_back({{"length_m", s.length}, {"mean_path_m", s.mean_path}});
    json["lengths"].back().update(figures(s.translation, s.rotation));
  }
  return json;
}

Json relations_json(const EvaluatedRelations& relations) {
  return {{"what", relations.what},
          {"unknown", relations.error.unknown},
          {"translation_m", statistics_json(relations.error.translation)},
          {"rotation_deg", statistics_json(relations.error.rotation)},
          {"squared_translation_m2", statistics_json(relations.error.squared_translation)},
          {"squared_rotation_deg2", statistics_json(relations.error.squared_rotation)}};
}

Json trajectory_json(const EvaluatedTrajectory& trajectory) {
  Json json = Json::object();
  if (trajectory.error) {
    const TrajectoryError& error = *trajectory.error;
    json = {{"poses", error.matches.size()},
            {"ape_translation_m", statistics_json(error.ape_translation)},
            {"ape_rotation_deg", statistics_json(error.ape_rotation)},
            {"rpe_translation_m", statistics_json(error.rpe_translation)},
            {"rpe_rotation_deg", statistics_json(error.rpe_rotation)}};
  }
  if (trajectory.segments) json["rpe_per_metre"] = segments_json(*trajectory.segments);
  if (trajectory.relations) json["relations"] = relations_json(*trajectory.relations);
  return json;
}

Json walls_json(const DoubleWallGap& gap) {
  return {{"patches", gap.patches},
          {"median_m", gap.median},
          {"mean_m", gap.mean},
          {"percentile_90_m", gap.percentile_90},
          {"max_m", gap.max}};
}

Json residual_json(const EdgeResidual& r) {
  return {{"translation_m", r.translation},
          {"rotation_deg", degrees(r.rotation)},
          {"deviations", r.deviations}};
}

Json loop_json(const LoopEvaluation& loop) {
  Json json = {{"from", loop.from}, {"to", loop.to}, {"accepted", loop.accepted}};
  if (!loop.accepted) json["reason"] = loop.reason;
  json["odometry"] = residual_json(loop.odometry);
  json["before"] = residual_json(loop.before);
  json["after"] = residual_json(loop.after);
  if (loop.held_out) json["held_out"] = residual_json(*loop.held_out);
  return json;
}

void add_map(const MapEvaluation& map, Json& json) {
  const MapSharpness& s = map.sharpness;
  json["points"] = {{"mme", s.mean_entropy},
                    {"mean_plane_variance_m2", s.mean_plane_variance},
                    {"plane_thickness_m", s.plane_thickness},
                    {"measured", s.measured},
                    {"passed_over", s.passed_over}};
  json["double_walls"] = {{"loops", map.loops_with_walls},
                          {"before", walls_json(map.walls_before)},
                          {"after", walls_json(map.walls_after)}};
  json["held_out"] = {{"graphs", map.held_out_solved}, {"converged", map.held_out_converged}};
  json["loops"] = Json::array();
  for (const LoopEvaluation& loop : map.loops) json["loops"].push_back(loop_json(loop));
}

Json distances_json(const SurfaceDistances& d) {
  return {{"count", d.count},
          {"mean_m", d.mean},
          {"rms_m", d.rms},
          {"median_m", d.median},
          {"percentile_90_m", d.percentile_90},
          {"max_m", d.max},
          {"within_m", d.within},
          {"share_within", d.share_within}};
}

Json model_json(const ModelComparison& model) {
  const Eigen::Quaterniond q(model.model_from_map.linear());
  const Eigen::Vector3d t = model.model_from_map.translation();
  Json json = {{"model_from_map", {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}}};
  if (model.fit)
    json["fit"] = {{"rms_m", model.fit->rms},
                   {"points", model.fit->count},
                   {"converged", model.fit->converged}};
  if (model.map_to_model) json["map_to_model"] = distances_json(*model.map_to_model);
  json["points_to_model"] = distances_json(model.cloud_to_model);
  if (model.model_to_map) json["model_to_map"] = distances_json(*model.model_to_map);
  json["model_to_points"] = distances_json(model.model_to_cloud);
  json["samples"] = model.samples;
  json["seen"] = model.seen;
  return json;
}

}  // namespace

std::string evaluation_json(const Evaluation& evaluation) {
  Json json = Json::object();
  for (const EvaluatedTrajectory& trajectory : evaluation.trajectories)
    json[trajectory.name] = trajectory_json(trajectory);
  if (evaluation.map) add_map(*evaluation.map, json);
  if (evaluation.model) json["model"] = model_json(*evaluation.model);
  return json.dump(1) + "\n";
}

}  // namespace planum
