#pragma once

#include "tools/report/run_report.hpp"
#include "tools/workflow/results.hpp"

namespace planum {

/// The figures of a run's report, from the results of its stages.
ScanFigures scan_figures(const Imported& imported);
RegistrationFigures registration_figures(const Imported& imported, const SequenceMatch& match,
                                         const Relaxed& relaxed);
PolygonFigures polygon_figures(const PolygonMap& map, const TriangleMesh& mesh);

/// Root mean square over all pairs of points of all matched steps, m.
double rms_of(const SequenceMatch& match);

}  // namespace planum
