#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "app/two_k_v/two_k_v_run.h"

/// The parts of the report of a 2K-V stage, each a piece of HTML made from the results alone.
namespace annulus::app {

/// One or two columns of every table: the scene's own stiffness, and the computed one.
struct ShownCase {
  std::string name;
  const TwoKVCase* result;
  std::size_t colour;
};
[[nodiscard]] std::vector<ShownCase> shown_cases(const TwoKVResult& result);

/// "crank bearings" for crank_bearing.
[[nodiscard]] std::string element_words(const std::string& group);
/// "input on crank bearings" for "input on crank_bearing".
[[nodiscard]] std::string mode_words(const std::string& name);

inline constexpr double arc_second = std::numbers::pi / (180 * 3600);  ///< rad
inline constexpr double arc_minute = 60 * arc_second;                  ///< rad

// two_k_v_report_vibration.cc; empty without [dynamics]
[[nodiscard]] std::string frequencies_section(const TwoKVResult& result);      ///< over the crank angle, shapes
[[nodiscard]] std::string first_frequency_section(const TwoKVResult& result);  ///< what it depends on, bands
[[nodiscard]] std::string torsion_section(const TwoKVResult& result);          ///< torsional stiffness, lost motion
/// Output error, peak to peak, arc seconds; "0" where it is rounding.
[[nodiscard]] std::string error_text(const TwoKVMotion& motion);

// two_k_v_report_motion.cc; empty without [dynamics]
[[nodiscard]] std::string reducer_motion_section(const TwoKVResult& result);
// two_k_v_report_meshes.cc
[[nodiscard]] std::string reducer_meshes_section(const TwoKVResult& result);

}  // namespace annulus::app
