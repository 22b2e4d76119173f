#include <optional>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/g2o.hpp"
#include "slam/io/input_file.hpp"
#include "slam/io/obj.hpp"
#include "slam/io/pcd.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/tum.hpp"
#include "slam/io/uos.hpp"
#include "slam/io/xyz.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/scan_file.hpp"

namespace planum {
namespace {

namespace fs = std::filesystem;

constexpr const char* formats =
    "Points:        .slices .3d .ply .vtk .xyz .pts .asc .dat .txt  ->  .3d .xyz .ply .pcd\n"
    "Meshes:        .obj .ply                                       ->  .obj .ply\n"
    "Trajectories:  .tum .g2o                                       ->  .tum\n"
    "A .slices file becomes points in the frame of the scanner; .txt holds slices or points.";

bool has_faces(const fs::path& file) {
  return read_file(file, 4096).find("element face") != std::string::npos;
}

bool is_mesh(const fs::path& file) {
  const fs::path ending = file.extension();
  return ending == ".obj" || (ending == ".ply" && has_faces(file));
}

bool is_trajectory(const fs::path& file) {
  return file.extension() == ".tum" || file.extension() == ".g2o";
}

[[noreturn]] void throw_unknown(const fs::path& in, const fs::path& out) {
  throw Error(fmt::format("there is no way from {} to {}; what there is:\n{}",
                          in.filename().string(), out.filename().string(), formats),
              ErrorKind::usage);
}

void convert_mesh(const fs::path& in, const fs::path& out) {
  LabelledMesh labelled;
  if (in.extension() == ".obj") {
    labelled = read_obj(in);
  } else {
    labelled.mesh = read_ply_mesh(in);
    labelled.names = {"mesh"};
    labelled.group.assign(labelled.mesh.triangles.size(), 0);
  }
  if (out.extension() == ".obj") return write_obj(out, labelled);
  if (out.extension() == ".ply") return write_ply(out, labelled.mesh);
  throw_unknown(in, out);
}

void convert_trajectory(const fs::path& in, const fs::path& out) {
  if (out.extension() != ".tum") throw_unknown(in, out);
  if (in.extension() == ".tum") return write_tum(out, read_tum(in));
  Trajectory trajectory;
  for (const G2oVertex& vertex : read_g2o(in).vertices) {
    trajectory.push_back({static_cast<double>(vertex.id), vertex.world_from_vertex});
  }
  write_tum(out, trajectory);
}

void convert_points(const fs::path& in, const fs::path& out) {
  const std::optional<Cloud> cloud = read_points_file(in);
  if (!cloud) throw_unknown(in, out);
  if (out.extension() == ".3d") return write_uos_scan(out, *cloud);
  if (out.extension() == ".xyz") return write_xyz(out, *cloud);
  if (out.extension() == ".ply") return write_ply(out, *cloud);
  if (out.extension() == ".pcd") return write_pcd(out, *cloud);
  throw_unknown(in, out);
}

void convert(const fs::path& in, const fs::path& out) {
  if (is_mesh(in)) return convert_mesh(in, out);
  if (is_trajectory(in)) return convert_trajectory(in, out);
  convert_points(in, out);
}

}  // namespace

void add_convert_command(CLI::App& app) {
  struct Arguments {
    fs::path in, out;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("convert", "between file formats, told by their endings");
  command->add_option("IN", arguments->in, "file to read")->required();
  command->add_option("OUT", arguments->out, "file to write")->required();
  command->footer(formats);
  command->callback([arguments] { convert(arguments->in, arguments->out); });
}

}  // namespace planum
