#include "fem/choice/table_choice.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace annulus::fem {

double load_uptake(double force, double face_width, double module, double youngs_modulus) {
  constexpr double steel = 206e9;                                      // Pa
  const double stiffness_per_width = 14e9 * (youngs_modulus / steel);  // N/m^2
  return std::sqrt(force / face_width / stiffness_per_width / module);
}

namespace {

/// The smallest one that linear plane elements reach at their first level.
constexpr double linear_accuracy = 0.01;

/// Why linear elements would be too stiff, by more than their error estimate: they lock where the volume hardly
/// changes, and where thin parts bend (a rim of two modules on a sleeve four times as long as thick: off by 10.2 %
/// where they say 9.3 %).
std::string unfit_for_linear(const LoadedMeshProblem& problem) {
  constexpr double nearly_incompressible = 0.4, thin_rim = 2.5, slender_sleeve = 0.3;
  if (problem.materials.larger_poisson_ratio() > nearly_incompressible)
    return fmt::format("linear ones are too stiff where Poisson's ratio exceeds {}", nearly_incompressible);
  const auto sleeve = problem.structure.body(problem.wheel_support_radius).sleeve;
  if (!sleeve) return "";
  const auto& gear = problem.pair.wheel();
  if (problem.wheel_support_radius - gear.root_radius() < thin_rim * gear.parameters().module ||
      sleeve->thickness < slender_sleeve * sleeve->length)
    return "linear ones are too stiff where a thin rim or a slender sleeve bends";
  return "";
}

/// Edges of single supports, sleeves and flanges that bend, and contacts slanted over the cells leave linear elements
/// more than 1 % at their first level.
bool hard_for_linear(const LoadedMeshProblem& problem) {
  if (problem.pair.pinion().helix_angle() != 0) return true;
  return problem.pair.internal() && !held_outside(problem.structure);
}

/// What a table of so many positions misses of a peak factor, largest of five stages against 512 (docs/tradeoff.md).
struct MissedPeaks {
  int phases;
  double relative;
};
constexpr MissedPeaks missed_peaks[] = {
    {2 * table_phases, 0.012}, {4 * table_phases, 0.004}, {8 * table_phases, 0.0016}};

void choose_loads(double accuracy, TableResolution& choice) {
  if (accuracy >= rough_accuracy) {
    choice.load_factors = {0.5, 1, 1.5};
    choice.loads_reason = "three loads show how the stiffness depends on the load; a single one would miss 1 to 2 %";
  } else {
    choice.load_factors = {std::begin(table_load_factors), std::end(table_load_factors)};
    choice.loads_reason = "five, from a quarter to twice the nominal load: the range of dynamic loads";
  }
}

}  // namespace

TableResolution table_resolution(double accuracy, double uptake, double overlap_ratio) {
  TableResolution choice;
  choose_loads(accuracy, choice);
  const bool slow = overlap_ratio >= 1;
  if (slow && accuracy >= linear_accuracy) {
    choice.phases_reason =
        "helical teeth that overlap by a pitch transfer their load slowly: 64 positions change nothing";
    return choice;
  }
  const bool very_rough = accuracy >= very_rough_accuracy;
  const auto* peaks = std::begin(missed_peaks);
  const auto* finest = std::end(missed_peaks) - 1;
  if (very_rough) {
    choice.phases_reason = "an accuracy of 10 % or coarser leaves it at 32 positions";
  } else {
    while (!slow && peaks != finest && peaks->relative > accuracy) ++peaks;
    choice.phases = peaks->phases;
    choice.phases_reason =
        slow ? "helical teeth that overlap by a pitch transfer their load slowly: 128 positions change nothing"
             : fmt::format("with {} positions the error of peak factors is up to {:.2g} %", choice.phases,
                           100 * peaks->relative);
  }
  // The stiffness has spikes where pairs take up a light load.
  const int most = very_rough ? finest->phases / 2 : finest->phases;
  const double within = accuracy < linear_accuracy ? 2 : 1;  // positions within which a light load is taken up
  if (choice.phases * uptake < 1) {
    while (choice.phases < most && choice.phases * uptake < within) choice.phases *= 2;
    choice.phases_reason =
        fmt::format("the load is so light that a pair takes it up within {:.1g} of a mesh cycle", uptake);
  }
  return choice;
}

ElementChoice element_choice(const LoadedMeshProblem& problem, Fidelity fidelity, double accuracy) {
  if (const auto unfit = unfit_for_linear(problem); !unfit.empty()) return {2, "quadratic elements: " + unfit};
  const double enough = hard_for_linear(problem) ? rough_accuracy : linear_accuracy;
  if (accuracy >= enough && (fidelity == Fidelity::plane || fidelity == Fidelity::solid))
    return {1, fmt::format("linear elements reach {:.0f} % at their first level, at {} of the cost of quadratic ones; "
                           "if they do not, quadratic ones follow",
                           100 * enough, fidelity == Fidelity::plane ? "half" : "an eighth")};
  return {2, fmt::format("quadratic elements reach {} at their first level, and their stresses can be used",
                         fidelity == Fidelity::solid ? "0.3 to 1 %" : "0.3 %")};
}

}  // namespace annulus::fem
