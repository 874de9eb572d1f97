#pragma once

#include "app/model/dynamics_members.h"
#include "app/systems/two_k_v/two_k_v_model.h"
#include "app/systems/two_k_v/two_k_v_motion.h"

/// A 2K-V stage and what is cached of its responses (core/bytes.h).
namespace annulus {

ANNULUS_MEMBERS(dynamics::TwoKVStage, sun_teeth, planet_teeth, arc_teeth, pins, cranks, arc_gears, module,
                pressure_angle, eccentricity, input_inertia, sun_inertia, planet_inertia, planet_mass, crank_inertia,
                arc_inertia, arc_mass, output_inertia, input_shaft, crank_shaft, crank_bearing, arc_bearing, sun_mesh,
                arc_mesh, input_support, output_support, sun_half_backlash, arc_half_backlash, damping_without_contact,
                mesh_damping, sun_mesh_damping, arc_mesh_damping, support_damping, input_damping, crank_shaft_damping,
                crank_bearing_damping, arc_bearing_damping, output_damping, structural_damping, crank_angle,
                output_speed, output_torque, rotors);
ANNULUS_MEMBERS(dynamics::ArcToothMesh, pins, eccentricity, pin_circle_radius, pin_radius, arc_radius, width,
                youngs_modulus, poisson_ratio, clearance, approach);
ANNULUS_MEMBERS(app::TwoKVModels, at_nominal, moving, arc_clearance);

ANNULUS_MEMBERS(dynamics::BranchResult, peak_factor, dynamic_factor, smallest_factor, mean_force, contact_loss,
                back_flanks);
ANNULUS_MEMBERS(dynamics::ArcBearingResult, crank, arc_gear, largest, mean);
ANNULUS_MEMBERS(app::TwoKVMotion, crank_frequency, sun_frequency, arc_frequency, mean_sun_force, mean_arc_force,
                crank_turns, total_cycles, steady, steady_difference, torque_balance, largest_multiplier, energy,
                motions, peak_to_peak, error_mean, static_mean, static_peak_to_peak, sun_planet, arc_pins, arc_bearings,
                shafts, results, output_error, static_error, spectrum, forces, time_series, reused);

}  // namespace annulus
