#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/figure.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/system/drive_line.h"

namespace annulus::dynamics {

/// What the shaft of a rotor carries in a steady state.
struct ShaftResult {
  std::string name, on;        ///< of the rotor, and where its shaft leads to
  double nominal_torque = 0;   ///< N m, >= 0: that of its body
  double mean_torque = 0;      ///< N m, positive in the sense of the nominal one
  double smallest_torque = 0;  ///< N m; negative: the couplings bear on their other sides
  Figure largest_torque;       ///< N m, of its amount
  Figure contact_loss;         ///< fraction of the time in which a coupling with backlash passes on nothing

  [[nodiscard]] Figure torque_factor() const;  ///< largest over nominal torque; not known without one
};

/// Of an element whose forces are torques over a radius (m), under the nominal force `load` (N); without its names.
struct ShaftLoad {
  double load = 0, radius = 0;
};
[[nodiscard]] ShaftResult shaft_result(const LumpedSystem& system, const std::string& element, const ShaftLoad& nominal,
                                       const SteadyResponse& found);
/// Of a system with these rotors (with_rotors), in their order.
[[nodiscard]] std::vector<ShaftResult> shaft_results(const LumpedSystem& system, const std::vector<Rotor>& rotors,
                                                     const std::vector<ShaftEnd>& ends, const SteadyResponse& found);

/// Largest torque factor of all shafts.
inline constexpr const char* shaft_key = "shaft_torque_factor";
[[nodiscard]] FigureSpec shaft_figure();
/// Sets it where there are shafts.
void add_shafts(FigureSet& figures, const std::vector<ShaftResult>& shafts);
/// <name>_torque_Nm.
[[nodiscard]] std::string torque_key(const ShaftResult& shaft);
/// Sets the largest torque of every shaft by itself.
void add_each_shaft(FigureSet& figures, const std::vector<ShaftResult>& shafts);
/// Takes the errors of these back from the results.
void set_errors(std::vector<ShaftResult>& shafts, const FigureSet& figures);
/// The one with the largest torque factor. Throws InternalError without shafts.
[[nodiscard]] std::size_t worst_shaft(const std::vector<ShaftResult>& shafts);

}  // namespace annulus::dynamics
