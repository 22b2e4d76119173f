#include <chrono>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/console.hpp"
#include "tools/planum/optimized_file.hpp"

namespace planum {
namespace {

using Json = nlohmann::ordered_json;

enum class OptimizeMethod { pose_graph, lu_milios };

const std::map<std::string, OptimizeMethod> methods = {{"pose-graph", OptimizeMethod::pose_graph},
                                                       {"lu-milios", OptimizeMethod::lu_milios}};
const std::map<std::string, GraphStart> starts = {
    {"best", GraphStart::best}, {"given", GraphStart::given}, {"edges", GraphStart::edges}};
const std::map<std::string, LoopRejection> rejections = {{"never", LoopRejection::never},
                                                         {"if-needed", LoopRejection::if_needed},
                                                         {"always", LoopRejection::always}};

struct OptimizeArguments {
  std::filesystem::path in, out;
  OptimizeMethod method = OptimizeMethod::pose_graph;
  GraphParams params;
  bool json = false;
  WorkArguments work;
};

std::size_t rejected_count(const GraphQuality& quality) {
  return static_cast<std::size_t>(std::count(quality.counts.begin(), quality.counts.end(), false));
}

void warn(const OptimizeArguments& arguments, const G2oGraph& file, const OptimizedFile& result,
          Console& console) {
  constexpr std::size_t most = 10;
  const auto& repaired = result.quality.repaired;
  for (std::size_t i = 0; i < std::min(most, repaired.size()); ++i)
    console.warn(fmt::format(
        "{}:{}: the information matrix is indefinite (least eigenvalue {:.3g}); its negative part "
        "is left out",
        arguments.in.string(), file.edges[repaired[i].edge].line, repaired[i].least_eigenvalue));
  if (repaired.size() > most)
    console.warn(fmt::format("{}: {} more information matrices are indefinite",
                             arguments.in.string(), repaired.size() - most));
  if (!result.quality.converged)
    console.warn(fmt::format("{}: not converged after {} iterations", arguments.in.string(),
                             result.quality.iterations));
  if (result.largest_sigma < 0)
    console.warn(
        fmt::format("{}: the edges do not determine all poses, so their uncertainty is "
                    "not known",
                    arguments.in.string()));
}

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

void print_json(const G2oGraph& file, const OptimizedFile& result, double seconds) {
  const GraphQuality& quality = result.quality;
  Json rejected = Json::array(), repaired = Json::array(), components = Json::array();
  for (std::size_t i = 0; i < file.edges.size(); ++i)
    if (!quality.counts[i])
      rejected.push_back({{"from", file.edges[i].from}, {"to", file.edges[i].to}});
  for (const auto& [edge, least] : quality.repaired)
    repaired.push_back({{"from", file.edges[edge].from},
                        {"to", file.edges[edge].to},
                        {"line", file.edges[edge].line},
                        {"least_eigenvalue", least}});
  for (const auto& part : quality.components)
    components.push_back({{"first", result.ids[part.front()]}, {"vertices", part.size()}});
  const Json sigma = result.largest_sigma < 0 ? Json(nullptr) : Json(result.largest_sigma);
  const Json json = {{"kind", file.planar ? "SE2" : "SE3"},
                     {"vertices", result.ids.size()},
                     {"edges", file.edges.size()},
                     {"converged", quality.converged},
                     {"iterations", quality.iterations},
                     {"chi2_before", finite(quality.cost_before)},
                     {"chi2_after", quality.cost_after},
                     {"largest_position_sigma_m", sigma},
                     {"components", components},
                     {"rejected", rejected},
                     {"repaired", repaired},
                     {"seconds", seconds}};
  fmt::print("{}\n", json.dump(1));
}

void print_text(const G2oGraph& file, const OptimizedFile& result, double seconds) {
  const GraphQuality& quality = result.quality;
  fmt::print("{} vertices, {} edges ({})\n", result.ids.size(), file.edges.size(),
             file.planar ? "2D" : "3D");
  fmt::print("chi2 {:.9g} -> {:.9g}, {} iterations, {:.3f} s\n", quality.cost_before,
             quality.cost_after, quality.iterations, seconds);
  if (const std::size_t rejected = rejected_count(quality); rejected > 0)
    fmt::print("{} loops rejected: they contradict the other edges\n", rejected);
  if (result.largest_sigma >= 0)
    fmt::print("positions are known to {:.3g} m (largest standard deviation)\n",
               result.largest_sigma);
}

/// "3 parts that no edge joins: 100 vertices from 0 on, 2 from 17 on, ..."
std::string parts_text(const OptimizedFile& result) {
  constexpr std::size_t most = 8;
  const auto& parts = result.quality.components;
  std::string text = fmt::format("{} parts that no edge joins:", parts.size());
  for (std::size_t i = 0; i < std::min(most, parts.size()); ++i)
    text += fmt::format("{} {} {} from {} on", i > 0 ? "," : "", parts[i].size(),
                        parts[i].size() == 1 ? "vertex" : "vertices", result.ids[parts[i][0]]);
  return parts.size() > most ? text + ", ..." : text;
}

void optimize_command(const OptimizeArguments& arguments) {
  set_thread_count(arguments.work.threads);
  Console console(arguments.work.quiet);
  const G2oGraph file = read_g2o(arguments.in, LooseEdges::allowed);
  const auto begin = std::chrono::steady_clock::now();
  const OptimizedFile result =
      arguments.method == OptimizeMethod::lu_milios
          ? relaxed_file(file)
          : optimized_pose_graph(file, arguments.params,
                                 console.start_bar("optimize", "iterations"));
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  console.end_bar();
  warn(arguments, file, result, console);
  if (!arguments.out.empty()) write_g2o(arguments.out, result.file);
  if (arguments.json)
    print_json(file, result, seconds);
  else
    print_text(file, result, seconds);
  if (result.quality.components.size() > 1)
    throw Error(fmt::format("{}: {}; each was optimized by itself", arguments.in.string(),
                            parts_text(result)),
                ErrorKind::no_result);
}

}  // namespace

void add_optimize_command(CLI::App& app) {
  const auto arguments = std::make_shared<OptimizeArguments>();
  CLI::App* command =
      app.add_subcommand("optimize", "the poses that agree best with the edges of a .g2o file");
  command->add_option("IN", arguments->in, "a .g2o file, SE3 or SE2; vertices may be missing")
      ->required();
  command->add_option("-o,--out", arguments->out, "a .g2o file to write")->type_name("OUT");
  command
      ->add_option("--method", arguments->method,
                   "pose-graph; or lu-milios, the relaxation of a run without its points")
      ->type_name("NAME")
      ->transform(CLI::CheckedTransformer(methods));
  command
      ->add_option("--start", arguments->params.start,
                   "given: at the vertices; edges: without looking at them; best: the better one")
      ->type_name("WHERE")
      ->transform(CLI::CheckedTransformer(starts));
  command
      ->add_option(
          "--reject-loops", arguments->params.rejection,
          "if-needed: leave loops out only if one is impossible; never; always: weigh all. "
          "Edges between ids in a row are odometry and always count")
      ->type_name("WHEN")
      ->transform(CLI::CheckedTransformer(rejections));
  command->add_flag("--json", arguments->json, "for programs");
  add_work_arguments(*command, arguments->work);
  command->callback([arguments] { optimize_command(*arguments); });
}

}  // namespace planum
