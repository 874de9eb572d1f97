#pragma once

#include <functional>
#include <vector>

#include "app/model/mesh_result.h"
#include "dynamics/error_propagation/error_propagation.h"

namespace annulus::app {

class GearSystem;

/// The results of a lumped model on these tables.
using OnTables = std::function<dynamics::Evaluation(const std::vector<const MeshResult*>& tables)>;

/// The results `nominal` of a lumped model with the errors that its tables bring (dynamics/error_propagation).
/// `evaluate` finds them on tables changed by their errors; prescribed stiffnesses are exact. `way`: how it finds them
/// (its simulation is not read).
[[nodiscard]] FigureSet with_table_errors(const dynamics::Evaluation& nominal,
                                          const std::vector<const MeshResult*>& tables, const OnTables& evaluate,
                                          const dynamics::ComparisonOptions& way);

/// Adds to the model's part of every error what changes from one model to another.
void add_change(FigureSet& figures, const FigureSet& before, const FigureSet& after);

/// The results of the lumped model of a variant, all that it answers, with the errors that its tables bring.
[[nodiscard]] FigureSet model_results(const GearSystem& system, std::size_t variant,
                                      const std::vector<const MeshResult*>& tables);

}  // namespace annulus::app
