#include "tools/planum/relations_file.hpp"

#include <array>
#include <cmath>

#include "slam/core/error.hpp"
#include "slam/io/g2o.hpp"
#include "slam/io/text_reader.hpp"

namespace planum {
namespace {

std::vector<Relation> edges_of(const G2oGraph& graph) {
  std::vector<Relation> relations;
  for (const G2oEdge& edge : graph.edges)
    relations.push_back({.from = static_cast<double>(edge.from),
                         .to = static_cast<double>(edge.to),
                         .from_from_to = edge.from_from_to});
  return relations;
}

std::vector<Relation> lines_of(const std::filesystem::path& path) {
  TextReader reader(path);
  std::vector<Relation> relations;
  while (reader.next_data_line()) {
    std::array<double, 8> v{};
    reader.all_numbers(v, "from to x y z roll pitch yaw");
    for (const double value : v)
      if (!std::isfinite(value)) reader.fail("a number is not finite");
    relations.push_back({.from = v[0],
                         .to = v[1],
                         .from_from_to = pose_from_xyz_ypr({v[2], v[3], v[4]}, v[7], v[6], v[5])});
  }
  return relations;
}

}  // namespace

std::vector<Relation> read_relations(const std::filesystem::path& path) {
  std::vector<Relation> relations =
      path.extension() == ".g2o" ? edges_of(read_g2o(path, LooseEdges::allowed)) : lines_of(path);
  if (relations.empty()) throw Error(path.string() + ": no relation in it");
  return relations;
}

}  // namespace planum
