#pragma once

#include <string>
#include <vector>

#include "app/sections/report_parts.h"
#include "app/systems/two_k_v/two_k_v_run.h"

/// The sections of the report of a 2K-V stage, made from the results alone.
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

/// Label and colour of every case.
[[nodiscard]] Legend case_legend(const TwoKVResult& result);

// reducer_geometry.cc
[[nodiscard]] Section drawings_section(const TwoKVResult& result);  ///< the gears to scale
// reducer_vibration.cc; without blocks when [dynamics] is missing
[[nodiscard]] Section frequencies_section(const TwoKVResult& result);      ///< over the crank angle, shapes
[[nodiscard]] Section first_frequency_section(const TwoKVResult& result);  ///< what it depends on, bands
[[nodiscard]] Section torsion_section(const TwoKVResult& result);          ///< torsional stiffness, lost motion
/// The first mode that is no free rotation.
[[nodiscard]] std::size_t first_elastic_mode(const TwoKVVibration& vibration);
/// Output error, peak to peak, arc seconds; "0" where it is rounding.
[[nodiscard]] std::string error_text(const TwoKVMotion& motion);

// reducer_motion.cc; without blocks when [dynamics] is missing
[[nodiscard]] Section reducer_motion_section(const TwoKVResult& result);
// reducer_meshes.cc
[[nodiscard]] Section reducer_meshes_section(const TwoKVResult& result);

}  // namespace annulus::app
