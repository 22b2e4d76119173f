#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "labeling/rooms/rooms.hpp"

namespace planum {

/// What a piece of a floor plan stands for.
enum class PlanPart {
  room,       ///< its outline
  doorway,    ///< the hole of a door or passage in the wall
  leaf,       ///< of a door, open
  swing,      ///< the way of a leaf
  passage,    ///< edges of a hole without a door
  window,     ///< its hole, and the pane in it
  dimension,  ///< a dimension line with its ticks
  room_name,
  room_size,
  measure,  ///< a length in metres
};

struct PlanPolygon {
  PlanPart part = PlanPart::room;
  std::vector<Eigen::Vector2d> corners;  ///< m, counter-clockwise
};

struct PlanLine {
  PlanPart part = PlanPart::dimension;
  Eigen::Vector2d from, to;  ///< m
};

/// A quarter of a circle, counter-clockwise.
struct PlanQuarter {
  PlanPart part = PlanPart::swing;
  Eigen::Vector2d centre, from, to;  ///< m
};

/// Words whose baseline is centred at a place.
struct PlanText {
  PlanPart part = PlanPart::measure;
  Eigen::Vector2d place;  ///< m
  double turn = 0;        ///< rad, counter-clockwise; the text is read from below or the right
  double size = 0;        ///< m, of the font
  std::string words;      ///< UTF-8
};

/// What the floor plan of a storey shows. x and y are those of the world, turned about its origin
/// so that the largest room of the building lies along x: plans of several storeys fit onto each
/// other.
struct PlanDrawing {
  double turn = 0;                    ///< rad, counter-clockwise, from the world to the plan
  Eigen::AlignedBox2d paper;          ///< m, the drawing and a margin; the same for all storeys
  std::vector<PlanPolygon> polygons;  ///< later ones cover earlier ones, lines cover polygons
  std::vector<PlanLine> lines;
  std::vector<PlanQuarter> quarters;
  std::vector<PlanText> texts;
};

/// Draws the rooms of a storey: outlines, names, areas, width and depth between walls as dimension
/// lines, doors with a leaf and its swing (which side it is hung on is not known: the drawing
/// assumes one), windows, passages. Throws Error if the storey has no room.
PlanDrawing plan_drawing(const RoomMap& rooms, std::size_t storey);

}  // namespace planum
