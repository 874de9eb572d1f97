#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dynamics/modes/modes.h"
#include "dynamics/systems/two_k_v/two_k_v.h"

namespace annulus::dynamics {

/// Names of the real inputs that the frequencies depend on, as the fields of TwoKVStage (stiffness of a mesh: its
/// name). Supports only where they are springs.
[[nodiscard]] std::vector<std::string> frequency_inputs(const TwoKVStage& stage);
/// The stage with one of them multiplied by `factor`. Throws InputError for an unknown name, a factor that is not
/// positive or a law of force over deflection.
[[nodiscard]] TwoKVStage scaled(const TwoKVStage& stage, const std::string& input, double factor);

/// The value of an input, SI; of a mesh its mean tangent stiffness. Throws InputError for an unknown name.
[[nodiscard]] double input_value(const TwoKVStage& stage, const std::string& input);

/// d ln f/d ln p of a natural frequency at the crank angle of the stage, mean mesh stiffness.
struct FrequencySensitivity {
  std::string input;
  double value = 0;
  /// Inertias and stiffnesses enter M and K linearly: half the share of the strain energy, or minus half that of the
  /// kinetic energy. Lengths and angles: central differences.
  bool exact = true;
};
/// Sensitivities of the lowest frequency above zero, largest magnitude first. Those of stiffnesses add up to 1/2, those
/// of inertias and masses to -1/2.
[[nodiscard]] std::vector<FrequencySensitivity> first_frequency_sensitivities(const TwoKVStage& stage);

/// The lowest natural frequency above zero, Hz. Throws SolverError when there is none.
[[nodiscard]] double first_frequency(const Modes& found);
[[nodiscard]] double first_frequency(const TwoKVStage& stage);
/// The same with one input multiplied by `factor`.
[[nodiscard]] double first_frequency(const TwoKVStage& stage, const std::string& input, double factor);

/// Factors on one input between which the first frequency lies within `relative` of a target frequency. They show how
/// much an agreement with that frequency means.
///
/// An end is absent where no factor between 1e-4 and 1e4 leads to that side of the band. The input then has no limit on
/// that side, or cannot reach the target. Factors without a possible stage (pressure angle) are left out. Of several
/// crossings the one nearest to factor 1 counts.
struct InputBand {
  std::optional<double> low, high;
};
/// `target`: Hz. Throws InputError for a target that is not positive or a relative band outside (0, 1).
[[nodiscard]] InputBand band_of_input(const TwoKVStage& stage, const std::string& input, double target,
                                      double relative);
/// The factor that brings the first frequency to `target` (Hz); absent where none does.
[[nodiscard]] std::optional<double> factor_reaching(const TwoKVStage& stage, const std::string& input, double target);

}  // namespace annulus::dynamics
