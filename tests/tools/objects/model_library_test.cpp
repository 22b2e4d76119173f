#include "tools/objects/model_library.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "labeling/objects/model_surface.hpp"
#include "slam/core/error.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::TemporaryDirectory;

/// Positive if triangles are counter-clockwise seen from outside.
double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += static_cast<double>(mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c]))) / 6;
  return sum;
}

TEST(ModelLibrary, BuiltInModelsStandOnTheOriginAndFaceOutwards) {
  const std::vector<ObjectModel> models = built_in_models();
  ASSERT_EQ(models.size(), 3u);
  EXPECT_EQ(models[0].name, "table");
  EXPECT_EQ(models[1].name, "chair");
  EXPECT_EQ(models[2].name, "cabinet");
  for (const ObjectModel& model : models) {
    const Eigen::AlignedBox3d box = bounds(model.mesh);
    EXPECT_NEAR(box.min().z(), 0, 1e-6) << model.name;
    EXPECT_NEAR(box.center().head<2>().norm(), 0, 1e-6) << model.name;
    EXPECT_GT(volume(model.mesh), 0.01) << model.name;
  }
  EXPECT_NEAR(volume(models[2].mesh), 0.5, 1e-6);
}

TEST(ModelLibrary, ReadsTheModelsOfADirectoryInOrder) {
  const TemporaryDirectory directory;
  for (const char* name : {"stool.obj", "bench.obj", "notes.txt"})
    std::ofstream(directory / name) << "v 1 1 1\nv 3 1 1\nv 1 2 1\nv 1 1 3\nf 1 2 3\nf 1 4 2\n";
  const std::vector<ObjectModel> models = read_models(model_files(directory / "."));
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[0].name, "bench");
  EXPECT_EQ(models[1].name, "stool");
  const Eigen::AlignedBox3d box = bounds(models[0].mesh);
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector3d(-1, -0.5, 0))) << box.min().transpose();
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector3d(1, 0.5, 2))) << box.max().transpose();
  EXPECT_EQ(models[0].max_scale, Eigen::Vector3d::Ones().eval());
}

TEST(ModelLibrary, SaysWhichDirectoryHasNoModels) {
  const TemporaryDirectory directory;
  const auto message = [](const std::filesystem::path& path) -> std::string {
    try {
      model_files(path);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(directory / "."), (directory / ".").string() + ": no .obj files");
  EXPECT_EQ(message(directory / "nowhere"),
            (directory / "nowhere").string() + ": no such directory of models");
}

}  // namespace
}  // namespace planum
