#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace planum {

/// A layer and the index of its colour (AutoCAD's: 1 red, 2 yellow ... 7 black or white).
struct DxfLayer {
  std::string name;
  int colour = 7;
};

/// Collects entities and writes them as an ASCII DXF file of AutoCAD 2000 (AC1015), in metres.
/// Lines are drawn dashed where told; layers must be among those given at first.
class DxfDocument {
 public:
  explicit DxfDocument(std::vector<DxfLayer> layers);

  void add_line(const std::string& layer, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                bool is_dashed = false);
  void add_closed_polyline(const std::string& layer, const std::vector<Eigen::Vector2d>& corners);

  /// Counter-clockwise between two angles, rad.
  void add_arc(const std::string& layer, const Eigen::Vector2d& centre, double radius, double from,
               double to, bool is_dashed = false);

  /// Words (UTF-8) centred on their baseline; height (m) of a capital letter, turn in rad.
  void add_text(const std::string& layer, const Eigen::Vector2d& place, double height, double turn,
                const std::string& words);

  /// The whole file; `extent` is what is shown first, `comment` one line.
  std::string written(const Eigen::AlignedBox2d& extent, const std::string& comment) const;

 private:
  void begin_entity(const char* type, const std::string& layer, bool is_dashed);

  std::vector<DxfLayer> layers_;
  std::string entities_;
  unsigned next_handle_;
};

}  // namespace planum
