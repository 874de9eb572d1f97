#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/figure.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// What bearings and supports carry over the evaluated window, and how far bodies move, by the keys of body_figures();
/// besides, of every planet the largest (planet2_bearing_force_N) and the mean tangential force on its pin
/// (planet2_tangential_force_N). Load zones are there with play, torques with a held member, orbits where the sun
/// moves. `system`: assemble(stage), of which `found` is the steady state.
[[nodiscard]] FigureSet body_results(const PlanetaryStage& stage, const LumpedSystem& system,
                                     const SteadyResponse& found);

[[nodiscard]] std::vector<FigureSpec> body_figures();

/// Ends of the keys of planets.
inline constexpr const char *force_of_pin = "bearing_force_N", *tangential_force_of_pin = "tangential_force_N";
/// "planet2_bearing_force_N": of one planet, counted from 0.
[[nodiscard]] std::string pin_key(std::size_t planet, const std::string& quantity);

}  // namespace annulus::dynamics
