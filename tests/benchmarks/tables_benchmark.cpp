// The three tables of Wiemann et al. 2010 for a dataset at its true poses: run time and
// compression, plane extraction beside the collapse of edges, and the dimensions of rooms and
// doors.
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "labeling/rooms/rooms.hpp"
#include "meshing/normals.hpp"
#include "meshing/polygons.hpp"
#include "meshing/surface.hpp"
#include "meshing/triangulation.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tests/benchmarks/decimation.hpp"
#include "tests/benchmarks/model_errors.hpp"
#include "tests/benchmarks/true_dataset.hpp"

namespace {

using namespace planum;
using namespace planum::testing;

constexpr int runs = 3;
constexpr double room_gate = 1.5, door_gate = 1.0;  // m

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double seconds_of(const std::function<void()>& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

enum Step { normals, surface, regions, polygons, triangulation, step_count };
using StepSeconds = std::array<double, step_count>;

double sum(const StepSeconds& seconds, Step first) {
  return std::accumulate(seconds.begin() + first, seconds.end(), 0.0);
}

/// From points to triangles again.
struct PaperMap {
  TriangleMesh mesh;
  PolygonMap polygons;
  TriangulatedMap triangles;
};

StepSeconds extract_planes(const Cloud& cloud, PaperMap& map) {
  const double voxel = SurfaceParams{}.voxel;
  StepSeconds seconds{};
  Regions planes;
  seconds[regions] =
      seconds_of([&] { planes = grow_planes(map.mesh, cloud, region_params(voxel)); });
  seconds[polygons] =
      seconds_of([&] { map.polygons = polygonize(map.mesh, planes, polygon_params(voxel)); });
  seconds[triangulation] = seconds_of([&] { map.triangles = triangulated(map.polygons); });
  return seconds;
}

StepSeconds generate_map(TrueDataset& data, PaperMap& map) {
  const double normals_seconds =
      seconds_of([&] { data.cloud.normals = estimate_normals(data.cloud, data.origins); });
  const double surface_seconds = seconds_of([&] { map.mesh = reconstruct(data.cloud); });
  StepSeconds seconds = extract_planes(data.cloud, map);
  seconds[normals] = normals_seconds;
  seconds[surface] = surface_seconds;
  return seconds;
}

/// Medians of each step, and of all steps from `first` on.
struct Timing {
  StepSeconds steps{};
  double all = 0;
};

Timing timing(Step first, const std::function<StepSeconds()>& run) {
  std::vector<StepSeconds> seconds(runs);
  std::generate(seconds.begin(), seconds.end(), run);
  const auto median_of = [&](const auto& value) {
    std::vector<double> values;
    for (const StepSeconds& one : seconds) values.push_back(value(one));
    return median(std::move(values));
  };
  Timing result;
  for (std::size_t step = 0; step < step_count; ++step)
    result.steps[step] = median_of([&](const StepSeconds& one) { return one[step]; });
  result.all = median_of([&](const StepSeconds& one) { return sum(one, first); });
  return result;
}

void print_table_1(const TrueDataset& data, const PaperMap& map, const Timing& time) {
  const StepSeconds& s = time.steps;
  fmt::print("\nTable I: run time and compression ({} threads)\n", thread_count());
  fmt::print("  {:>9} {:>9} {:>9} {:>9} {:>9} | {:>8} {:>8} {:>8} {:>8} {:>9} {:>8}\n", "points",
             "faces", "polygons", "triangles", "of these", "normals", "surface", "regions",
             "polygons", "triangles", "all");
  fmt::print("  {:>9} {:>9} {:>9} {:>9} {:>9} | {:>6.2f} s {:>6.2f} s {:>6.2f} s {:>6.2f} s ",
             data.cloud.points.size(), map.mesh.triangles.size(), map.polygons.polygons.size(),
             map.triangles.mesh.triangles.size(), map.polygons.rest.triangles.size(), s[normals],
             s[surface], s[regions], s[polygons]);
  fmt::print("{:>7.3f} s {:>6.2f} s\n", s[triangulation], time.all);
  fmt::print("  surface: distance and marching cubes; of these: triangles in no plane\n");
}

/// What a way to reduce a mesh gives.
struct Reduction {
  double seconds = 0;
  TriangleMesh mesh;
};

template <template <class> class Module, class Mesh>
Reduction decimated(const OpenMeshCopy<Mesh>& initial, std::size_t triangles) {
  std::vector<double> seconds;
  Reduction result;
  for (int run = 0; run < runs; ++run) {
    Mesh mesh = initial.mesh;
    seconds.push_back(seconds_of([&] { decimate<Module>(mesh, triangles); }));
    result.mesh = mesh_from(mesh);
  }
  result.seconds = median(seconds);
  return result;
}

void print_reduction(const std::string& name, const Reduction& reduction, std::size_t initial,
                     const std::optional<ModelErrors>& truth) {
  const std::size_t count = reduction.mesh.triangles.size();
  fmt::print("  {:<28} {:>7.2f} s {:>9} {:>8.2f} %", name, reduction.seconds, count,
             100 - 100 * static_cast<double>(count) / static_cast<double>(initial));
  if (truth)
    for (const SurfaceError& e : {truth->from(reduction.mesh), truth->to(reduction.mesh)})
      fmt::print(" | {:>7.2f} {:>7.2f} {:>7.2f}", 1000 * e.mean, 1000 * e.rms,
                 1000 * e.percentile_95);
  fmt::print("\n");
}

/// How often the time of plane extraction goes into that of others.
void print_speed(const char* which, double plane_seconds, const Reduction& shortest,
                 const Reduction& quadrics) {
  fmt::print(
      "  {}, {:.3f} s, is {:.1f} times as fast as shortest edges, {:.1f} times as quadrics\n",
      which, plane_seconds, shortest.seconds / plane_seconds, quadrics.seconds / plane_seconds);
}

double plane_seconds_on_one_thread(const Cloud& cloud, PaperMap& map) {
  const int threads = thread_count();
  set_thread_count(1);
  const double seconds = timing(regions, [&] { return extract_planes(cloud, map); }).all;
  set_thread_count(threads);
  return seconds;
}

/// The same with OpenMesh as it is packaged; the meshes are the same.
void print_packaged(const TriangleMesh& initial, std::size_t wanted, double plane_seconds) {
  const auto copy = openmesh_copy<PackagedTriangles>(initial);
  const double seconds = decimated<QuadricModule>(copy, wanted).seconds;
  fmt::print("  quadrics with the assertions of Debian's OpenMesh: {:.3f} s, {:.1f} times\n",
             seconds, seconds / plane_seconds);
}

void print_decimations(PaperMap& map, const TrueDataset& data, double plane_seconds,
                       const std::optional<ModelErrors>& truth) {
  const std::size_t initial = map.mesh.triangles.size();
  const std::size_t wanted = map.triangles.mesh.triangles.size();
  OpenMeshCopy<OpenMeshTriangles> copy;
  const double copying = seconds_of([&] { copy = openmesh_copy<OpenMeshTriangles>(map.mesh); });
  const Reduction shortest = decimated<ShortestEdgeModule>(copy, wanted);
  print_reduction("shortest edges (Melax)", shortest, initial, truth);
  const Reduction quadrics = decimated<QuadricModule>(copy, wanted);
  print_reduction("quadrics (Garland, Heckbert)", quadrics, initial, truth);
  for (const std::size_t times : {2, 5, 20})
    if (times * wanted < initial)
      print_reduction(fmt::format("quadrics, {} times as many", times),
                      decimated<QuadricModule>(copy, times * wanted), initial, truth);
  if (quadrics.mesh.triangles.size() > wanted)
    fmt::print("  collapses end early: no edge is left that can go with the topology kept\n");
  fmt::print("  OpenMesh refused {} of {} faces; making its mesh, {:.3f} s, is not in its times\n",
             copy.refused, initial, copying);
  print_speed("plane extraction", plane_seconds, shortest, quadrics);
  print_speed("plane extraction on one thread, as OpenMesh is",
              plane_seconds_on_one_thread(data.cloud, map), shortest, quadrics);
  print_packaged(map.mesh, wanted, plane_seconds);
}

void print_table_2(const TrueDataset& data, PaperMap& map, double plane_seconds) {
  std::optional<ModelErrors> truth;
  if (data.model && data.model_from_world)
    truth.emplace(*data.model, *data.model_from_world, map.mesh);
  const std::size_t initial = map.mesh.triangles.size();
  fmt::print("\nTable II: the initial mesh reduced to as many triangles{}\n",
             truth ? "; errors in mm: mean, rms, 95 %" : "; no model, so no errors");
  fmt::print("  {:<28} {:>9} {:>9} {:>10}{}\n", "", "time", "triangles", "less",
             truth ? " |    map to building      |    building to map" : "");
  print_reduction("marching cubes", {0, map.mesh}, initial, truth);
  print_reduction("plane extraction", {plane_seconds, map.triangles.mesh}, initial, truth);
  print_decimations(map, data, plane_seconds, truth);
}

/// The position of the place nearest to another within the gate, if there is one.
std::optional<std::size_t> nearest(const std::vector<Eigen::Vector2d>& places,
                                   const Eigen::Vector2d& place, double gate) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double distance = (places[i] - place).norm();
    if (distance < gate) {
      gate = distance;
      best = i;
    }
  }
  return best;
}

