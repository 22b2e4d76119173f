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
  archive(params.pairing, params.first_gate, params.last_gate, params.gate_factor,
          params.max_normal_angle, params.max_iterations, params.tolerance, params.max_points,
          params.min_pairs);
}

template <class Archive>
void fields(Archive& archive, Alignment& alignment) {
  archive(alignment.target_from_source, alignment.information, alignment.rms, alignment.overlap,
          alignment.pairs, alignment.iterations, alignment.weak_directions, alignment.converged);
}

template <class Archive>
void fields(Archive& archive, SequenceStep& step) {
  archive(step.alignment, step.matched, step.reason);
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
  archive(imported.scans, imported.counts, imported.keys, imported.digests, imported.pose_source);
}

}  // namespace planum
