#include "slam/io/obj.hpp"

#include <charconv>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/polygon_ears.hpp"
#include "slam/io/text_reader.hpp"

namespace planum {
namespace {

/// What has been read so far.
struct Reading {
  LabelledMesh result;
  std::unordered_map<std::string, std::uint32_t> groups;
  std::uint32_t group = 0;
  std::vector<std::uint32_t> corners;

  void select_group(std::string_view name) {
    if (name.empty()) name = "default";
    const auto next = static_cast<std::uint32_t>(result.names.size());
    const auto [found, is_new] = groups.try_emplace(std::string(name), next);
    if (is_new) result.names.emplace_back(name);
    group = found->second;
  }
};

void read_vertex(TextReader& reader, TriangleMesh& mesh) {
  std::array<double, 3> xyz;
  const std::size_t count = reader.numbers(xyz);
  if (count < 3) reader.fail(fmt::format("expected 3 numbers after v, got {}", count));
  mesh.vertices.push_back(Eigen::Vector3d(xyz[0], xyz[1], xyz[2]).cast<float>());
}

/// The vertex that `7`, `-1`, `7/3/2` ... stands for, counted from 0.
std::uint32_t vertex_index(std::string_view word, const TextReader& reader, std::size_t vertices) {
  const char* const end = word.data() + word.size();
  long long index = 0;
  const auto result = std::from_chars(word.data(), end, index);
  if (result.ec != std::errc() || (result.ptr != end && *result.ptr != '/'))
    reader.fail(fmt::format("expected a vertex index, got {}", in_quotes(word)));
  const auto count = static_cast<long long>(vertices);
  const long long from_zero = index > 0 ? index - 1 : count + index;
  if (index == 0 || from_zero < 0 || from_zero >= count)
    reader.fail(fmt::format("there is no vertex {}, there are {} so far", index, count));
  return static_cast<std::uint32_t>(from_zero);
}

void read_face(TextReader& reader, Reading& reading) {
  TriangleMesh& mesh = reading.result.mesh;
  reading.corners.clear();
  for (std::string_view word = reader.word(); !word.empty(); word = reader.word())
    reading.corners.push_back(vertex_index(word, reader, mesh.vertices.size()));
  if (reading.corners.size() < 3)
    reader.fail(fmt::format("expected at least 3 corners, got {}", reading.corners.size()));
  if (reading.result.names.empty()) reading.select_group("");
  for (const auto& triangle : triangulated_polygon(mesh.vertices, reading.corners)) {
    mesh.triangles.push_back(triangle);
    reading.result.group.push_back(reading.group);
  }
}

void check(const LabelledMesh& labelled, const TextureCoordinates& texture,
           const std::filesystem::path& path) {
  for (const std::string& name : labelled.names)
    if (name.empty() || name.find_first_of("\r\n") != std::string::npos || name.front() == ' ' ||
        name.back() == ' ')
      throw Error(
          fmt::format("{}: {} cannot be the name of a group", path.string(), in_quotes(name)));
  if (labelled.group.size() != labelled.mesh.triangles.size())
    throw Error(fmt::format("{}: {} triangles with {} groups", path.string(),
                            labelled.mesh.triangles.size(), labelled.group.size()));
  for (const std::uint32_t group : labelled.group)
    if (group >= labelled.names.size())
      throw Error(fmt::format("{}: group {} has no name", path.string(), group));
  if (!texture.corners.empty() && texture.corners.size() != labelled.mesh.triangles.size())
    throw Error(fmt::format("{}: {} triangles, {} of them with texture coordinates", path.string(),
                            labelled.mesh.triangles.size(), texture.corners.size()));
  for (const auto& corners : texture.corners)
    for (const std::uint32_t corner : corners)
      if (corner != TextureCoordinates::none && corner >= texture.places.size())
        throw Error(fmt::format("{}: there are no texture coordinates {}", path.string(), corner));
}

}  // namespace

LabelledMesh read_obj(const std::filesystem::path& path) {
  TextReader reader(path);
  Reading reading;
  while (reader.next_data_line()) {
    const std::string_view keyword = reader.word();
    if (keyword == "v")
      read_vertex(reader, reading.result.mesh);
    else if (keyword == "f")
      read_face(reader, reading);
    else if (keyword == "usemtl")
      reading.select_group(reader.rest());
  }
  if (reading.result.mesh.triangles.empty())
    throw Error(path.string() + ": there are no faces in it");
  return std::move(reading.result);
}

void write_obj(const std::filesystem::path& path, const LabelledMesh& labelled,
               const ObjParams& params) {
  check(labelled, params.texture, path);
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  if (!params.material_library.empty()) fmt::format_to(out, "mtllib {}\n", params.material_library);
  for (const Eigen::Vector3f& v : labelled.mesh.vertices)
    fmt::format_to(out, "v {} {} {}\n", v.x(), v.y(), v.z());
  for (const Eigen::Vector2f& p : params.texture.places)
    fmt::format_to(out, "vt {:.4f} {:.4f}\n", p.x(), p.y());
  for (std::size_t i = 0; i < labelled.mesh.triangles.size(); ++i) {
    const std::uint32_t group = labelled.group[i];
    if (i == 0 || group != labelled.group[i - 1])
      fmt::format_to(out, "usemtl {}\n", labelled.names[group]);
    fmt::format_to(out, "f");
    for (std::size_t k = 0; k < 3; ++k) {
      // Up to 2^32: one more than fits the type.
      fmt::format_to(out, " {}", std::uint64_t{labelled.mesh.triangles[i][k]} + 1);
      if (params.texture.corners.empty()) continue;
      if (const std::uint32_t place = params.texture.corners[i][k];
          place != TextureCoordinates::none)
        fmt::format_to(out, "/{}", std::uint64_t{place} + 1);
    }
    text.push_back('\n');
  }
  write_file_atomically(path, {text.data(), text.size()});
}

}  // namespace planum
