#include "slam/io/g2o.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_set>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/pose_text.hpp"

namespace planum {
namespace {

constexpr std::string_view vertex_tag = "VERTEX_SE3:QUAT";
constexpr std::string_view edge_tag = "EDGE_SE3:QUAT";

int read_id(TextReader& reader) {
  const long long id = reader.integer();
  if (id < 0 || id > std::numeric_limits<int>::max())
    reader.fail(fmt::format("expected a vertex id from 0 to {}, got {}",
                            std::numeric_limits<int>::max(), id));
  return static_cast<int>(id);
}

G2oVertex read_vertex(TextReader& reader) {
  G2oVertex vertex;
  vertex.id = read_id(reader);
  std::array<double, 7> pose;
  reader.all_numbers(pose, "x y z qx qy qz qw");
  vertex.world_from_vertex = pose_from_quaternion(pose, reader);
  return vertex;
}

G2oEdge read_edge(TextReader& reader) {
  G2oEdge edge;
  edge.from = read_id(reader);
  edge.to = read_id(reader);
  std::array<double, 28> numbers;
  reader.all_numbers(numbers, "x y z qx qy qz qw and the upper half of the information matrix");
  edge.from_from_to = pose_from_quaternion(std::span(numbers).first<7>(), reader);
  if (!std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); }))
    reader.fail("expected finite numbers");
  std::size_t next = 7;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column)
      edge.information(row, column) = edge.information(column, row) = numbers[next++];
  return edge;
}

/// The vertices and edges that were read, and where the edges stood.
struct Reading {
  G2oGraph graph;
  std::vector<std::size_t> edge_lines;
  std::unordered_set<int> ids;
};

void read_line(TextReader& reader, Reading& reading) {
  const std::string_view tag = reader.word();
  if (tag == vertex_tag) {
    reading.graph.vertices.push_back(read_vertex(reader));
    const int id = reading.graph.vertices.back().id;
    if (!reading.ids.insert(id).second) reader.fail(fmt::format("vertex {} is there twice", id));
  } else if (tag == edge_tag) {
    reading.graph.edges.push_back(read_edge(reader));
    reading.edge_lines.push_back(reader.line_number());
  } else if (tag == "FIX") {
    do reading.graph.fixed.push_back(read_id(reader));
    while (!reader.at_end_of_line());
  } else if (!tag.starts_with("PARAMS_")) {
    reader.fail(fmt::format("expected {} or {}, got {} (only 3D pose graphs are read)", vertex_tag,
                            edge_tag, in_quotes(tag)));
  }
}

void check_edges(const Reading& reading, const std::filesystem::path& path) {
  for (std::size_t i = 0; i < reading.graph.edges.size(); ++i) {
    const G2oEdge& edge = reading.graph.edges[i];
    for (const int id : {edge.from, edge.to})
      if (!reading.ids.contains(id))
        throw Error(fmt::format("{}:{}: the edge joins vertex {}, which is not in the file",
                                path.string(), reading.edge_lines[i], id));
  }
}

std::string comment_text(const std::string& comment) {
  std::string text = "# ";
  for (const char c : comment) text += c == '\n' ? std::string("\n# ") : std::string(1, c);
  return text + '\n';
}

/// Scales the rotation part of twists: g2o's error has half the angle.
Matrix6d scaled_rotation(const Matrix6d& information, double factor) {
  Vector6d scale = Vector6d::Ones();
  scale.tail<3>().setConstant(factor);
  return scale.asDiagonal() * information * scale.asDiagonal();
}

}  // namespace

G2oGraph read_g2o(const std::filesystem::path& path) {
  TextReader reader(path);
  Reading reading;
  while (reader.next_line()) {
    if (!reader.is_comment()) {
      read_line(reader, reading);
      continue;
    }
    std::string_view comment = reader.rest().substr(1);
    if (comment.starts_with(' ')) comment.remove_prefix(1);
    reading.graph.comments.emplace_back(comment);
  }
  if (reading.graph.vertices.empty()) throw Error(path.string() + ": there are no vertices in it");
  check_edges(reading, path);
  return std::move(reading.graph);
}

void write_g2o(const std::filesystem::path& path, const G2oGraph& graph) {
  std::string text;
  for (const G2oVertex& vertex : graph.vertices)
    text +=
        fmt::format("{} {} {}\n", vertex_tag, vertex.id, quaternion_text(vertex.world_from_vertex));
  for (const int id : graph.fixed) text += fmt::format("FIX {}\n", id);
  for (const G2oEdge& edge : graph.edges) {
    text += fmt::format("{} {} {} {}", edge_tag, edge.from, edge.to,
                        quaternion_text(edge.from_from_to));
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        text += fmt::format(" {}", edge.information(row, column));
    text += '\n';
  }
  for (const std::string& comment : graph.comments) text += comment_text(comment);
  write_file_atomically(path, text);
}

Matrix6d information_from_g2o(const Matrix6d& information) {
  return scaled_rotation(information, 0.5);
}

Matrix6d g2o_from_information(const Matrix6d& information) {
  return scaled_rotation(information, 2);
}

}  // namespace planum
