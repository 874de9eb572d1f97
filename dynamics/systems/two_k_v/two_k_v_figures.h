#pragma once

#include <vector>

#include "core/figure.h"
#include "dynamics/systems/two_k_v/two_k_v_response.h"

namespace annulus::dynamics {

/// Natural frequencies among the results of a 2K-V stage.
inline constexpr int two_k_v_frequencies = 6;

/// The results of the lumped model of a 2K-V stage, each declared once.
[[nodiscard]] const std::vector<FigureSpec>& two_k_v_figures();

/// Natural frequencies at the crank angle of the stage, torsional stiffness over a crank turn, wind-up and lost motion.
/// `at_nominal`: the stage with its tables at the nominal load; `arc_clearance`: m, see lost_motion.
[[nodiscard]] FigureSet static_figures(const TwoKVStage& at_nominal, double arc_clearance);
/// Results of the periodic motion with their errors. Constant mesh stiffness excites nothing: a range of the output
/// that is rounding alone is 0, and its factors are 1.
[[nodiscard]] FigureSet figures(const TwoKVStage& stage, const TwoKVResponse& response);

/// Whether the output moves against the input by more than rounding. Constant mesh stiffness moves nothing: the whole
/// load winds the train up evenly, whatever the crank angle. Arguments in rad.
[[nodiscard]] bool output_moves(double peak_to_peak, double static_peak_to_peak, double mean);

}  // namespace annulus::dynamics
