#include "tools/workflow/results.hpp"

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/input_file.hpp"
#include "tools/workflow/cache_layout.hpp"
#include "tools/workflow/stored_types.hpp"
#include "tools/workflow/unit_cache.hpp"

namespace planum {
namespace {

/// `load`, and how to get out of it if a stored file is missing or damaged.
template <class Load>
auto loader(const std::string& stage, Load load) {
  return [stage, load] {
    try {
      return load();
    } catch (const Error& error) {
      throw Error(
          fmt::format("the stored result of {} cannot be read ({}); redo it with "
                      "--from {} --force",
                      stage, error.what(), stage));
    }
  };
}

template <class T>
std::function<T()> archive_loader(const CacheLayout& layout, const std::string& stage) {
  const auto file = layout.result(stage);
  return loader(stage, [file] { return unarchived<T>(read_file(file)); });
}

/// The clouds are read from the units, the rest from the result file.
Imported load_imported(const CacheLayout& layout) {
  Imported imported = unarchived<Imported>(read_file(layout.result("import")));
  UnitCache units(layout.units("import"));
  for (std::size_t i = 0; i < imported.scans.size(); ++i) {
    Scan& scan = imported.scans[i];
    const auto bytes = units.find(scan.id, imported.keys[i]);
    if (!bytes) throw Error("the points of " + scan.id + " are missing");
    scan.cloud = unarchived<ImportedUnit>(*bytes).cloud;
  }
  return imported;
}

}  // namespace

Results::Results(const CacheLayout& layout)
    : imported(loader("import", [=] { return load_imported(layout); })),
      registered(archive_loader<SequenceMatch>(layout, "register")) {}

template <class T>
void write_result(const std::filesystem::path& file, const T& result) {
  write_file_atomically(file, archived(result));
}

template void write_result(const std::filesystem::path&, const Imported&);
template void write_result(const std::filesystem::path&, const SequenceMatch&);

}  // namespace planum
