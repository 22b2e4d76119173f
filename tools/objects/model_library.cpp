#include "tools/objects/model_library.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>

#include "labeling/objects/model_surface.hpp"
#include "slam/core/error.hpp"
#include "slam/io/obj.hpp"
#include "slam/sensor/furniture.hpp"

namespace planum {
namespace {

/// The six faces of a box that is not turned.
void add(const Box& box, TriangleMesh& mesh) {
  // Corners are numbered by their bits: x, y, z.
  constexpr std::array<std::array<std::uint32_t, 4>, 6> faces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d share((corner & 1) - 0.5, ((corner >> 1) & 1) - 0.5, corner >> 2);
    mesh.vertices.push_back((box.base + share.cwiseProduct(box.size)).cast<float>());
  }
  for (const auto& [a, b, c, d] : faces) {
    mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.triangles.push_back({first + a, first + c, first + d});
  }
}

TriangleMesh mesh_of(const std::vector<Box>& boxes) {
  TriangleMesh mesh;
  for (const Box& box : boxes) add(box, mesh);
  return mesh;
}

/// With the origin in the middle of the underside.
TriangleMesh centred(TriangleMesh mesh) {
  const Eigen::AlignedBox3d box = bounds(mesh);
  const Eigen::Vector3f origin =
      Eigen::Vector3d(box.center().x(), box.center().y(), box.min().z()).cast<float>();
  for (Eigen::Vector3f& p : mesh.vertices) p -= origin;
  return mesh;
}

}  // namespace

std::vector<ObjectModel> built_in_models() {
  return {{"table", mesh_of(table({0, 0}, {1.2, 0.8})), {0.4, 0.5, 0.9}, {2.5, 1.6, 1.1}},
          {"chair", mesh_of(chair({0, 0})), {0.85, 0.85, 0.85}, {1.3, 1.3, 1.2}},
          {"cabinet", mesh_of(cabinet({0, 0}, {1, 0.5}, 1)), {0.35, 0.5, 0.4}, {3, 1.6, 2.3}}};
}

std::vector<std::filesystem::path> model_files(const std::filesystem::path& directory) {
  if (!std::filesystem::is_directory(directory))
    throw Error(directory.string() + ": no such directory of models");
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory))
    if (entry.path().extension() == ".obj") files.push_back(entry.path());
  if (files.empty()) throw Error(directory.string() + ": no .obj files");
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<ObjectModel> read_models(const std::vector<std::filesystem::path>& files) {
  std::vector<ObjectModel> models;
  for (const std::filesystem::path& file : files)
    models.push_back({file.stem().string(), centred(read_obj(file).mesh)});
  return models;
}

}  // namespace planum
