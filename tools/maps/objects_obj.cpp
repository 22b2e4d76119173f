#include "tools/maps/objects_obj.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"

namespace planum {
namespace {

/// Blanks would part the names of two groups.
std::string one_word(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isspace(c) != 0; }, '_');
  return name;
}

}  // namespace

void write_objects_obj(const std::filesystem::path& path, std::span<const SceneObject> objects) {
  std::string text;
  const auto out = std::back_inserter(text);
  std::size_t before = 1;  // vertices are numbered from 1, through all groups
  for (std::size_t id = 0; id < objects.size(); ++id) {
    if (!objects[id].model) continue;
    const ModelMatch& match = *objects[id].model;
    fmt::format_to(out, "g object_{}_{}\n", id, one_word(match.name));
    for (const Eigen::Vector3f& p : match.surface.vertices)
      fmt::format_to(out, "v {} {} {}\n", p.x(), p.y(), p.z());
    for (const auto& [a, b, c] : match.surface.triangles)
      fmt::format_to(out, "f {} {} {}\n", before + a, before + b, before + c);
    before += match.surface.vertices.size();
  }
  if (text.empty()) throw Error(path.string() + ": no object has a model");
  write_file_atomically(path, text);
}

}  // namespace planum
