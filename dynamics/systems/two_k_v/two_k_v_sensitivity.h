#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dynamics/systems/two_k_v/two_k_v.h"

namespace annulus::dynamics {

/// Names of the real inputs the frequencies depend on, as the fields of TwoKVStage (stiffness of a mesh: its name);
/// supports only where they are springs.
[[nodiscard]] std::vector<std::string> frequency_inputs(const TwoKVStage& stage);
/// The stage with one of them times `factor`. Throws InputError for an unknown name or a value that cannot be.
[[nodiscard]] TwoKVStage scaled(const TwoKVStage& stage, const std::string& input, double factor);

/// d ln f/d ln p of a natural frequency at the crank angle of the stage, mean mesh stiffness.
struct FrequencySensitivity {
  std::string input;
  double value = 0;
  /// Inertias and stiffnesses stand linearly in M and K: half the share of the strain energy, or minus half that of the
  /// kinetic energy. Lengths and angles: central differences.
  bool exact = true;
};
/// Of the lowest frequency above zero, largest amount first. Stiffnesses add up to 1/2, inertias and masses to -1/2.
[[nodiscard]] std::vector<FrequencySensitivity> first_frequency_sensitivities(const TwoKVStage& stage);

/// The lowest natural frequency above zero, Hz. Throws SolverError when there is none.
[[nodiscard]] double first_frequency(const TwoKVStage& stage);
/// The same with one input times `factor`.
[[nodiscard]] double first_frequency(const TwoKVStage& stage, const std::string& input, double factor);

/// What an agreement with a frequency is worth: the factors on one input between which the first frequency lies within
/// `relative` of the target. An end is absent where no factor between 1e-4 and 1e4 leads to that side of the band (of
/// factors with which no stage exists, as for the pressure angle, none is looked at): the input is then free on that
/// side, or the target out of its reach. Of several crossings the one nearest to factor 1 counts.
struct InputBand {
  std::optional<double> low, high;
};
[[nodiscard]] InputBand band_of_input(const TwoKVStage& stage, const std::string& input, double target,
                                      double relative);

}  // namespace annulus::dynamics
