#pragma once

#include "slam/core/cloud.hpp"
#include "slam/sensor/range_limits.hpp"
#include "tools/workflow/archive.hpp"
#include "tools/workflow/digest.hpp"
#include "tools/workflow/results.hpp"

/// The members of everything that is kept between runs, for archive.hpp.
namespace planum {

template <>
struct IsPlain<Digest> : std::true_type {};
template <>
struct IsPlain<ImportCounts> : std::true_type {};  // whole numbers of one size

template <class Archive>
void fields(Archive& archive, Cloud& cloud) {
  archive(cloud.points, cloud.normals, cloud.intensity, cloud.scan);
}

template <class Archive>
void fields(Archive& archive, MatchingScanParams& params) {
  archive(params.voxel, params.coarse_voxel, params.neighbours, params.most_neighbours);
}

template <class Archive>
void fields(Archive& archive, IcpParams& params) {
  archive(params.pairing, params.minimizer, params.first_gate, params.last_gate, params.point_gate,
          params.gate_factor, params.max_normal_angle, params.max_iterations, params.tolerance,
          params.max_points, params.coarse_points, params.min_pairs);
}

template <class Archive>
void fields(Archive& archive, Alignment& alignment) {
  archive(alignment.target_from_source, alignment.information, alignment.rms, alignment.overlap,
          alignment.pairs, alignment.iterations, alignment.weak_directions, alignment.converged);
}

template <class Archive>
void fields(Archive& archive, SequenceStep& step) {
  archive(step.alignment, step.odometry_information, step.matched, step.reason);
}

template <class Archive>
void fields(Archive& archive, SequenceMatch& match) {
  archive(match.poses, match.steps);
}

template <class Archive>
void fields(Archive& archive, ImportedUnit& unit) {
  archive(unit.cloud, unit.counts);
}

/// Without the points: a scan's cloud is a unit of its own.
template <class Archive>
void fields(Archive& archive, Scan& scan) {
  archive(scan.id, scan.number, scan.world_from_scan);
}

template <class Archive>
void fields(Archive& archive, Imported& imported) {
  archive(imported.scans, imported.counts, imported.digests, imported.pose_source);
}

template <class Archive>
void fields(Archive& archive, Edge& edge) {
  archive(edge.from, edge.to, edge.from_from_to, edge.information, edge.odometry_information,
          edge.rms, edge.overlap, edge.kind, edge.accepted, edge.matched, edge.reason);
}

template <class Archive>
void fields(Archive& archive, PoseGraph& graph) {
  archive(graph.poses, graph.edges);
}

template <class Archive>
void fields(Archive& archive, Relaxed& relaxed) {
  archive(relaxed.graph, relaxed.residual_before, relaxed.residual_after, relaxed.iterations,
          relaxed.converged, relaxed.components);
}

template <class Archive>
void fields(Archive& archive, World& world) {
  archive(world.numbers, world.odometry, world.poses, world.is_mapped, world.world_from_input,
          world.up_confidence);
}

template <class Archive>
void fields(Archive& archive, TriangleMesh& mesh) {
  archive(mesh.vertices, mesh.triangles);
}

template <class Archive>
void fields(Archive& archive, MapPolygon& polygon) {
  archive(polygon.plane.normal, polygon.plane.offset, polygon.outer, polygon.holes, polygon.area);
}

template <class Archive>
void fields(Archive& archive, InferredPatch& patch) {
  archive(patch.polygon, patch.shape);
}

template <class Archive>
void fields(Archive& archive, PolygonMap& map) {
  archive(map.vertices, map.polygons, map.rest, map.inferred);
}

template <class Archive>
void fields(Archive& archive, PolygonLabel& label) {
  archive(label.label, label.confidence);
}

template <class Archive>
void fields(Archive& archive, Labels& labels) {
  archive(labels.polygons, labels.up, labels.up_confidence);
}

template <class Archive>
void fields(Archive& archive, Room& room) {
  archive(room.name, room.centre, room.along, room.area, room.width, room.depth, room.height,
          room.outline, room.scans, room.storey);
}

template <class Archive>
void fields(Archive& archive, Opening& opening) {
  archive(opening.kind, opening.position, opening.across, opening.width, opening.height,
          opening.sill, opening.thickness, opening.rooms);
}

template <class Archive>
void fields(Archive& archive, RoomMap& rooms) {
  archive(rooms.storeys, rooms.rooms, rooms.openings, rooms.room_of_polygon);
}

template <class Archive>
void fields(Archive& archive, OrientedBox& box) {
  archive(box.centre, box.along, box.size);
}

template <class Archive>
void fields(Archive& archive, ModelMatch& match) {
  archive(match.name, match.world_from_model, match.scale, match.explained, match.seen,
          match.surface);
}

template <class Archive>
void fields(Archive& archive, SceneObject& object) {
  bool has_model = object.model.has_value();
  archive(object.box, object.room, object.is_on_floor, object.points, object.polygons, has_model);
  if (!has_model) return;
  if (!object.model) object.model.emplace();
  archive(*object.model);
}

template <class Archive>
void fields(Archive& archive, Labelled& labelled) {
  archive(labelled.labels, labelled.rooms, labelled.objects);
}

}  // namespace planum
