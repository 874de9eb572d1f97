#pragma once

#include <optional>
#include <vector>

#include "dynamics/steady_state/harmonic_balance.h"

namespace annulus::dynamics {

/// An excitation that repeats after a long time only, as one of two angles: errors of some bodies turn with the second
/// one, all else repeats with the first. Pins at 24 places of a ring of 162 teeth repeat after 27 mesh cycles, errors
/// of planets with 55 teeth after 55, both together after 1485.
struct TwoFrequencies {
  int cycles = 0;          ///< mesh cycles after which the first angle repeats
  double second_rate = 0;  ///< rad/s
  std::vector<SecondWave> waves;
};

/// The two angles of an excitation that repeats after `period` cycles of a frequency (Hz), the first one as short as
/// possible; nothing where that saves less than half of a period, or where meshes have several frequencies.
[[nodiscard]] std::optional<TwoFrequencies> two_frequencies(const LumpedSystem& system, double mesh_frequency,
                                                            int period);
/// The system without the errors of the second angle.
[[nodiscard]] LumpedSystem without_waves(const LumpedSystem& system, const std::vector<SecondWave>& waves);
/// The system with the errors of the second angle held at a value of it (rad).
[[nodiscard]] LumpedSystem with_waves_at(const LumpedSystem& system, const TwoFrequencies& angles, double angle);

}  // namespace annulus::dynamics
