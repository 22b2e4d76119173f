#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slam/evaluation/relations.hpp"
#include "slam/evaluation/segment_error.hpp"
#include "slam/evaluation/trajectory_error.hpp"
#include "tools/planum/model_comparison.hpp"
#include "tools/workflow/map_evaluation.hpp"

namespace planum {

/// Relations of a trajectory, and which they are.
struct EvaluatedRelations {
  std::string what;  ///< "within 5 m of each other", or the file they are from
  RelationError error;
};

/// A trajectory and what it is called; the errors for which there is a truth.
struct EvaluatedTrajectory {
  std::string name;
  std::optional<TrajectoryError> error;
  std::optional<SegmentError> segments;
  std::optional<EvaluatedRelations> relations;
};

struct Evaluation {
  std::vector<EvaluatedTrajectory> trajectories;
  std::optional<MapEvaluation> map;
  std::optional<ModelComparison> model;
};

/// Tables for people.
std::string evaluation_text(const Evaluation& evaluation);

/// docs/evaluation.md names the keys.
std::string evaluation_json(const Evaluation& evaluation);

}  // namespace planum
