#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace annulus::dynamics {

/// Tolerances of the pitch of a gear [ISO1328-1].
struct PitchTolerances {
  int teeth = 0;
  double single = 0;      ///< f_pT, m
  double cumulative = 0;  ///< F_pT, m
};

/// Single pitch deviations of a gear that just keeps its tolerances, m, one per tooth, of sum 0: the places of its
/// teeth are a wave once per turn, as of an eccentricity, and independent normal deviations. Both are drawn, and mixed
/// so that the total cumulative deviation is F_pT and the largest single one f_pT. Where no mixture is both (few teeth,
/// whose wave alone reaches f_pT; or a wide f_pT), one of them is reached and the other kept. The same seed and name
/// give the same gear.
[[nodiscard]] std::vector<double> drawn_pitch_deviations(const PitchTolerances& tolerances, std::uint64_t seed,
                                                         std::string_view name);

}  // namespace annulus::dynamics
