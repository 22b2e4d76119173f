#include "tools/planum/comparison.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace planum {
namespace {

constexpr double room_gate = 1.5, door_gate = 1.0;  // m

/// For each true place the nearest found one within the gate, or -1; no found one twice. The
/// nearest pairs come first.
std::vector<int> matched(const std::vector<Eigen::Vector2d>& truth,
                         const std::vector<Eigen::Vector2d>& found, double gate) {
  struct Candidate {
    double distance;
    std::size_t truth, found;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t j = 0; j < found.size(); ++j) {
      const double distance = (truth[i] - found[j]).norm();
      if (distance < gate) candidates.push_back({distance, i, j});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.distance < b.distance; });
  std::vector<int> match(truth.size(), -1);
  std::vector<bool> taken(found.size(), false);
  for (const Candidate& candidate : candidates) {
    if (match[candidate.truth] >= 0 || taken[candidate.found]) continue;
    match[candidate.truth] = static_cast<int>(candidate.found);
    taken[candidate.found] = true;
  }
  return match;
}

std::string room_rows(const Building& building, const std::vector<Room>& rooms,
                      const Pose& building_from_world) {
  std::vector<Eigen::Vector2d> truth, found;
  for (const TrueRoom& room : building.rooms) truth.push_back(room.centre);
  for (const Room& room : rooms) found.push_back((building_from_world * room.centre).head<2>());
  const std::vector<int> match = matched(truth, found, room_gate);
  std::string text = fmt::format("{:<26}{:<23}{}\n", "room", "true", "in the map");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const TrueRoom& room = building.rooms[i];
    text += fmt::format("  {:<24}{:.2f} x {:.2f} x {:.2f} m   ", room.name,
                        std::min(room.width, room.depth), std::max(room.width, room.depth),
                        room.height);
    if (match[i] < 0) {
      text += "not found\n";
      continue;
    }
    const Room& own = rooms[static_cast<std::size_t>(match[i])];
    text += fmt::format("{:.2f} x {:.2f} x {:.2f} m\n", own.width, own.depth, own.height);
  }
  return text;
}

std::string door_rows(const Building& building, const std::vector<Opening>& openings,
                      const Pose& building_from_world) {
  std::vector<Eigen::Vector2d> truth, found;
  std::vector<Opening> doors;
  for (const TrueDoor& door : building.doors) truth.push_back(door.centre.head<2>());
  for (const Opening& opening : openings) {
    if (opening.kind != OpeningKind::door) continue;
    doors.push_back(opening);
    found.push_back((building_from_world * opening.position).head<2>());
  }
  const std::vector<int> match = matched(truth, found, door_gate);
  std::string text = "door\n";
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const TrueDoor& door = building.doors[i];
    text += fmt::format("  {:<24}{:.2f} x {:.2f} m          ",
                        door.between[0] + "-" + door.between[1], door.width, door.height);
    if (match[i] < 0) {
      text += "not found\n";
      continue;
    }
    const Opening& own = doors[static_cast<std::size_t>(match[i])];
    text += fmt::format("{:.2f} x {:.2f} m\n", own.width, own.height);
  }
  return text;
}

}  // namespace

std::string comparison_text(const Building& building, const RoomMap& map,
                            const Pose& building_from_world) {
  return room_rows(building, map.rooms, building_from_world) +
         door_rows(building, map.openings, building_from_world);
}

}  // namespace planum
