#include <optional>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/registration/see_through.hpp"
#include "slam/registration/sequence.hpp"
#include "tools/workflow/figures.hpp"
#include "tools/workflow/pair_matching.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {
namespace {

std::vector<Pose> given_poses(const Imported& imported) {
  std::vector<Pose> poses;
  for (const Scan& scan : imported.scans) poses.push_back(scan.world_from_scan);
  return poses;
}

/// method = "none": what came with the scans is taken for measured.
SequenceMatch trusted(const std::vector<Pose>& poses, const OdometryNoise& noise) {
  SequenceMatch match{poses, {}};
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    SequenceStep step;
    step.alignment.target_from_source = poses[i].inverse() * poses[i + 1];
    step.alignment.information = odometry_information(step.alignment.target_from_source, noise);
    step.alignment.converged = true;
    step.matched = true;
    match.steps.push_back(step);
  }
  return match;
}

/// Of steps about which nothing is known: anywhere within a large building.
constexpr OdometryNoise unknown_odometry{.translation = 50, .rotation = pi / 2};

/// What can be done for steps whose match cannot be trusted.
class StepAids {
 public:
  StepAids(PairMatching& matching, StageContext& context)
      : matching_(matching), context_(context) {}

  SequenceAids aids() {
    return {.second = matching_.gated_matcher(),
            .metascan = matching_.metascan_matcher(),
            .locate = [this](std::size_t target, std::size_t source) -> std::optional<Alignment> {
              const Alignment found = matching_.align_without_guess(target, source);
              return found.pairs > 0 ? std::optional(found) : std::nullopt;
            },
            .contradicted =
                [this](std::size_t target, std::size_t source, const Pose& pose) {
                  return check_free_space(view(source), view(target), pose).contradicted();
                }};
  }

 private:
  /// All are made when the first one is needed: every scan is part of a step.
  const RangeView& view(std::size_t scan) {
    if (views_.empty()) views_ = range_views(context_.results.matching_scans(context_.progress));
    return views_[scan];
  }

  PairMatching& matching_;
  StageContext& context_;
  std::vector<RangeView> views_;
};

SequenceMatch matched(const Imported& imported, StageContext& context) {
  const Settings& settings = context.project.settings;
  PairMatching matching(context.results, settings, context.units, context.progress);
  StepAids aids(matching, context);
  SequenceParams params = settings.sequence;
  params.odometry_known = imported.pose_source != "none";
  if (!params.odometry_known) params.odometry = unknown_odometry;
  const std::vector<Pose> poses = given_poses(imported);
  if (settings.match_against == "metascan")
    return match_to_metascan(poses, matching.metascan_matcher(), params, context.progress,
                             aids.aids());
  return match_in_order(poses, matching.matcher(), params, context.progress, aids.aids());
}

void report(const SequenceMatch& match, const Imported& imported, Manifest& record) {
  std::size_t good = 0;
  for (std::size_t i = 0; i < match.steps.size(); ++i) {
    const SequenceStep& step = match.steps[i];
    if (step.matched) {
      ++good;
    } else {
      record.warnings.push_back(fmt::format("{} could not be matched with {}: {}",
                                            imported.scans[i + 1].id, imported.scans[i].id,
                                            step.reason));
    }
  }
  record.summary = fmt::format("{} of {} pairs matched, rms {:.1f} mm", good, match.steps.size(),
                               1000 * rms_of(match));
}

void work(StageContext& context) {
  const Imported& imported = context.results.imported.get();
  const Settings& settings = context.project.settings;
  const bool have_poses = imported.pose_source != "none";
  SequenceMatch match;
  if (settings.registration_method == "none") {
    if (!have_poses) {
      throw Error(
          "method = \"none\" trusts the poses that came with the scans, but there are none");
    }
    match = trusted(given_poses(imported), settings.sequence.odometry);
    context.record.summary = "the poses that came with the scans are trusted";
  } else {
    match = matched(imported, context);
    report(match, imported, context.record);
    if (!have_poses) {
      context.record.warnings.insert(
          context.record.warnings.begin(),
          "the scans have no poses: each one is looked for by itself, beginning at the one before");
    }
  }
  write_result(context.result, match);
  context.results.registered.set(std::move(match));
}

}  // namespace

Stage register_stage() {
  return {.name = "register",
          .version = 5,
          .unit = "pairs",
          .needs = {"import"},
          .parameters = {"registration"},
          .input_files = {},
          .work = work};
}

}  // namespace planum
