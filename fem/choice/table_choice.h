#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fem/problem/loaded_mesh_problem.h"

/// What a wanted accuracy asks for, beside the model: the measured trade turned into rules (docs/tradeoff.md, which
/// also reports how well they keep their guarantee).
namespace annulus::fem {

/// Loads of a table, as multiples of the nominal mean mesh force: around it, so that the table can be interpolated, and
/// down to a quarter, where the load no longer spreads over all teeth.
inline constexpr double table_load_factors[] = {0.25, 0.5, 1, 1.5, 2};
inline constexpr std::size_t nominal_load_index = 2;  ///< of table_load_factors
/// Positions per mesh cycle of a rough table.
inline constexpr int table_phases = 32;

/// Wanted accuracies from which on less will do.
inline constexpr double very_rough_accuracy = 0.1, rough_accuracy = 0.03;

/// How finely a table is resolved, and why.
struct TableResolution {
  int phases = table_phases;
  std::vector<double> load_factors{};  ///< of the nominal load; the middle one is 1
  std::string phases_reason{}, loads_reason{};
};
/// `uptake`: share of a mesh cycle within which a pair takes up its load, which positions must not step over.
/// `overlap_ratio`: teeth that overlap by one and more take it up over a mesh cycle and longer.
[[nodiscard]] TableResolution table_resolution(double accuracy, double uptake, double overlap_ratio);
/// From the deflection under the nominal force (N) on a face (m) and the module (m): beyond its path of contact the gap
/// of a pair opens with the square of the way, so that the way it is closed over goes with the root of the deflection.
/// The stiffness is that of [ISO6336-1], about 14 N/(mm um) for steel, whatever the rim: a soft one only makes it
/// longer.
[[nodiscard]] double load_uptake(double force, double face_width, double module, double youngs_modulus);

/// Polynomial degree of the elements, and why. Levels follow from the error estimate.
struct ElementChoice {
  int degree = 2;
  std::string reason{};
};
/// For the plane or solid model of a mesh: linear elements where they are within the accuracy at once.
[[nodiscard]] ElementChoice element_choice(const LoadedMeshProblem& problem, Fidelity fidelity, double accuracy);

}  // namespace annulus::fem
