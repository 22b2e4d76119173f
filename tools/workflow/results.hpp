#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/cloud.hpp"
#include "slam/registration/sequence.hpp"
#include "slam/sensor/range_limits.hpp"
#include "tools/workflow/cache_layout.hpp"
#include "tools/workflow/digest.hpp"

namespace planum {

/// A result of a stage: in memory once made, else read from disk when first asked for.
template <class T>
class Held {
 public:
  explicit Held(std::function<T()> load) : load_(std::move(load)) {}
  void set(T value) { value_ = std::move(value); }
  void forget() { value_.reset(); }
  const T& get() {
    if (!value_) value_ = load_();
    return *value_;
  }

 private:
  std::optional<T> value_;
  std::function<T()> load_;
};

/// What `import` makes: scans in the scanner's frame, at the poses that came with them.
struct Imported {
  std::vector<Scan> scans;
  std::vector<ImportCounts> counts;  ///< for each scan
  std::vector<Digest> keys;          ///< of the units that hold the clouds
  std::vector<Digest> digests;       ///< of the clouds
  std::string pose_source;           ///< "pose files", the name of a file, or "none"
};

/// One imported scan as its unit keeps it.
struct ImportedUnit {
  Cloud cloud;
  ImportCounts counts;
};

/// The results of all stages of one run.
struct Results {
  explicit Results(const CacheLayout& layout);

  Held<Imported> imported;
  Held<SequenceMatch> registered;
};

/// Writes a result as Results will read it.
template <class T>
void write_result(const std::filesystem::path& file, const T& result);

}  // namespace planum