Eigen::Vector2d centre_of(const nlohmann::json& object) {
  return {object.at("centre").at(0).get<double>(), object.at("centre").at(1).get<double>()};
}

void print_dimension(const std::string& name, const char* what, double original,
                     std::optional<double> found) {
  fmt::print("  {:<22} {:<14} {:>8.3f} m ", name, what, original);
  if (found)
    fmt::print("{:>10.4f} m {:>+8.1f} mm\n", *found, 1000 * (*found - original));
  else
    fmt::print("{:>12}\n", "not found");
}

void print_rooms(const TrueDataset& data, const std::vector<Room>& rooms) {
  std::vector<Eigen::Vector2d> centres;
  for (const Room& room : rooms)
    centres.push_back((*data.model_from_world * room.centre).head<2>());
  for (const nlohmann::json& room : data.dimensions.at("rooms")) {
    const auto match = nearest(centres, centre_of(room), room_gate);
    const auto print = [&](const char* what, double original, double Room::*size) {
      print_dimension(room.at("name").get<std::string>(), what, original,
                      match ? std::optional(rooms[*match].*size) : std::nullopt);
    };
    const double a = room.at("width").get<double>(), b = room.at("depth").get<double>();
    print("ceiling height", room.at("height").get<double>(), &Room::height);
    print("width", std::min(a, b), &Room::width);
    print("depth", std::max(a, b), &Room::depth);
  }
}

