#include "labeling/objects/object_models.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "labeling/objects/model_surface.hpp"
#include "slam/core/error.hpp"
#include "slam/core/kd_tree.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr int directions = 4;
constexpr std::size_t most_places = 6;       // that a model is looked at from
constexpr std::size_t most_pairs = 400;      // of ICP
constexpr std::size_t most_looked_at = 800;  // points of a model
constexpr double cut_off = 0.06;             // m above the floor: points there belong to it

void check(std::span<const ObjectModel> models, const MatchParams& params) {
  const auto fail = [](const std::string& what) { throw Error("models: " + what); };
  const auto check_length = [&](const char* option, double value) {
    if (!(value >= 0.005 && value <= 1))
      fail(fmt::format("{} is {} m, must be 0.005 to 1", option, value));
  };
  check_length("tolerance", params.tolerance);
  check_length("spacing", params.spacing);
  check_length("first_gate", params.first_gate);
  if (!(params.min_score >= 0 && params.min_score <= 1))
    fail(fmt::format("min_score is {}, must be 0 to 1", params.min_score));
  if (params.max_iterations < 1)
    fail(fmt::format("max_iterations is {}, must be at least 1", params.max_iterations));
  for (const ObjectModel& model : models) {
    if (surface_samples(model.mesh, params.spacing).points.empty())
      fail("'" + model.name + "' has no surface");
    if (!(model.min_scale.array() > 0).all() ||
        !(model.max_scale.array() >= model.min_scale.array()).all())
      fail("'" + model.name + "' has scales that are not 0 < min_scale <= max_scale");
  }
}

void check(const Cloud& cloud, std::span<const Eigen::Vector3d> scan_origins) {
  if (cloud.scan.size() != cloud.points.size())
    throw Error("models: the cloud needs a scan index for each point");
  for (const std::uint32_t scan : cloud.scan)
    if (scan >= scan_origins.size())
      throw Error(fmt::format("models: a point is of scan {}, but there are {} scans", scan,
                              scan_origins.size()));
}

/// The middles of the points in each cell of an edge (m), in a frame.
Points thinned(const Cloud& cloud, const std::vector<std::uint32_t>& indices,
               const Pose& frame_from_world, double edge) {
  struct Place {
    std::uint64_t cell;
    Eigen::Vector3f p;
  };
  std::vector<Place> places;
  for (const std::uint32_t i : indices) {
    const Eigen::Vector3d p = frame_from_world * cloud.points[i].cast<double>();
    // Objects are smaller than 2^19 cells to either side.
    const auto at = ((p / edge).array().floor() + (1 << 20)).cast<std::uint64_t>().eval();
    places.push_back({at.z() << 42 | at.y() << 21 | at.x(), p.cast<float>()});
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.cell < b.cell; });
  Points middles;
  for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (end = begin; end < places.size() && places[end].cell == places[begin].cell; ++end)
      sum += places[end].p;
    middles.push_back(sum / static_cast<float>(end - begin));
  }
  return middles;
}

/// An object in the frame of its box, and the places it was seen from there.
struct Target {
  OrientedBox box;
  Points points;
  KdTree tree;
  std::vector<Eigen::Vector3d> places;
};

/// The scans that have most of an object's points, the foremost first.
std::vector<std::uint32_t> main_scans(const SceneObject& object, const Cloud& cloud) {
  std::map<std::uint32_t, std::size_t> counts;
  for (const std::uint32_t i : object.points) ++counts[cloud.scan[i]];
  std::vector<std::pair<std::size_t, std::uint32_t>> scans;
  for (const auto& [scan, count] : counts) scans.emplace_back(count, scan);
  std::stable_sort(scans.begin(), scans.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::uint32_t> result;
  for (const auto& [count, scan] : scans)
    if (result.size() < most_places && count > scans[0].first / 20) result.push_back(scan);
  return result;
}

Target target_of(const SceneObject& object, const Cloud& cloud,
                 std::span<const Eigen::Vector3d> scan_origins, double spacing) {
  const Pose box_from_world = object.box.world_from_box().inverse();
  std::vector<Eigen::Vector3d> places;
  for (const std::uint32_t scan : main_scans(object, cloud))
    places.push_back(box_from_world * scan_origins[scan]);
  Points points = thinned(cloud, object.points, box_from_world, spacing);
  return {object.box, points, KdTree(points), std::move(places)};
}

/// A model of a certain size, and its direction in the box.
struct Candidate {
  Eigen::Vector3d scale;
  double turn = 0;  ///< rad
};

/// Empty if the model cannot be as large as the object.
std::optional<Candidate> candidate(const ObjectModel& model, const Eigen::Vector3d& box_size,
                                   int direction) {
  constexpr double too_small = 0.15, too_large = 0.3;  // m
  Eigen::Vector3d wanted = box_size;
  if (direction % 2 == 1) std::swap(wanted.x(), wanted.y());
  const Eigen::Vector3d size = bounds(model.mesh).sizes();
  const Eigen::Array3d scale = (wanted.array() / size.array().max(1e-6))
                                   .max(model.min_scale.array())
                                   .min(model.max_scale.array());
  const Eigen::Array3d larger = scale * size.array() - wanted.array();
  if ((larger < -too_small).any() || (larger > too_large).any()) return std::nullopt;
  return Candidate{scale.matrix(), direction * pi / 2};
}

/// Moves the model in the plane until it lies on the points: Chen & Medioni 1992 for the two
/// shifts and the turn that are left to what stands on a floor.
Pose aligned(const Points& points, const SurfaceSamples& model, const KdTree& tree,
             Pose model_from_box, const MatchParams& params) {
  constexpr double damping = 1e-3;  // of planes that do not hold all three
  for (int iteration = 0; iteration < params.max_iterations; ++iteration) {
    const double gate = std::max(2 * params.tolerance,
                                 params.first_gate * (1 - 2.0 * iteration / params.max_iterations));
    Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
    double pairs = 0;
    for (const Eigen::Vector3f& point : points) {
      const Eigen::Vector3d p = model_from_box * point.cast<double>();
      const auto nearest = tree.nearest(p.cast<float>(), static_cast<float>(gate));
      if (!nearest) continue;
      const Eigen::Vector3d n = model.normals[nearest->index].cast<double>();
      const double residual = n.dot(p - model.points[nearest->index].cast<double>());
      const Eigen::Vector3d row(n.x(), n.y(), n.y() * p.x() - n.x() * p.y());
      normal_matrix += row * row.transpose();
      right_side -= residual * row;
      pairs += 1;
    }
    if (pairs == 0) break;
    normal_matrix.diagonal().array() += damping * pairs;
    const Eigen::Vector3d step = normal_matrix.ldlt().solve(right_side);
    model_from_box = Eigen::Translation3d(step.x(), step.y(), 0) *
                     Eigen::AngleAxisd(step.z(), Eigen::Vector3d::UnitZ()) * model_from_box;
    if (step.norm() < 1e-4) break;
  }
  return model_from_box;
}

/// At most about `most` of the items, evenly.
template <class Item>
std::vector<Item> some_of(const std::vector<Item>& items, std::size_t most) {
  std::vector<Item> result;
  for (std::size_t i = 0; i < items.size(); i += 1 + items.size() / most)
    result.push_back(items[i]);
  return result;
}

double share_near(const Points& points, const KdTree& tree, double distance) {
  const auto near = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3f& p) {
    return tree.nearest(p, static_cast<float>(distance)).has_value();
  });
  return points.empty() ? 0 : static_cast<double>(near) / static_cast<double>(points.size());
}

