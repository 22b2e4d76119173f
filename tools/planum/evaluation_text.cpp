#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "tools/planum/evaluation_output.hpp"

namespace planum {
namespace {

/// Rows that a person reads.
constexpr std::size_t most_loops = 40;

const char* name(TrajectoryAlignment alignment) {
  switch (alignment) {
    case TrajectoryAlignment::none:
      return "not aligned";
    case TrajectoryAlignment::first_pose:
      return "aligned by the first pose";
    case TrajectoryAlignment::positions:
      return "aligned by positions (Umeyama)";
    case TrajectoryAlignment::joint:
      return "aligned by positions and orientations";
  }
  return "";
}

std::string row(const std::string& what, const ErrorStatistics& s) {
  return fmt::format("  {:<16}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.4f}{:>9.4f}\n", what, s.rmse,
                     s.mean, s.median, s.std, s.min, s.max);
}

std::string header() {
  return fmt::format("  {:<16}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "", "rmse", "mean", "median",
                     "std", "min", "max");
}

std::string error_text(const TrajectoryError& error) {
  std::string text =
      header() + row("APE m", error.ape_translation) + row("APE degrees", error.ape_rotation);
  if (error.rpe_translation.count > 0)
    text += row("RPE m", error.rpe_translation) + row("RPE degrees", error.rpe_rotation);
  return text;
}

std::string segments_text(const SegmentError& error) {
  if (error.lengths.empty()) return "";
  std::string text =
      fmt::format("  {:<16}{:>9}{:>9}{:>9}\n", "per metre", "segments", "%", "deg/m");
  const auto line = [&](const std::string& what, const ErrorStatistics& translation,
                        const ErrorStatistics& rotation) {
    text += fmt::format("  {:<16}{:>9}{:>9.3f}{:>9.4f}\n", what, translation.count,
                        100 * translation.mean, rotation.mean);
  };
  for (const SegmentsOfLength& s : error.lengths)
    line(fmt::format("{:g} m", s.length), s.translation, s.rotation);
  line("all", error.translation, error.rotation);
  return text;
}

std::string relations_text(const EvaluatedRelations& relations) {
  const RelationError& error = relations.error;
  std::string text = fmt::format("  {} relations {}", error.translation.count, relations.what);
  if (error.unknown > 0) text += fmt::format(" ({} of poses that are not here)", error.unknown);
  return text + fmt::format(
                    "\n  {:<16}{:>9.4f} m +- {:.4f}, {:.4f} at most; {:.4f} degrees +- {:.4f}, "
                    "{:.4f} at most\n  {:<16}{:>9.3g} m^2 +- {:.3g}; {:.3g} degrees^2 +- {:.3g}\n",
                    "absolute", error.translation.mean, error.translation.std,
                    error.translation.max, error.rotation.mean, error.rotation.std,
                    error.rotation.max, "squared", error.squared_translation.mean,
                    error.squared_translation.std, error.squared_rotation.mean,
                    error.squared_rotation.std);
}

std::string trajectory_text(const EvaluatedTrajectory& trajectory) {
  std::string text = trajectory.name;
  if (trajectory.error)
    text += fmt::format(": {} poses, {}", trajectory.error->matches.size(),
                        name(trajectory.error->alignment));
  text += "\n";
  if (trajectory.error) text += error_text(*trajectory.error);
  if (trajectory.segments) text += segments_text(*trajectory.segments);
  if (trajectory.relations) text += relations_text(*trajectory.relations);
  return text + "\n";
}

std::string wall_row(const char* what, const DoubleWallGap& gap) {
  if (gap.patches == 0)
    return fmt::format("  {:<16}no wall is seen from both sides of a loop\n", what);
  return fmt::format(
      "  {:<16}{:>7.1f} mm median, {:.1f} mean, {:.1f} for 90 %, {:.1f} at most ({} patches)\n",
      what, 1000 * gap.median, 1000 * gap.mean, 1000 * gap.percentile_90, 1000 * gap.max,
      gap.patches);
}

std::string sharpness_text(const MapEvaluation& map) {
  const MapSharpness& s = map.sharpness;
  if (s.measured == 0) return "points: too few to measure planes\n\n";
  return fmt::format(
      "points\n  {:<16}{:>7.3f} nats mean map entropy\n  {:<16}{:>7.1f} mm median, {:.1f} rms "
      "({} neighbourhoods)\n\n",
      "entropy", s.mean_entropy, "plane thickness", 1000 * s.plane_thickness,
      1000 * std::sqrt(s.mean_plane_variance), s.measured);
}

std::string residual(const EdgeResidual& r) {
  return fmt::format("{:>8.3f} {:>6.2f} {:>5.1f}", r.translation, degrees(r.rotation),
                     r.deviations);
}

std::string loop_row(const LoopEvaluation& loop) {
  std::string text =
      fmt::format("  {:<12}{}{}{}", fmt::format("{} - {}", loop.from, loop.to),
                  residual(loop.odometry), residual(loop.before), residual(loop.after));
  if (loop.held_out) text += residual(*loop.held_out);
  return text + (loop.accepted ? "\n" : "  rejected: " + loop.reason + "\n");
}

/// Each figure of a residual by itself.
EdgeResidual median(const std::vector<EdgeResidual>& residuals) {
  const auto of = [&](double EdgeResidual::*figure) {
    std::vector<double> values;
    for (const EdgeResidual& r : residuals) values.push_back(r.*figure);
    return statistics(values).median;
  };
  return {of(&EdgeResidual::translation), of(&EdgeResidual::rotation),
          of(&EdgeResidual::deviations)};
}

std::string median_row(const std::vector<LoopEvaluation>& loops) {
  std::vector<EdgeResidual> odometry, before, after, held_out;
  for (const LoopEvaluation& loop : loops) {
    if (!loop.accepted) continue;
    odometry.push_back(loop.odometry);
    before.push_back(loop.before);
    after.push_back(loop.after);
    if (loop.held_out) held_out.push_back(*loop.held_out);
  }
  if (odometry.empty()) return "";
  return fmt::format("  {:<12}{}{}{}{}  median of {} accepted\n", "", residual(median(odometry)),
                     residual(median(before)), residual(median(after)), residual(median(held_out)),
                     odometry.size());
}

/// Those farthest off the map, or off what a graph without them says, in the order of the graph.
std::vector<LoopEvaluation> worst_loops(const std::vector<LoopEvaluation>& loops) {
  const auto off = [](const LoopEvaluation& loop) {
    return std::max(loop.after.deviations, loop.held_out ? loop.held_out->deviations : 0);
  };
  if (loops.size() <= most_loops) return loops;
  std::vector<double> all;
  for (const LoopEvaluation& loop : loops) all.push_back(off(loop));
  std::sort(all.begin(), all.end(), std::greater<>());
  std::vector<LoopEvaluation> worst;
  for (const LoopEvaluation& loop : loops)
    if (off(loop) >= all[most_loops - 1] && worst.size() < most_loops) worst.push_back(loop);
  return worst;
}

std::string loops_text(const MapEvaluation& map) {
  if (map.loops.empty()) return "loops: none\n\n";
  std::string text = fmt::format(
      "loops: residual in m, degrees, standard deviations\n  {:<12}{:>21}{:>21}{:>21}{:>21}\n", "",
      "odometry", "in order", "map", "held out");
  for (const LoopEvaluation& loop : worst_loops(map.loops)) text += loop_row(loop);
  text += median_row(map.loops);
  if (map.loops.size() > most_loops)
    text += fmt::format("  of {} loops the {} that are farthest off; --json has all\n",
                        map.loops.size(), most_loops);
  if (map.held_out_converged < map.held_out_solved)
    text += fmt::format("  {} of {} graphs without some loops did not converge\n",
                        map.held_out_solved - map.held_out_converged, map.held_out_solved);
  if (map.loops_with_walls > 0)
    text += fmt::format("double walls at {} loops\n", map.loops_with_walls) +
            wall_row("in order", map.walls_before) + wall_row("map", map.walls_after);
  return text + "\n";
}

std::string distances_row(const char* what, const SurfaceDistances& d) {
  return fmt::format("  {:<16}{:>9.1f}{:>9.1f}{:>9.1f}{:>9.1f}{:>9.1f}{:>9.1f}\n", what,
                     1000 * d.mean, 1000 * d.rms, 1000 * d.median, 1000 * d.percentile_90,
                     1000 * d.max, 100 * d.share_within);
}

std::string model_text(const ModelComparison& model) {
  std::string text = "model: distances in mm, ";
  text += model.fit
              ? fmt::format("the points laid onto it (rms {:.1f} mm{})", 1000 * model.fit->rms,
                            model.fit->converged ? "" : ", not converged")
              : "aligned by the poses";
  text += fmt::format("\n  {:<16}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "", "mean", "rms", "median",
                      "90 %", "max", fmt::format("% < {:g} cm", 100 * model.cloud_to_model.within));
  if (model.map_to_model) text += distances_row("map to model", *model.map_to_model);
  text += distances_row("points to model", model.cloud_to_model);
  if (model.model_to_map) text += distances_row("model to map", *model.model_to_map);
  text += distances_row("model to points", model.model_to_cloud);
  return text + fmt::format("  {:.1f} % of the model was seen\n",
                            100.0 * static_cast<double>(model.seen) /
                                static_cast<double>(std::max<std::size_t>(model.samples, 1)));
}

}  // namespace

std::string evaluation_text(const Evaluation& evaluation) {
  std::string text;
  for (const EvaluatedTrajectory& trajectory : evaluation.trajectories)
    text += trajectory_text(trajectory);
  if (evaluation.map) text += sharpness_text(*evaluation.map) + loops_text(*evaluation.map);
  if (evaluation.model) text += model_text(*evaluation.model);
  return text;
}

}  // namespace planum
