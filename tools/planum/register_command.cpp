#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/graph/path_covariance.hpp"
#include "slam/graph/place_search.hpp"
#include "slam/io/uos.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/match_doubt.hpp"
#include "slam/registration/see_through.hpp"
#include "slam/sensor/range_limits.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/scan_file.hpp"

namespace planum {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct RegisterArguments {
  fs::path target, source;
  std::vector<double> guess;  ///< x y z (m) yaw pitch roll (degrees)
  bool no_guess = false;
  IcpParams icp;
  MatchingScanParams scan;
  RangeLimits limits;
  bool json = false;
  WorkArguments work;
};

struct Registered {
  Alignment alignment;
  std::string doubt;        ///< empty: the match is good
  double contradicted = 0;  ///< see FreeSpaceCheck
};

MatchingScan read_scan(const fs::path& file, const RegisterArguments& arguments) {
  const std::optional<Cloud> points = read_points_file(file);
  if (!points)
    throw Error(fmt::format("{}: no file of points; those end in .3d, .slices, .ply or .xyz",
                            file.string()));
  try {
    const ImportedScan scan = limited(*points, arguments.limits);
    check_import(scan.counts, arguments.limits);
    return matching_scan(scan.cloud, arguments.scan);
  } catch (Error& error) {
    error.add_context(file.string());
    throw;
  }
}

/// As given; else from the .pose files beside both scans; else both at the same place.
Pose guess_of(const RegisterArguments& arguments) {
  if (!arguments.guess.empty()) {
    const std::vector<double>& g = arguments.guess;
    return pose_from_xyz_ypr({g[0], g[1], g[2]}, radians(g[3]), radians(g[4]), radians(g[5]));
  }
  const fs::path target = fs::path(arguments.target).replace_extension(".pose"),
                 source = fs::path(arguments.source).replace_extension(".pose");
  if (!fs::exists(target) || !fs::exists(source)) return Pose::Identity();
  return read_uos_pose(target).inverse() * read_uos_pose(source);
}

Registered registered(const RegisterArguments& arguments) {
  const MatchingScan target = read_scan(arguments.target, arguments),
                     source = read_scan(arguments.source, arguments);
  Registered result;
  if (arguments.no_guess) {
    const Location location = locate(source, target, {.matching = arguments.icp});
    result.alignment = location.alignment;
    result.contradicted = location.evidence.contradicted;
    if (!location.found) result.doubt = location.reason;
    return result;
  }
  result.alignment = align(source, target, guess_of(arguments), arguments.icp);
  const Alignment& match = result.alignment;
  result.contradicted =
      check_free_space(range_view(source), range_view(target), match.target_from_source)
          .contradicted();
  if (match.pairs == 0)
    result.doubt = "too few points have a pair";
  else if (!match.converged)
    result.doubt = "the match did not converge";
  else
    result.doubt = doubt_of_rays(result.contradicted, most_contradicted);
  return result;
}

/// x y z (m), yaw pitch roll (degrees), as --guess takes them.
Vector6d as_guess(const Pose& pose) {
  const Eigen::Matrix3d r = pose.linear();
  Vector6d result;
  result << pose.translation(), degrees(std::atan2(r(1, 0), r(0, 0))),
      degrees(std::atan2(-r(2, 0), std::hypot(r(2, 1), r(2, 2)))),
      degrees(std::atan2(r(2, 1), r(2, 2)));
  return result;
}

/// An array of rows.
Json rows_of(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (const Eigen::RowVectorXd row : matrix.rowwise())
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  return rows;
}

void print_json(const Registered& result) {
  const Alignment& match = result.alignment;
  const Json json = {{"target_from_source", rows_of(match.target_from_source.matrix())},
                     {"information", rows_of(match.information)},
                     {"overlap", match.overlap},
                     {"rms_m", match.rms},
                     {"pairs", match.pairs},
                     {"iterations", match.iterations},
                     {"weak_directions", match.weak_directions},
                     {"contradicted", result.contradicted},
                     {"converged", match.converged},
                     {"doubt", result.doubt}};
  fmt::print("{}\n", json.dump(2));
}

void print_text(const Registered& result) {
  const Alignment& match = result.alignment;
  const Vector6d pose = as_guess(match.target_from_source);
  fmt::print("target from source\n");
  fmt::print("  x y z           {:.4f} {:.4f} {:.4f} m\n", pose[0], pose[1], pose[2]);
  fmt::print("  yaw pitch roll  {:.3f} {:.3f} {:.3f} degrees\n", pose[3], pose[4], pose[5]);
  const std::optional<Matrix6d> covariance = covariance_of(match.information);
  if (match.weak_directions == 0 && match.pairs > 0 && covariance) {
    const Vector6d deviation = covariance->diagonal().cwiseMax(0).cwiseSqrt();
    fmt::print("  known to        {:.1f} mm, {:.3f} degrees (largest standard deviations)\n",
               1000 * deviation.head<3>().maxCoeff(), degrees(deviation.tail<3>().maxCoeff()));
  } else if (match.pairs > 0) {
    fmt::print("  {} of 6 directions are not determined and stay at the guess\n",
               match.weak_directions);
  }
  fmt::print("overlap           {:.0f} %, rms {:.1f} mm over {} pairs, {} iterations\n",
             100 * match.overlap, 1000 * match.rms, match.pairs, match.iterations);
}

void register_command(const RegisterArguments& arguments) {
  set_thread_count(arguments.work.threads);
  const Registered result = registered(arguments);
  if (arguments.json)
    print_json(result);
  else
    print_text(result);
  if (!result.doubt.empty())
    throw Error(fmt::format("{} and {} do not match: {}", arguments.source.string(),
                            arguments.target.string(), result.doubt),
                ErrorKind::no_result);
}

}  // namespace

void add_register_command(CLI::App& app) {
  const auto arguments = std::make_shared<RegisterArguments>();
  CLI::App* command = app.add_subcommand("register", "one scan matched with another");
  command->add_option("TARGET", arguments->target, "the scan that stays")->required();
  command->add_option("SOURCE", arguments->source, "the scan that is moved")->required();
  CLI::Option* guess =
      command
          ->add_option("--guess", arguments->guess,
                       "where the source lies in the frame of the target; without it .pose files "
                       "beside the scans are used, or both are at the same place")
          ->type_name("X Y Z YAW PITCH ROLL")
          ->expected(6);
  command->add_flag("--no-guess", arguments->no_guess, "look for it everywhere")->excludes(guess);
  command
      ->add_option("--first-gate-m", arguments->icp.first_gate,
                   "points of a pair may be this far apart at first")
      ->capture_default_str();
  command->add_option("--voxel-m", arguments->scan.voxel, "scans are thinned to a point a voxel")
      ->capture_default_str();
  command->add_option("--min-range-m", arguments->limits.min_range, "nearer points are dropped")
      ->capture_default_str();
  command
      ->add_option("--max-range-m", arguments->limits.max_range,
                   "farther points are dropped, 0: none")
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "for programs, with the information matrix");
  add_work_arguments(*command, arguments->work);
  command->callback([arguments] { register_command(*arguments); });
}

}  // namespace planum
