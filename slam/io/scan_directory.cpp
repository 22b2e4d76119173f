#include "slam/io/scan_directory.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/slices.hpp"

namespace planum {
namespace {

namespace fs = std::filesystem;

constexpr std::array formats = {ScanFormat::uos, ScanFormat::slices, ScanFormat::ply,
                                ScanFormat::xyz};
constexpr std::string_view digits = "0123456789";

std::optional<ScanFormat> format_named(const std::string& wanted, const fs::path& directory) {
  if (wanted == "auto") return std::nullopt;
  for (const ScanFormat format : formats)
    if (wanted == name(format)) return format;
  throw Error(fmt::format("{}: unknown scan format \"{}\": expected auto, uos, slices, ply or xyz",
                          directory.string(), wanted));
}

std::string lower_case_ending(const fs::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return ending;
}

bool has_number(const fs::path& file) {
  return file.stem().string().find_first_of(digits) != std::string::npos;
}

/// The format of a file by its name, and by its content where the name does not tell.
std::optional<ScanFormat> recognised_format(const fs::path& file) {
  const std::string ending = lower_case_ending(file);
  if (ending == ".3d") return ScanFormat::uos;
  if (ending == ".slices") return ScanFormat::slices;
  if (ending == ".ply") return ScanFormat::ply;
  if (ending == ".xyz") return ScanFormat::xyz;
  if (ending == ".txt" && has_number(file) && looks_like_slices(file)) return ScanFormat::slices;
  return std::nullopt;
}

/// Whether a file may be of the format that the user names.
bool may_be(ScanFormat format, const fs::path& file) {
  const std::string ending = lower_case_ending(file);
  switch (format) {
    case ScanFormat::uos:
      return ending == ".3d";
    case ScanFormat::slices:
      return ending == ".slices" || (ending == ".txt" && has_number(file));
    case ScanFormat::ply:
      return ending == ".ply";
    case ScanFormat::xyz:
      return ending == ".xyz" || ending == ".txt" || ending == ".dat" || ending == ".asc" ||
             ending == ".pts";
  }
  return false;
}

/// The regular files of a directory in the order of their names, but for hidden ones.
std::vector<fs::path> visible_files(const fs::path& directory) {
  std::error_code failure;
  const fs::file_status status = fs::status(directory, failure);
  if (!fs::exists(status)) throw Error(directory.string() + ": there is no such directory");
  if (!fs::is_directory(status)) throw Error(directory.string() + ": this is not a directory");
  std::vector<fs::path> files;
  fs::directory_iterator entry(directory, failure);
  for (; !failure && entry != fs::directory_iterator(); entry.increment(failure)) {
    std::error_code unreadable;
    if (entry->is_regular_file(unreadable) && !entry->path().filename().string().starts_with('.'))
      files.push_back(entry->path());
  }
  if (failure)
    throw Error(directory.string() + ": cannot list the directory: " + failure.message(),
                ErrorKind::environment);
  std::sort(files.begin(), files.end());
  return files;
}

/// The last group of digits in the name; 0 if there is none.
int number_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t last = stem.find_last_of(digits);
  if (last == std::string::npos) return 0;
  const std::size_t before = stem.find_last_not_of(digits, last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  int number = 0;
  const auto result = std::from_chars(stem.data() + first, stem.data() + last + 1, number);
  if (result.ec != std::errc())
    throw Error(fmt::format("{}: the scan's number is too large", file.string()));
  return number;
}

ScanFile scan_file(const fs::path& file) {
  fs::path pose = file;
  pose.replace_extension(".pose");
  std::error_code unreadable;
  if (!fs::is_regular_file(pose, unreadable)) pose.clear();
  return {.id = file.stem().string(), .number = number_of(file), .file = file, .pose_file = pose};
}

std::vector<ScanFile> sorted_scans(const std::vector<fs::path>& files) {
  std::vector<ScanFile> scans;
  for (const fs::path& file : files) scans.push_back(scan_file(file));
  std::stable_sort(scans.begin(), scans.end(),
                   [](const ScanFile& a, const ScanFile& b) { return a.number < b.number; });
  const auto same =
      std::adjacent_find(scans.begin(), scans.end(),
                         [](const ScanFile& a, const ScanFile& b) { return a.number == b.number; });
  if (same != scans.end())
    throw Error(fmt::format("{}: {} and {} are both scan number {}: rename or remove one of them",
                            same->file.parent_path().string(), same->file.filename().string(),
                            std::next(same)->file.filename().string(), same->number));
  return scans;
}

using FilesByFormat = std::map<ScanFormat, std::vector<fs::path>>;

FilesByFormat candidates(const std::vector<fs::path>& files, std::optional<ScanFormat> wanted) {
  FilesByFormat numbered, unnumbered;
  for (const fs::path& file : files) {
    const std::optional<ScanFormat> format = !wanted                 ? recognised_format(file)
                                             : may_be(*wanted, file) ? wanted
                                                                     : std::nullopt;
    if (format) (has_number(file) ? numbered : unnumbered)[*format].push_back(file);
  }
  if (!numbered.empty()) return numbered;
  const bool just_one = unnumbered.size() == 1 && unnumbered.begin()->second.size() == 1;
  if (!just_one && !unnumbered.empty()) {
    const auto& some = unnumbered.begin()->second;
    throw Error(fmt::format("{}: the names of scans must have a number in them, as in scan007{}",
                            some.front().string(), some.front().extension().string()));
  }
  return unnumbered;
}

[[noreturn]] void fail_without_scans(const fs::path& directory, std::optional<ScanFormat> wanted) {
  const std::string looked_for =
      wanted ? fmt::format("scans of format {}", name(*wanted))
             : "scan000.3d (uos), scan000.slices (slices), scan000.ply, scan000.xyz and so on";
  const std::string hint =
      wanted ? "" : "; .txt, .dat, .asc and .pts files of points are read with --format xyz";
  throw Error(fmt::format("{}: there are no scans in it: looked for {}{}", directory.string(),
                          looked_for, hint));
}

[[noreturn]] void fail_on_formats(const fs::path& directory, const FilesByFormat& found) {
  std::string list, options;
  for (const auto& [format, files] : found) {
    list += fmt::format("{}{} ({}{})", list.empty() ? "" : " and ", name(format),
                        files.front().filename().string(), files.size() > 1 ? ", ..." : "");
    options += fmt::format("{}--format {}", options.empty() ? "" : " or ", name(format));
  }
  throw Error(fmt::format("{}: there are scans in {} formats, {}: choose with {}",
                          directory.string(), found.size(), list, options));
}

std::vector<fs::path> trajectories_among(const std::vector<fs::path>& files) {
  std::vector<fs::path> found;
  for (const fs::path& file : files)
    if (lower_case_ending(file) == ".tum") found.push_back(file);
  std::stable_partition(found.begin(), found.end(),
                        [](const fs::path& file) { return file.filename() == "odometry.tum"; });
  return found;
}

}  // namespace

const char* name(ScanFormat format) {
  switch (format) {
    case ScanFormat::uos:
      return "uos";
    case ScanFormat::slices:
      return "slices";
    case ScanFormat::ply:
      return "ply";
    case ScanFormat::xyz:
      return "xyz";
  }
  return "";
}

ScanDirectory list_scans(const fs::path& directory, const std::string& format) {
  const std::optional<ScanFormat> wanted = format_named(format, directory);
  const std::vector<fs::path> files = visible_files(directory);
  const FilesByFormat found = candidates(files, wanted);
  if (found.empty()) fail_without_scans(directory, wanted);
  if (found.size() > 1) fail_on_formats(directory, found);
  return {.path = directory,
          .format = found.begin()->first,
          .scans = sorted_scans(found.begin()->second),
          .trajectories = trajectories_among(files)};
}

}  // namespace planum
