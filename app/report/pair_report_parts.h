#pragma once

#include <string>
#include <vector>

#include "app/pair/pair_run.h"
#include "app/report/report_parts.h"

/// The parts of a helical pair's report.html, made from the results alone; empty where there is nothing to tell.
namespace annulus::app {

// pair_report_conclusions.cc
[[nodiscard]] std::string pair_verdict(const PairRunResult& result);  ///< what came out, in plain words
/// The paper's conclusions held against the numbers.
[[nodiscard]] std::string pair_conclusions_section(const PairRunResult& result);
// pair_report_shares.cc
[[nodiscard]] std::string pair_shares_section(const PairRunResult& result);  ///< causes of the transmission error
/// The rows that were found, by rising torque or speed.
[[nodiscard]] std::vector<const ShareRow*> good_rows(const PairRunResult& result);
[[nodiscard]] std::vector<const SpeedRow*> good_speeds(const PairRunResult& result);
[[nodiscard]] std::string um_text(double x, int digits = 4);  ///< m as a number of micrometres
[[nodiscard]] std::string torque_text(double x);              ///< N m as "20 kN m"
// pair_report_errors.cc
[[nodiscard]] std::string pair_errors_section(const PairRunResult& result);  ///< random errors and their quantiles
// pair_report_stiffness.cc
[[nodiscard]] std::string pair_stiffness_section(const PairRunResult& result);
// pair_report_maps.cc, pair_report_motion.cc
[[nodiscard]] std::string pair_figures_section(const PairRunResult& result);
[[nodiscard]] std::string pair_maps_section(const PairRunResult& result);    ///< figures over torque and speed
[[nodiscard]] std::string pair_motion_section(const PairRunResult& result);  ///< time history and spectrum
[[nodiscard]] std::string pair_modes_section(const PairRunResult& result);
[[nodiscard]] std::string pair_quality_section(const PairRunResult& result);

}  // namespace annulus::app
