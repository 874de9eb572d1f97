#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/figure.h"
#include "core/stiffness_table.h"
#include "dynamics/steady_state/steady_response.h"

/// Errors of stiffness tables in the results of any lumped model that is built on them.
namespace annulus::dynamics {

/// The results of a lumped model, and how its steady state was found.
struct Evaluation {
  FigureSet figures;
  SteadyOutcome outcome;
};

/// A mesh whose stiffness comes from a table with estimated errors.
struct TabulatedMesh {
  std::string name;  ///< for messages: "sun mesh"
  StiffnessTable table;
  /// Relative error of the mean stiffness by its causes: the proportions in which an error of a result is divided. All
  /// zero where they are not known: discretisation then has all of it.
  ErrorParts mean_stiffness_parts{};
  /// Share of a mesh cycle within which a tooth pair takes up a load of 1 N; that of other loads goes with their root.
  /// 0 where it is not known: at once.
  double uptake = 0;
};

/// A lumped model as a function of its tables.
struct TabulatedModel {
  std::vector<TabulatedMesh> meshes;  ///< prescribed stiffnesses are exact and not among them
  /// The results on other tables, one per mesh and in their order, all found in the same way. Throws Error where there
  /// is no solution.
  std::function<Evaluation(const std::vector<StiffnessTable>& tables)> evaluate;
  /// Whether `evaluate` looks for a steady state; a warning is logged for a changed table that has none.
  bool seeks_steady_state = true;
  /// Whether the nominal results were found in that very way: then they are what the others are compared with.
  bool nominal_alike = false;
};

/// The nominal results with the parts of their errors and the sum of these as error:
/// - discretisation, contact, condensation, model: the largest |difference| with the stiffness or its ripple raised by
///   its error estimate (core/table_variants.h), mesh by mesh, divided in the proportions of that stiffness' own parts;
/// - interpolation: the |difference| with every second phase only, all meshes at once, or with the others only, or a
///   quarter of that with every fourth one, whichever is largest: curves between the phases converge with an order
///   between one (where slopes jump) and two; or the |difference| with what the stiffness jumps between two phases made
///   as suddenly as tooth pairs take up their load, and as early or as late as possible, where that is larger. Not
///   known for an odd number of phases;
/// - integration: the nominal error.
/// Errors of frequencies are then widened to neighbours that may change places with them.
/// A part is not known (NaN) where the model cannot be solved on a changed table.
[[nodiscard]] FigureSet propagate_errors(const Evaluation& nominal, const TabulatedModel& model);

/// How a model is solved on changed tables where its nominal motion was found by steady_response with `options`:
/// without time integration where that motion agreed with the harmonic balance, otherwise integrated in time from the
/// nominal motion (for 170 mesh cycles where it has no periodic steady state within the longest window).
struct ComparisonOptions {
  SimulationOptions simulation;
  bool seeks_steady_state = true;
  bool nominal_alike = false;
};
[[nodiscard]] ComparisonOptions comparison_options(const SteadyOutcome& nominal, const SimulationOptions& options);

}  // namespace annulus::dynamics
