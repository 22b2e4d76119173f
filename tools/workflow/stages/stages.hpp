#pragma once

#include "tools/workflow/stage.hpp"

/// The boxes of the pipeline, one file each.
namespace planum {

Stage import_stage();    ///< scan files -> scans in the scanner's frame
Stage register_stage();  ///< each scan against the one before -> edges
Stage relax_stage();     ///< loops, and poses that suit all edges
Stage cloud_stage();     ///< one levelled cloud with normals
Stage mesh_stage();      ///< triangles
Stage polygons_stage();  ///< plane polygons with holes
Stage labels_stage();    ///< what the polygons are; rooms
Stage maps_stage();      ///< files for robots and people
Stage report_stage();    ///< figures and a picture

}  // namespace planum