TriangleMesh moved(TriangleMesh mesh, const Pose& b_from_a) {
  for (Eigen::Vector3f& p : mesh.vertices) p = (b_from_a * p.cast<double>()).cast<float>();
  return mesh;
}

/// The model in the box frame; its pose there is still in `world_from_model`.
ModelMatch fitted(const Target& target, const ObjectModel& model, const Candidate& start,
                  const MatchParams& params) {
  const TriangleMesh mesh = scaled(model.mesh, start.scale);
  const SurfaceSamples samples = surface_samples(mesh, params.spacing);
  const KdTree tree(samples.points);
  const Pose model_from_box =
      aligned(some_of(target.points, most_pairs), samples, tree,
              Pose(Eigen::AngleAxisd(-start.turn, Eigen::Vector3d::UnitZ())), params);
  Points in_model;
  for (const Eigen::Vector3f& p : some_of(target.points, most_looked_at))
    in_model.push_back((model_from_box * p.cast<double>()).cast<float>());
  std::vector<Eigen::Vector3d> places;
  for (const Eigen::Vector3d& place : target.places) places.push_back(model_from_box * place);

  ModelMatch match{model.name, model_from_box.inverse(), start.scale, 0, 0, {}};
  match.explained = share_near(in_model, tree, params.tolerance);
  if (match.explained < params.min_score) return match;
  const SurfaceSamples faces{some_of(samples.points, most_looked_at),
                             some_of(samples.normals, most_looked_at)};
  const std::vector<bool> visible = are_visible(faces, mesh, places);
  Points looked_at;
  for (std::size_t i = 0; i < faces.points.size(); ++i)
    if (visible[i] && faces.points[i].z() > cut_off)
      looked_at.push_back((match.world_from_model * faces.points[i].cast<double>()).cast<float>());
  match.seen = share_near(looked_at, target.tree, params.tolerance);
  match.surface = moved(mesh, match.world_from_model);
  return match;
}

std::optional<ModelMatch> best_match(const Target& target, std::span<const ObjectModel> models,
                                     const MatchParams& params) {
  std::optional<ModelMatch> best;
  for (const ObjectModel& model : models)
    for (int direction = 0; direction < directions; ++direction) {
      const auto start = candidate(model, target.box.size, direction);
      if (!start) continue;
      ModelMatch match = fitted(target, model, *start, params);
      if (match.score() >= params.min_score && (!best || match.score() > best->score()))
        best = std::move(match);
    }
  if (!best) return best;
  const Pose world_from_box = target.box.world_from_box();
  best->world_from_model = world_from_box * best->world_from_model;
  best->surface = moved(best->surface, world_from_box);
  return best;
}

}  // namespace

std::vector<SceneObject> with_models(std::vector<SceneObject> objects, const Cloud& cloud,
                                     std::span<const Eigen::Vector3d> scan_origins,
                                     std::span<const ObjectModel> models,
                                     const MatchParams& params) {
  check(models, params);
  check(cloud, scan_origins);
  parallel_for(objects.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!objects[i].is_on_floor) continue;
      objects[i].model =
          best_match(target_of(objects[i], cloud, scan_origins, params.spacing), models, params);
    }
  });
  return objects;
}

}  // namespace planum
