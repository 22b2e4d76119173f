#include <array>

#include <fmt/format.h>

#include "tools/objects/model_library.hpp"
#include "tools/workflow/map_steps.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {
namespace {

/// Empty: the built-in ones.
std::vector<std::filesystem::path> model_files_of(const Project& project) {
  const std::string& directory = project.settings.models;
  if (directory.empty()) return {};
  return model_files(resolved(project, directory));
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
  const std::vector<Eigen::Vector3d> origins = scan_origins(context.results.world.get());
  Labelled labelled =
      labelled_map(context.results.polygons.get(), context.results.cloud.get(), origins,
                   model_files_of(context.project), context.project.settings, context.progress);
  if (const auto why = why_not_level(labelled.labels))
    context.record.warnings.push_back("no rooms: " + *why + "; [world] level = true levels it");
  write_result(context.result, labelled);
  context.record.summary = summary(labelled);
  context.results.labelled.set(std::move(labelled));
}

}  // namespace

Stage labels_stage() {
  return {.name = "labels",
          .version = 5,
          .unit = "steps",
          .needs = {"cloud", "polygons"},
          .parameters = {"labels", "rooms"},
          .input_files = model_files_of,
          .work = work};
}

}  // namespace planum
