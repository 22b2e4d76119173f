#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "labeling/rooms/opening_edges.hpp"
#include "labeling/rooms/opening_search.hpp"
#include "labeling/rooms/region_faces.hpp"
#include "labeling/rooms/room_regions.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

enum class OpeningKind {
  door,     ///< from the floor up, as wide as a door or a pair of doors
  window,   ///< above a sill
  passage,  ///< from the floor up and wider
};

/// "door", "window" or "passage".
const char* name(OpeningKind kind);

/// A hole in a wall.
struct Opening {
  OpeningKind kind = OpeningKind::door;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, the middle, halfway through the wall
  Eigen::Vector3d across = Eigen::Vector3d::UnitX();   ///< unit, horizontal, through the wall
  double width = 0;                                    ///< m, between the jambs
  double height = 0;                                   ///< m, from sill (or floor) to lintel
  double sill = 0;                                     ///< m above the floor; 0 for doors
  double thickness = 0;                                ///< m, of the wall; 0 where not known
  std::vector<std::size_t>
      rooms;  ///< the one or two rooms it belongs to (regions: see find_openings)
};

struct OpeningParams {
  double min_sill = 0.30;  ///< m, higher ones are windows
  double max_unseen_sill =
      0.60;                      ///< m, nothing seen below: the wall under an opening may be hidden
  double min_door_width = 0.50;  ///< m
  double min_door_height = 1.50;  ///< m
  double max_door_width = 2.20;   ///< m, wider ones are passages
  double min_beam_drop = 0.35;    ///< m, what hangs less far below the ceiling parts no rooms
  double full_width = 0.8;        ///< of its wall: a passage this wide parts no rooms
  double max_thickness = 0.70;    ///< m between the faces of one wall
  OpeningEdgeParams edges = {};
};

/// Openings, and which regions are one room after all (parted by a beam only).
struct OpeningSet {
  std::vector<Opening> openings;  ///< in the plan frame; `rooms` are regions
  std::vector<std::pair<std::size_t, std::size_t>> joined_regions;
};

/// Pairs the holes found from both sides of a wall, measures them and tells what they are.
OpeningSet find_openings(const Cloud& plan, const FloorGrid& grid,
                         const std::vector<WallFace>& faces,
                         const std::vector<RegionFace>& region_faces, const FaceSamples& samples,
                         const std::vector<FaceOpening>& holes, const RoomRegions& regions,
                         const OpeningParams& params = {});

}  // namespace planum
