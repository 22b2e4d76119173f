#include "slam/io/pcd.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/binary_rows.hpp"

namespace planum {
namespace {

/// The lines of the header that say what a point has, and its values.
struct Columns {
  std::string fields = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
  std::vector<RowPart> parts;

  template <class Value>
  void add(const std::vector<Value>& values, std::initializer_list<std::string_view> names,
           char type) {
    parts.push_back({values.data(), sizeof(Value)});
    for (const std::string_view name : names) {
      fields += fmt::format(" {}", name);
      sizes += " 4";
      types += fmt::format(" {}", type);
      counts += " 1";
    }
  }

  template <class Value>
  void add_if_there(const std::vector<Value>& values, std::size_t count,
                    std::initializer_list<std::string_view> names, char type) {
    if (values.empty()) return;
    if (values.size() != count)
      throw Error(
          fmt::format("PCD: {} values of {} for {} points", values.size(), *names.begin(), count));
    add(values, names, type);
  }
};

}  // namespace

void write_pcd(const std::filesystem::path& path, const Cloud& cloud) {
  const std::size_t count = cloud.points.size();
  Columns columns;
  columns.add(cloud.points, {"x", "y", "z"}, 'F');
  columns.add_if_there(cloud.normals, count, {"normal_x", "normal_y", "normal_z"}, 'F');
  columns.add_if_there(cloud.intensity, count, {"intensity"}, 'F');
  columns.add_if_there(cloud.scan, count, {"scan"}, 'U');
  AtomicFile file(path);
  file.write(
      fmt::format("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n{}\n{}\n{}\n{}\n"
                  "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
                  columns.fields, columns.sizes, columns.types, columns.counts, count, count));
  write_rows(file, count, columns.parts);
  file.commit();
}

}  // namespace planum
