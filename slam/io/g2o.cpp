#include "slam/io/g2o.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <unordered_set>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/planar_pose.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/pose_text.hpp"

namespace planum {
namespace {

constexpr std::string_view spatial_vertex = "VERTEX_SE3:QUAT";
constexpr std::string_view spatial_edge = "EDGE_SE3:QUAT";
constexpr std::string_view planar_vertex = "VERTEX_SE2";
constexpr std::string_view planar_edge = "EDGE_SE2";

/// Where x, y and heading are among the six directions of a twist.
constexpr std::array<int, 3> planar_rows = {0, 1, 5};

int read_id(TextReader& reader) {
  const long long id = reader.integer();
  if (id < 0 || id > std::numeric_limits<int>::max())
    reader.fail(fmt::format("expected a vertex id from 0 to {}, got {}",
                            std::numeric_limits<int>::max(), id));
  return static_cast<int>(id);
}

void check_finite(std::span<const double> numbers, const TextReader& reader) {
  if (!std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); }))
    reader.fail("expected finite numbers");
}

Pose planar_pose(std::span<const double, 3> numbers) {
  return lifted({.position = {numbers[0], numbers[1]}, .heading = numbers[2]});
}

G2oVertex read_vertex(TextReader& reader, bool planar) {
  G2oVertex vertex;
  vertex.id = read_id(reader);
  if (planar) {
    std::array<double, 3> pose;
    reader.all_numbers(pose, "x y heading");
    check_finite(pose, reader);
    vertex.world_from_vertex = planar_pose(pose);
  } else {
    std::array<double, 7> pose;
    reader.all_numbers(pose, "x y z qx qy qz qw");
    vertex.world_from_vertex = pose_from_quaternion(pose, reader);
  }
  return vertex;
}

void read_planar_measurement(TextReader& reader, G2oEdge& edge) {
  std::array<double, 9> numbers;
  reader.all_numbers(numbers, "x y heading and the upper half of the information matrix");
  check_finite(numbers, reader);
  edge.from_from_to = planar_pose(std::span(numbers).first<3>());
  edge.information.setZero();
  std::size_t next = 3;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = row; column < 3; ++column) {
      const int i = planar_rows[row], j = planar_rows[column];
      edge.information(i, j) = edge.information(j, i) = numbers[next++];
    }
}

void read_measurement(TextReader& reader, G2oEdge& edge) {
  std::array<double, 28> numbers;
  reader.all_numbers(numbers, "x y z qx qy qz qw and the upper half of the information matrix");
  edge.from_from_to = pose_from_quaternion(std::span(numbers).first<7>(), reader);
  check_finite(numbers, reader);
  std::size_t next = 7;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column)
      edge.information(row, column) = edge.information(column, row) = numbers[next++];
}

G2oEdge read_edge(TextReader& reader, bool planar) {
  G2oEdge edge;
  edge.from = read_id(reader);
  edge.to = read_id(reader);
  edge.line = reader.line_number();
  if (edge.from == edge.to)
    reader.fail(fmt::format("the edge joins vertex {} with itself", edge.from));
  if (planar)
    read_planar_measurement(reader, edge);
  else
    read_measurement(reader, edge);
  return edge;
}

/// What was read so far.
struct Reading {
  G2oGraph graph;
  std::unordered_set<int> ids;
  std::vector<std::size_t> fixed_lines;
};

void check_kind(const TextReader& reader, Reading& reading, bool planar) {
  if (reading.graph.vertices.empty() && reading.graph.edges.empty()) reading.graph.planar = planar;
  if (reading.graph.planar != planar)
    reader.fail("a graph is either 3D (SE3:QUAT) or 2D (SE2), but this file has both");
}

void read_line(TextReader& reader, Reading& reading) {
  const std::string_view tag = reader.word();
  const bool planar = tag == planar_vertex || tag == planar_edge;
  if (tag == spatial_vertex || tag == planar_vertex) {
    check_kind(reader, reading, planar);
    reading.graph.vertices.push_back(read_vertex(reader, planar));
    const int id = reading.graph.vertices.back().id;
    if (!reading.ids.insert(id).second) reader.fail(fmt::format("vertex {} is there twice", id));
  } else if (tag == spatial_edge || tag == planar_edge) {
    check_kind(reader, reading, planar);
    reading.graph.edges.push_back(read_edge(reader, planar));
  } else if (tag == "FIX") {
    do {
      reading.graph.fixed.push_back(read_id(reader));
      reading.fixed_lines.push_back(reader.line_number());
    } while (!reader.at_end_of_line());
  } else if (!tag.starts_with("PARAMS_")) {
    reader.fail(fmt::format("expected {}, {}, {}, {} or FIX, got {}", spatial_vertex, spatial_edge,
                            planar_vertex, planar_edge, in_quotes(tag)));
  }
}

void check_ids(const Reading& reading, const std::filesystem::path& path, LooseEdges loose_edges) {
  for (const G2oEdge& edge : reading.graph.edges)
    for (const int id : {edge.from, edge.to})
      if (loose_edges == LooseEdges::forbidden && !reading.ids.contains(id))
        throw Error(fmt::format("{}:{}: the edge joins vertex {}, which is not in the file",
                                path.string(), edge.line, id));
  for (std::size_t i = 0; i < reading.graph.fixed.size(); ++i)
    if (!reading.ids.contains(reading.graph.fixed[i]))
      throw Error(fmt::format("{}:{}: vertex {} is to stay fixed, but is not in the file",
                              path.string(), reading.fixed_lines[i], reading.graph.fixed[i]));
}

void append_upper_half(std::string& text, const Matrix6d& information, std::span<const int> rows) {
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (std::size_t column = row; column < rows.size(); ++column)
      text += fmt::format(" {}", information(rows[row], rows[column]));
}

std::string planar_text(const Pose& pose) {
  const PlanarPose planar = flattened(pose);
  return fmt::format("{} {} {}", planar.position.x(), planar.position.y(), planar.heading);
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

G2oGraph read_g2o(const std::filesystem::path& path, LooseEdges loose_edges) {
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
  const bool edges_suffice = loose_edges == LooseEdges::allowed && !reading.graph.edges.empty();
  if (reading.graph.vertices.empty() && !edges_suffice)
    throw Error(path.string() + ": there are no vertices in it");
  check_ids(reading, path, loose_edges);
  return std::move(reading.graph);
}

void write_g2o(const std::filesystem::path& path, const G2oGraph& graph) {
  constexpr std::array<int, 6> spatial_rows = {0, 1, 2, 3, 4, 5};
  const std::span<const int> rows =
      graph.planar ? std::span<const int>(planar_rows) : std::span<const int>(spatial_rows);
  const auto pose_text = graph.planar ? planar_text : quaternion_text;
  std::string text;
  for (const G2oVertex& vertex : graph.vertices)
    text += fmt::format("{} {} {}\n", graph.planar ? planar_vertex : spatial_vertex, vertex.id,
                        pose_text(vertex.world_from_vertex));
  for (const int id : graph.fixed) text += fmt::format("FIX {}\n", id);
  for (const G2oEdge& edge : graph.edges) {
    text += fmt::format("{} {} {} {}", graph.planar ? planar_edge : spatial_edge, edge.from,
                        edge.to, pose_text(edge.from_from_to));
    append_upper_half(text, edge.information, rows);
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
