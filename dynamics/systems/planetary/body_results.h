#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/figure.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// What bearings and supports carry over the evaluated window, and how far bodies move. Not known where there is none.
struct BodyResults {
  struct Pin {
    Figure largest;     ///< N, of the resultant
    Figure tangential;  ///< N, mean
  };
  std::vector<Pin> pins;  ///< of each planet
  Figure pin_force;       ///< N, the largest one
  Figure pin_load_zone;   ///< rad, smallest angle over which rollers of a planet bearing with play carry
  Figure sun_support, ring_support, carrier_support;  ///< N, largest resultant
  Figure held_torque;                                 ///< N m, mean torque on the housing through the held member
  Figure sun_orbit, sun_distance;  ///< m, largest distance of the sun's centre from its mean place and from the axis
  Figure sun_rms, sun_swing;       ///< m, of the sun's centre about its mean place; the larger swing of x and y
  Figure sun_mesh_rms, sun_mesh_swing, ring_mesh_rms, ring_mesh_swing;  ///< m, largest of the meshes' deflections
};

/// `system`: assemble(stage), of which `found` is the steady state.
[[nodiscard]] BodyResults body_results(const PlanetaryStage& stage, const LumpedSystem& system,
                                       const SteadyResponse& found);

/// Those that are not of one planet, by their keys.
struct BodyQuantity {
  const char* key;
  Figure BodyResults::*value;
};
inline constexpr std::array body_quantities{
    BodyQuantity{"planet_bearing_force_N", &BodyResults::pin_force},
    BodyQuantity{"planet_bearing_load_zone_rad", &BodyResults::pin_load_zone},
    BodyQuantity{"sun_support_force_N", &BodyResults::sun_support},
    BodyQuantity{"ring_support_force_N", &BodyResults::ring_support},
    BodyQuantity{"carrier_support_force_N", &BodyResults::carrier_support},
    BodyQuantity{"held_torque_Nm", &BodyResults::held_torque},
    BodyQuantity{"sun_orbit_m", &BodyResults::sun_orbit},
    BodyQuantity{"sun_distance_m", &BodyResults::sun_distance},
    BodyQuantity{"sun_rms_m", &BodyResults::sun_rms},
    BodyQuantity{"sun_peak_to_peak_m", &BodyResults::sun_swing},
    BodyQuantity{"sun_planet_deflection_rms_m", &BodyResults::sun_mesh_rms},
    BodyQuantity{"sun_planet_deflection_peak_to_peak_m", &BodyResults::sun_mesh_swing},
    BodyQuantity{"ring_planet_deflection_rms_m", &BodyResults::ring_mesh_rms},
    BodyQuantity{"ring_planet_deflection_peak_to_peak_m", &BodyResults::ring_mesh_swing}};

struct PinQuantity {
  const char* name;
  Figure BodyResults::Pin::*value;
};
inline constexpr std::array pin_quantities{PinQuantity{"bearing_force_N", &BodyResults::Pin::largest},
                                           PinQuantity{"tangential_force_N", &BodyResults::Pin::tangential}};
/// "planet2_bearing_force_N": of one planet, counted from 0.
[[nodiscard]] std::string pin_key(std::size_t planet, const PinQuantity& quantity);

/// The declarations of body_quantities.
[[nodiscard]] std::vector<FigureSpec> body_figures();

}  // namespace annulus::dynamics
