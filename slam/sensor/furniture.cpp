#include "slam/sensor/furniture.hpp"

#include <Eigen/Geometry>

namespace planum {
namespace {

/// A box of a piece of furniture, in that piece's own frame.
struct Part {
  Eigen::Vector3d base;  ///< m
  Eigen::Vector3d size;  ///< m
};

std::vector<Box> placed(const std::vector<Part>& parts, const Eigen::Vector2d& centre,
                        double turn) {
  const Eigen::Rotation2Dd rotation(turn);
  std::vector<Box> boxes;
  for (const Part& part : parts) {
    const Eigen::Vector2d base = centre + rotation * part.base.head<2>();
    boxes.push_back({{base.x(), base.y(), part.base.z()}, part.size, turn});
  }
  return boxes;
}

/// Four square legs whose outer faces are flush with a rectangle.
std::vector<Part> legs(const Eigen::Vector2d& size, double thickness, double height) {
  std::vector<Part> parts;
  const Eigen::Vector2d reach = (size - Eigen::Vector2d::Constant(thickness)) / 2;
  for (const double x : {-reach.x(), reach.x()})
    for (const double y : {-reach.y(), reach.y()})
      parts.push_back({{x, y, 0}, {thickness, thickness, height}});
  return parts;
}

}  // namespace

std::vector<Box> table(const Eigen::Vector2d& centre, const Eigen::Vector2d& size, double turn) {
  std::vector<Part> parts = legs(size, 0.06, 0.71);
  parts.push_back({{0, 0, 0.71}, {size.x(), size.y(), 0.03}});
  return placed(parts, centre, turn);
}

std::vector<Box> chair(const Eigen::Vector2d& centre, double turn) {
  std::vector<Part> parts = legs({0.42, 0.42}, 0.04, 0.43);
  parts.push_back({{0, 0, 0.43}, {0.42, 0.42, 0.04}});
  parts.push_back({{-0.19, 0, 0.47}, {0.04, 0.42, 0.43}});
  return placed(parts, centre, turn);
}

std::vector<Box> cabinet(const Eigen::Vector2d& centre, const Eigen::Vector2d& size, double height,
                         double turn) {
  return placed({{{0, 0, 0}, {size.x(), size.y(), height}}}, centre, turn);
}

std::vector<Box> sofa(const Eigen::Vector2d& centre, double length, double turn) {
  const double arm = (length - 0.16) / 2;
  return placed({{{0, 0.08, 0}, {length - 0.32, 0.72, 0.42}},
                 {{0, -0.36, 0}, {length - 0.32, 0.16, 0.82}},
                 {{-arm, 0, 0}, {0.16, 0.88, 0.6}},
                 {{arm, 0, 0}, {0.16, 0.88, 0.6}}},
                centre, turn);
}

}  // namespace planum
