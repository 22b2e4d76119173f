#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "labeling/objects/object_models.hpp"
#include "labeling/objects/objects.hpp"
#include "labeling/occupancy.hpp"
#include "labeling/rooms/blind_windows.hpp"
#include "labeling/rooms/storeys.hpp"
#include "tools/objects/model_library.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {
namespace {

constexpr double level_enough = radians(5);

/// Rooms are found in plan, so that "up" must be z.
RoomMap rooms_of(const Labels& labels, const PolygonMap& map, StageContext& context) {
  const double tilt = std::acos(std::clamp(labels.up.z(), -1.0, 1.0));
  if (tilt > level_enough) {
    context.record.warnings.push_back(fmt::format(
        "no rooms: the world is {:.0f} degrees from level; [world] level = true levels it",
        degrees(tilt)));
    RoomMap none;
    none.room_of_polygon.assign(map.polygons.size(), -1);
    return none;
  }
  return find_rooms_of_storeys(context.results.cloud.get(),
                               scan_origins(context.results.world.get()), map,
                               storey_floors(map, labels), context.project.settings.rooms);
}

/// Empty: the built-in ones.
std::vector<std::filesystem::path> model_files_of(const Project& project) {
  const std::string& directory = project.settings.models;
  if (directory.empty()) return {};
  return model_files(resolved(project, directory));
}

std::vector<SceneObject> objects_of(const Labelled& labelled, const PolygonMap& map,
                                    StageContext& context) {
  const Cloud& cloud = context.results.cloud.get();
  const auto files = model_files_of(context.project);
  return with_models(
      find_objects(cloud, map, labelled.labels, labelled.rooms, context.project.settings.objects),
      cloud, scan_origins(context.results.world.get()),
      files.empty() ? built_in_models() : read_models(files));
}

std::string summary(const Labelled& labelled) {
  std::array<std::size_t, all_labels.size()> count{};
  for (const PolygonLabel& polygon : labelled.labels.polygons) {
    ++count[static_cast<std::size_t>(polygon.label)];
  }
  std::array<std::size_t, 3> openings{};
  for (const Opening& opening : labelled.rooms.openings) {
    ++openings[static_cast<std::size_t>(opening.kind)];
  }
  return fmt::format(
      "{} floors, {} ceilings, {} walls; {} rooms, {} doors, {} windows; {} objects",
      count[static_cast<std::size_t>(Label::floor)],
      count[static_cast<std::size_t>(Label::ceiling)], count[static_cast<std::size_t>(Label::wall)],
      labelled.rooms.rooms.size(), openings[static_cast<std::size_t>(OpeningKind::door)],
      openings[static_cast<std::size_t>(OpeningKind::window)], labelled.objects.size());
}

void work(StageContext& context) {
  const PolygonMap& map = context.results.polygons.get();
  Labelled labelled;
  constexpr std::size_t steps = 4;
  context.progress.report(0, steps);
  labelled.labels = label(map, context.project.settings.labels);
  context.progress.report(1, steps);
  labelled.rooms =
      with_blind_windows(map, labelled.labels, rooms_of(labelled.labels, map, context));
  labelled.labels = with_openings(map, std::move(labelled.labels), labelled.rooms.openings);
  context.progress.report(2, steps);
  labelled.objects = objects_of(labelled, map, context);
  context.progress.report(3, steps);
  write_result(context.result, labelled);
  context.record.summary = summary(labelled);
  context.results.labelled.set(std::move(labelled));
}

}  // namespace

Stage labels_stage() {
  return {.name = "labels",
          .version = 4,
          .unit = "steps",
          .needs = {"cloud", "polygons"},
          .parameters = {"labels", "rooms"},
          .input_files = model_files_of,
          .work = work};
}

}  // namespace planum
