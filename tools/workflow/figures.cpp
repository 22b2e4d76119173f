#include "tools/workflow/figures.hpp"

#include <cmath>

#include "meshing/triangulation.hpp"

namespace planum {

ScanFigures scan_figures(const Imported& imported) {
  ScanFigures figures;
  figures.count = imported.counts.size();
  for (const ImportCounts& counts : imported.counts) {
    figures.points += counts.kept;
    figures.no_return += counts.no_return;
    figures.not_finite += counts.not_finite;
    figures.out_of_range += counts.too_near + counts.too_far;
  }
  return figures;
}

RegistrationFigures registration_figures(const Imported& imported, const SequenceMatch& match,
                                         const Relaxed& relaxed) {
  RegistrationFigures figures;
  figures.rms = rms_of(match);
  for (const SequenceStep& step : match.steps) {
    ++(step.matched ? figures.pairs : figures.pairs_failed);
  }
  for (const Edge& edge : relaxed.graph.edges) {
    if (edge.kind != EdgeKind::loop) continue;
    ++(edge.accepted ? figures.loops_accepted : figures.loops_rejected);
  }
  for (const auto& component : relaxed.components) {
    figures.components.emplace_back();
    for (const std::size_t scan : component) {
      figures.components.back().push_back(imported.scans[scan].id);
    }
  }
  return figures;
}

PolygonFigures polygon_figures(const PolygonMap& map, const TriangleMesh& mesh) {
  PolygonFigures figures;
  figures.count = map.polygons.size();
  figures.vertices = map.vertices.size();
  for (const MapPolygon& polygon : map.polygons) figures.area += polygon.area;
  for (const InferredPatch& patch : map.inferred) figures.inferred_area += patch.shape.area;
  figures.rest_triangles = map.rest.triangles.size();
  const auto left = static_cast<double>(triangulated(map).mesh.triangles.size());
  if (!mesh.triangles.empty()) {
    figures.compression = 1 - left / static_cast<double>(mesh.triangles.size());
  }
  return figures;
}

double rms_of(const SequenceMatch& match) {
  double squares = 0, pairs = 0;
  for (const SequenceStep& step : match.steps) {
    if (!step.matched) continue;
    const auto count = static_cast<double>(step.alignment.pairs);
    squares += count * step.alignment.rms * step.alignment.rms;
    pairs += count;
  }
  return pairs > 0 ? std::sqrt(squares / pairs) : 0;
}

}  // namespace planum