void print_doors(const TrueDataset& data, std::vector<Opening> doors) {
  std::erase_if(doors, [](const Opening& door) { return door.kind != OpeningKind::door; });
  std::vector<Eigen::Vector2d> centres;
  for (const Opening& door : doors)
    centres.push_back((*data.model_from_world * door.position).head<2>());
  for (const nlohmann::json& door : data.dimensions.at("doors")) {
    const auto match = nearest(centres, centre_of(door), door_gate);
    const nlohmann::json& between = door.at("between");
    print_dimension(between.at(0).get<std::string>() + "-" + between.at(1).get<std::string>(),
                    "door width", door.at("width").get<double>(),
                    match ? std::optional(doors[*match].width) : std::nullopt);
  }
}

void print_table_3(const TrueDataset& data, const PaperMap& map) {
  fmt::print("\nTable III: original and reconstructed dimensions\n");
  if (data.dimensions.is_null() || !data.model_from_world) {
    fmt::print("  nothing says what they are (dimensions.json and true_poses.txt)\n");
    return;
  }
  const RoomMap rooms = find_rooms(data.cloud, data.origins, map.polygons);
  fmt::print("  {:<22} {:<14} {:>10} {:>12} {:>11}\n", "", "", "original", "in the map", "off by");
  print_rooms(data, rooms.rooms);
  print_doors(data, rooms.openings);
}

void print_tables(const std::filesystem::path& directory, const std::string& format) {
  TrueDataset data = read_true_dataset(directory, format);
  fmt::print("{}: {} scans at the poses of {}; medians of {} runs\n", directory.string(),
             data.origins.size(), data.poses_from, runs);
  PaperMap map;
  const Timing time = timing(normals, [&] { return generate_map(data, map); });
  print_table_1(data, map, time);
  const Timing planes = timing(regions, [&] { return extract_planes(data.cloud, map); });
  print_table_2(data, map, planes.all);
  print_table_3(data, map);
}

}  // namespace

int main(int argc, char** argv) {
  const auto classroom =
      std::filesystem::path(PLANUM_SOURCE_DIR).parent_path() / "shared/datasets/classroom";
  try {
    print_tables(argc > 1 ? argv[1] : classroom, argc > 2 ? argv[2] : "auto");
  } catch (const Error& error) {
    fmt::print(stderr, "tables_benchmark: {}\n", error.what());
    return 1;
  }
}
