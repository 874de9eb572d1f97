#pragma once

#include <string>
#include <vector>

#include "app/sections/report_parts.h"
#include "app/systems/two_k_v/two_k_v_run.h"

/// The sections of the report of a 2K-V stage, made from the results alone.
namespace annulus::app {

/// The scene's own stiffness, and the computed one where it is compared.
using NamedCases = std::vector<std::pair<std::string, const TwoKVCase*>>;
[[nodiscard]] NamedCases shown_cases(const TwoKVResult& result);

// reducer_geometry.cc
[[nodiscard]] Section drawings_section(const TwoKVResult& result);  ///< the gears to scale
// reducer_arc.cc
[[nodiscard]] Blocks arc_pins_blocks(const TwoKVResult& result);  ///< forces and stiffness by the paper's formulas
// reducer_answers.cc
[[nodiscard]] Blocks reducer_verdict(const TwoKVResult& result);
[[nodiscard]] Section reducer_comparison(const TwoKVResult& result);  ///< with the published results
// reducer_vibration.cc; without blocks when [dynamics] is missing
[[nodiscard]] Section frequencies_section(const TwoKVResult& result);      ///< over the crank angle, shapes
[[nodiscard]] Section first_frequency_section(const TwoKVResult& result);  ///< what it depends on, bands
[[nodiscard]] Section torsion_section(const TwoKVResult& result);          ///< torsional stiffness, lost motion
/// The first mode that is no free rotation.
[[nodiscard]] std::size_t first_elastic_mode(const TwoKVVibration& vibration);
// reducer_motion.cc; without blocks when [dynamics] is missing
[[nodiscard]] Section reducer_motion_section(const TwoKVResult& result);
/// Output error, peak to peak, arc seconds; "0" where it is rounding.
[[nodiscard]] std::string error_text(const TwoKVMotion& motion);
[[nodiscard]] Blocks motion_checks(const TwoKVResult& result);

}  // namespace annulus::app
