#pragma once

#include <string>
#include <vector>

#include "app/sections/report_parts.h"
#include "app/systems/helical_pair/pair_run.h"

/// The sections of a helical pair's report, made from the results alone.
namespace annulus::app {

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
[[nodiscard]] std::string speed_text(double x);               ///< rad/s as "500 r/min"
// manufacturing_errors.cc
[[nodiscard]] Section pair_errors_section(const PairRunResult& result);  ///< random errors and their quantiles
// pair_stiffness.cc
/// `meshes`: the computed one, if any.
[[nodiscard]] Section pair_stiffness_section(const PairRunResult& result, const NamedMeshes& meshes);
// pair_motion.cc
[[nodiscard]] Section pair_motion_section(const PairRunResult& result);  ///< time history and spectrum
[[nodiscard]] Section pair_modes_section(const PairRunResult& result);

}  // namespace annulus::app
