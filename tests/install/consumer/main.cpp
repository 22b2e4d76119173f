// A user of the installed libraries: one call into each of them.
#include <cstdio>
#include <vector>

#include "labeling/labels.hpp"
#include "meshing/triangulation.hpp"
#include "slam/core/kd_tree.hpp"
#include "slam/evaluation/trajectory_error.hpp"
#include "slam/graph/pose_graph.hpp"
#include "slam/io/text_reader.hpp"
#include "slam/registration/icp.hpp"
#include "slam/sensor/tilted_laser.hpp"

int main() {
  const std::vector<Eigen::Vector3f> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const planum::KdTree tree(points);
  const auto nearest = tree.nearest({0.9f, 0.1f, 0.0f}, 1.0f);
  const planum::PolygonMap map{
      .vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      .polygons = {{.outer = {0, 1, 2, 3}, .area = 1}},
      .rest = {},
  };
  const auto labels = planum::label(map);
  const auto triangles = planum::triangulated(map);
  const planum::MatchingScan scan = planum::matching_scan({});
  const bool works = nearest && nearest->index == 1 && labels.polygons.size() == 1 &&
                     triangles.mesh.triangles.size() == 2 && scan.points.empty();
  std::puts(works ? "planum works from outside" : "planum does not work from outside");
  return works ? 0 : 1;
}
