#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/core/progress.hpp"
#include "slam/graph/scan_descriptor.hpp"
#include "slam/graph/scan_plan.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/registration/see_through.hpp"

namespace planum {

/// What the search for places needs of a scan, made once. The scan must outlive it.
struct Place {
  const MatchingScan* scan = nullptr;
  ScanPlan plan = {};
  RangeView view = {};
  ScanDescriptor descriptor = {};
};

Place place_of(const MatchingScan& scan);
std::vector<Place> places_of(std::span<const MatchingScan> scans);

/// What speaks for a relative pose of two scans and against it. All but `contradicted` are the
/// lower of both ways, and good at 1.
struct PoseEvidence {
  double overlap = 0;       ///< share of the surfaces that lie on one of the other scan
  double closeness = 0;     ///< the same of those that have one near them
  double support = 0;       ///< the same of walls across the least certain horizontal direction
  double contradicted = 0;  ///< share that the other scan saw through, see FreeSpaceCheck

  /// The overlap, less (exponentially) where free space contradicts it.
  double score() const;
};

PoseEvidence pose_evidence(const Place& source, const Place& target,
                           const Pose& target_from_source);

struct PlaceSearchParams {
  std::size_t similar = 20;  ///< scans by descriptor that each one is compared with; 0: all
  std::size_t poses = 2;     ///< at most, of a pair
  double least_score = 0.1;  ///< share of surfaces within 0.25 m, less for contradictions
  PlanMatchParams plans = {};
};

/// Two scans that may have seen the same place: a pose to start a match from.
struct PlaceCandidate {
  std::size_t target = 0, source = 0;  ///< target < source
  Pose target_from_source = Pose::Identity();
  double score = 0;
};

/// Looks for pairs of scans of the same place without any poses. Each scan is compared with those
/// of the most similar descriptors; plans of the two (matches_of_plans) give poses, which overlap
/// and free space order. Nothing is verified: see locate(). Best first. The same for any number of
/// threads.
std::vector<PlaceCandidate> find_places(std::span<const Place> places,
                                        const PlaceSearchParams& params = {},
                                        const Progress& progress = {});
std::vector<PlaceCandidate> find_places(std::span<const MatchingScan> scans,
                                        const PlaceSearchParams& params = {},
                                        const Progress& progress = {});

struct LocateParams {
  double min_overlap = 0.3;         ///< see PoseEvidence
  double min_closeness = 0.7;       ///< the same
  double min_support = 0.02;        ///< the same
  double max_contradicted = 0.025;  ///< stricter than where a guess is known
  double max_rival = 0.6;           ///< score of another pose, in that of the best
  std::size_t tried_poses = 6;      ///< are matched, of those that plans give
  std::size_t rough_points = 1500;  ///< of the source in these matches; 0: all
  PlanMatchParams plans = {};
  IcpParams matching = {};  ///< of the last match; its gate is narrowed
};

/// Where one scan lies in the frame of another.
struct Location {
  Alignment alignment;    ///< the best one, found or not
  PoseEvidence evidence;  ///< for it
  bool found = false;
  std::string reason;  ///< why not, e.g. "another pose 3.20 m and 180 deg away suits as well"
};

/// Finds a relative pose of which nothing is known. Poses from the plans of both scans are matched;
/// the one with the best score must pass all limits and have no rival. Throws Error if a parameter
/// is out of range.
Location locate(const Place& source, const Place& target, const LocateParams& params = {});
Location locate(const MatchingScan& source, const MatchingScan& target,
                const LocateParams& params = {});

}  // namespace planum
