#include <fmt/format.h>

#include "slam/core/parallel.hpp"
#include "tools/workflow/project_scans.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"
#include "tools/workflow/stored_types.hpp"

namespace planum {
namespace {

std::vector<std::filesystem::path> input_files(const Project& project) {
  const ScanDirectory directory = scan_files(project);
  std::vector<std::filesystem::path> files = pose_files(project, directory);
  for (const ScanFile& scan : directory.scans) files.push_back(scan.file);
  return files;
}

/// A scan depends on its file and on the parameters of this stage, not on its pose.
Digest unit_key(const ScanFile& file, ScanFormat format, const StageContext& context) {
  Hasher hasher;
  hasher.value(context.record.version).text(name(format)).digest(digest_of_file(file.file));
  for (const auto& [key, value] : context.record.parameters) {
    if (key != "scans.directory" && key != "scans.poses") hasher.text(key).text(value);
  }
  return hasher.result();
}

ImportedUnit imported_unit(const ScanFile& file, ScanFormat format, StageContext& context) {
  const Digest key = unit_key(file, format, context);
  if (const auto bytes = context.units.find(file.id, key)) return unarchived<ImportedUnit>(*bytes);
  ImportedScan scan = read_scan(file, format, context.project.settings);
  ImportedUnit unit{std::move(scan.cloud), scan.counts};
  context.units.store(file.id, key, archived(unit));
  return unit;
}

std::string summary(const Imported& imported) {
  ImportCounts sum;
  for (const ImportCounts& counts : imported.counts) {
    sum.measured += counts.measured;
    sum.not_finite += counts.not_finite;
    sum.kept += counts.kept;
  }
  const std::string bad =
      sum.not_finite ? fmt::format(", {} not finite", sum.not_finite) : std::string();
  return fmt::format("{} scans, {} of {} measured points kept{}, poses: {}", imported.scans.size(),
                     sum.kept, sum.measured, bad, imported.pose_source);
}

void work(StageContext& context) {
  const ScanDirectory directory = scan_files(context.project);
  const ScanPoses poses = scan_poses(context.project, directory);
  const std::size_t count = directory.scans.size();
  Imported imported{std::vector<Scan>(count), std::vector<ImportCounts>(count),
                    std::vector<Digest>(count), poses.source};
  const auto import_scan = [&](std::size_t i, std::size_t) {
    const ScanFile& file = directory.scans[i];
    ImportedUnit unit = imported_unit(file, directory.format, context);
    imported.digests[i] = digest_of(unit.cloud);
    imported.counts[i] = unit.counts;
    imported.scans[i] = {
        file.id, file.number,
        poses.world_from_scan.empty() ? Pose::Identity() : poses.world_from_scan[i],
        std::move(unit.cloud)};
  };
  parallel_for(count, 1, import_scan, context.progress);
  const auto output = output_directory(context.project);
  for (const Scan& scan : imported.scans) {
    context.record.units.push_back(context.units.file(scan.id).lexically_relative(output));
  }
  write_result(context.result, imported);
  context.record.summary = summary(imported);
  context.results.imported.set(std::move(imported));
}

}  // namespace

Stage import_stage() {
  return {.name = "import",
          .version = 1,
          .unit = "scans",
          .needs = {},
          .parameters = {"scans", "sensor"},
          .input_files = input_files,
          .work = work};
}

}  // namespace planum
