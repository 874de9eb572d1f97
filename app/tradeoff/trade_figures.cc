#include "app/tradeoff/trade_figures.h"

namespace annulus::app {

const std::vector<TradeFigure>& trade_figures(StageKind kind) {
  static const std::vector<TradeFigure> planetary = {
      {"sun_planet_mean_stiffness_N_per_m", "mean stiffness of the sun mesh"},
      {"ring_planet_mean_stiffness_N_per_m", "mean stiffness of the ring mesh"},
      {"sun_planet_stiffness_entries_N_per_m", "stiffness of the sun mesh, every entry of its table", true, false, 0},
      {"ring_planet_stiffness_entries_N_per_m", "stiffness of the ring mesh, every entry of its table", true, false, 1},
      {"sun_planet_lte_peak_to_peak_m", "transmission error of the sun mesh, peak to peak", false},
      {"ring_planet_lte_peak_to_peak_m", "transmission error of the ring mesh, peak to peak", false},
      {"sun_planet_load_sharing_averaged", "load sharing, averaged over a mesh cycle"},
      {"sun_planet_load_sharing_instantaneous", "load sharing, instantaneous", true, true},
      {"sun_planet_dynamic_factor", "dynamic factor of the sun meshes", true, true},
      {"ring_planet_dynamic_factor", "dynamic factor of the ring meshes", true, true},
      {"frequency_1_Hz", "first natural frequency"},
      {"frequency_2_Hz", "second natural frequency"},
      {"frequency_3_Hz", "third natural frequency"}};
  static const std::vector<TradeFigure> pair = {
      {"pinion_wheel_mean_stiffness_N_per_m", "mean stiffness of the mesh"},
      {"pinion_wheel_stiffness_entries_N_per_m", "stiffness of the mesh, every entry of its table", true, false, 0},
      {"pinion_wheel_lte_peak_to_peak_m", "transmission error under load, peak to peak", false},
      {"dynamic_factor", "dynamic factor", true, true},
      {"transmission_error_peak_to_peak_m", "dynamic transmission error, peak to peak", false},
      {"acceleration_max_m_per_s2", "largest acceleration of the teeth", false},
      {"frequency_1_Hz", "first natural frequency"},
      {"frequency_2_Hz", "second natural frequency"},
      {"frequency_3_Hz", "third natural frequency"}};
  static const std::vector<TradeFigure> reducer = {
      {"sun_planet_mean_stiffness_N_per_m", "mean stiffness of the sun mesh"},
      {"sun_planet_stiffness_entries_N_per_m", "stiffness of the sun mesh, every entry of its table", true, false, 0},
      {"sun_planet_lte_peak_to_peak_m", "transmission error of the sun mesh, peak to peak", false},
      {"sun_planet_dynamic_factor", "dynamic factor of the sun meshes", true, true},
      {"arc_pins_dynamic_factor", "dynamic factor of the arc meshes", true, true},
      {"output_error_peak_to_peak_rad", "error of the output, peak to peak", false},
      {"frequency_1_Hz", "first natural frequency"},
      {"frequency_2_Hz", "second natural frequency"},
      {"frequency_3_Hz", "third natural frequency"}};
  switch (kind) {
    case StageKind::planetary:
      return planetary;
    case StageKind::helical_pair:
      return pair;
    case StageKind::two_k_v:
      break;
  }
  return reducer;
}

}  // namespace annulus::app
