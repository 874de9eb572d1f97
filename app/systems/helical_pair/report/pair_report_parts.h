#pragma once

#include <string>
#include <vector>

#include "app/sections/report_parts.h"
#include "app/systems/helical_pair/pair_run.h"

/// The sections of a helical pair's report, made from the results alone.
namespace annulus::app {

// pair_geometry.cc
[[nodiscard]] Section drawings_section(const PairRunResult& result);  ///< the gears to scale
// conclusions.cc
[[nodiscard]] Blocks pair_verdict(const PairRunResult& result);  ///< what came out, in plain words
/// The paper's conclusions compared with the numbers.
[[nodiscard]] Section pair_conclusions_section(const PairRunResult& result);
// causes.cc
[[nodiscard]] Section pair_shares_section(const PairRunResult& result);  ///< causes of the transmission error
/// The rows that were found, by rising torque or speed.
[[nodiscard]] std::vector<const ShareRow*> good_rows(const PairRunResult& result);
[[nodiscard]] std::vector<const SpeedRow*> good_speeds(const PairRunResult& result);
[[nodiscard]] std::string um_text(double x, int digits = 4);  ///< m as a number of micrometres
[[nodiscard]] std::string torque_text(double x);              ///< N m as "20 kN m"
// manufacturing_errors.cc
[[nodiscard]] Section pair_errors_section(const PairRunResult& result);  ///< random errors and their quantiles
// pair_stiffness.cc
[[nodiscard]] Section pair_stiffness_section(const PairRunResult& result);
// torque_speed_maps.cc, pair_motion.cc
[[nodiscard]] Section pair_figures_section(const PairRunResult& result);
[[nodiscard]] Section pair_maps_section(const PairRunResult& result);    ///< results over torque and speed
[[nodiscard]] Section pair_motion_section(const PairRunResult& result);  ///< time history and spectrum
[[nodiscard]] Section pair_modes_section(const PairRunResult& result);
[[nodiscard]] Section pair_quality_section(const PairRunResult& result);

}  // namespace annulus::app
