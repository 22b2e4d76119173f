#include "tools/workflow/run.hpp"

#include <chrono>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "tools/workflow/freshness.hpp"
#include "tools/workflow/peak_memory.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/run_lock.hpp"

namespace planum {
namespace {

namespace fs = std::filesystem;

/// Everything that one run shares between its stages.
struct Session {
  const Project& project;
  const RunOptions& options;
  const RunListener& listener;
  CacheLayout layout;
  FileDigests digests;
  Results results;
  std::map<std::string, Manifest> finished;
  RunSummary summary;
};

void make_directories(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) {
    throw Error(fmt::format("{}: cannot make this directory: {}", path.string(), error.message()),
                ErrorKind::environment);
  }
}

/// What a killed run left behind: staged files and half-written units.
void remove_leftovers(const CacheLayout& layout) {
  fs::remove_all(layout.staging());
  std::vector<fs::path> parts;
  for (const auto& entry : fs::recursive_directory_iterator(layout.root())) {
    if (entry.path().extension() == ".part") parts.push_back(entry.path());
  }
  for (const auto& part : parts) fs::remove(part);
}

/// Moves everything from the staging directory to its place; outputs that the stage made before but
/// not now are removed.
void publish(const std::optional<Manifest>& before, Manifest& now, Session& session) {
  const fs::path staging = session.layout.staging(), output = session.layout.output;
  std::vector<fs::path> names;
  for (const auto& entry : fs::recursive_directory_iterator(staging)) {
    if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(staging));
  }
  for (const auto& name : names) {
    now.outputs[name.string()] = digest_of_file(staging / name);
    make_directories((output / name).parent_path());
    fs::rename(staging / name, output / name);
  }
  if (before) {
    for (const auto& [name, digest] : before->outputs) {
      if (!now.outputs.contains(name)) fs::remove(output / name);
    }
  }
  fs::remove_all(staging);
}

Manifest redo(const Stage& stage, Manifest manifest, const std::optional<Manifest>& before,
              Session& session) {
  const auto start = std::chrono::steady_clock::now();
  const fs::path staging = session.layout.staging();
  const fs::path result = CacheLayout{staging}.result(stage.name);
  UnitCache units(session.layout.units(stage.name), !session.options.force);
  fs::remove_all(staging);
  make_directories(result.parent_path());
  make_directories(session.layout.manifest(stage.name).parent_path());
  reset_peak_memory();
  StageContext context{session.project,
                       session.results,
                       staging,
                       result,
                       units,
                       session.listener.progress ? session.listener.progress(stage) : Progress(),
                       manifest,
                       session.finished,
                       session.summary.redone};
  stage.work(context);
  publish(before, manifest, session);
  units.remove_unused();
  manifest.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  manifest.peak_memory_mb = peak_memory_mb();
  write_manifest(session.layout.manifest(stage.name), manifest);
  return manifest;
}

/// A stage before `--from`: its result is used as it is, if there is one.
void use_as_it_is(const Stage& stage, const Manifest& wanted, Session& session) {
  const auto recorded = read_manifest(session.layout.manifest(stage.name));
  if (!recorded) {
    throw Error(fmt::format("has never run, so the run cannot start at {}; leave out --from",
                            session.options.from),
                ErrorKind::usage);
  }
  const std::string reason = why_stale(recorded, wanted, session.layout.output, session.digests);
  if (reason.find(" is gone") != std::string::npos && reason.starts_with("its output")) {
    throw Error(reason + ", so the run cannot start behind it; leave out --from", ErrorKind::usage);
  }
  if (!reason.empty() && session.listener.used_stale) session.listener.used_stale(stage, reason);
  session.finished[stage.name] = *recorded;
}

void bring_up_to_date(const Stage& stage, const Manifest& wanted, Session& session) {
  const auto recorded = read_manifest(session.layout.manifest(stage.name));
  const std::string reason =
      session.options.force ? "--force"
                            : why_stale(recorded, wanted, session.layout.output, session.digests);
  const RunListener& listener = session.listener;
  if (reason.empty()) {
    session.finished[stage.name] = *recorded;
    if (listener.fresh) listener.fresh(stage, *recorded);
  } else {
    if (listener.started) listener.started(stage, reason);
    session.finished[stage.name] = redo(stage, wanted, recorded, session);
    session.summary.redone.push_back(stage.name);
    if (listener.finished) listener.finished(stage, session.finished[stage.name]);
  }
  const auto& shortcomings = session.finished[stage.name].shortcomings;
  session.summary.shortcomings.insert(session.summary.shortcomings.end(), shortcomings.begin(),
                                      shortcomings.end());
}

/// A file that a late stage needs must not be missed after minutes of work.
void check_input_files(const Project& project, std::size_t from, std::size_t until) {
  for (std::size_t i = from; i <= until; ++i) {
    const Stage& stage = stages()[i];
    if (!stage.input_files) continue;
    try {
      for (const fs::path& file : stage.input_files(project)) {
        if (!fs::exists(file)) throw Error(file.string() + ": no such file");
      }
    } catch (Error& error) {
      error.add_context(stage.name);
      throw;
    }
  }
}

/// Positions of the first and the last stage of a run.
std::pair<std::size_t, std::size_t> stage_range(const RunOptions& options) {
  const std::size_t from = stage_index(options.from), until = stage_index(options.until);
  if (from > until) {
    throw Error(fmt::format("--from {} comes after --until {}", options.from, options.until),
                ErrorKind::usage);
  }
  return {from, until};
}

}  // namespace

RunSummary run(const Project& project, const RunOptions& options, const RunListener& listener) {
  const auto [from, until] = stage_range(options);
  check_input_files(project, from, until);
  const CacheLayout layout{output_directory(project)};
  make_directories(layout.root());
  const RunLock lock(layout.lock());
  remove_leftovers(layout);
  Session session{project,
                  options,
                  listener,
                  layout,
                  FileDigests(layout.digests()),
                  Results(layout, project.settings.matching),
                  {},
                  {}};
  for (std::size_t i = 0; i <= until; ++i) {
    const Stage& stage = stages()[i];
    try {
      const Manifest wanted = wanted_manifest(stage, project, session.finished, session.digests);
      if (i < from) {
        use_as_it_is(stage, wanted, session);
      } else {
        bring_up_to_date(stage, wanted, session);
      }
    } catch (Error& error) {
      error.add_context(stage.name);
      throw;
    }
  }
  session.digests.save();
  return session.summary;
}

std::vector<StageState> dry_run(const Project& project, const RunOptions& options) {
  const auto [from, until] = stage_range(options);
  std::vector<StageState> states = stage_states(project);
  if (options.force) {
    for (StageState& state : states) state.stale_because = "--force";
  }
  return {states.begin() + static_cast<std::ptrdiff_t>(from),
          states.begin() + static_cast<std::ptrdiff_t>(until) + 1};
}

}  // namespace planum
