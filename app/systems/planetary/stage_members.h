#pragma once

#include "app/model/dynamics_members.h"
#include "app/systems/planetary/coupling_effect.h"
#include "app/systems/planetary/stage_response.h"
#include "app/systems/shared/space_members.h"
#include "dynamics/systems/planetary/sharing_tolerances.h"

/// A planetary stage and what is cached of its responses (core/bytes.h).
namespace annulus {

ANNULUS_MEMBERS(dynamics::Deviation, amount, phase);
ANNULUS_MEMBERS(dynamics::BodyErrors, eccentricity, position);
ANNULUS_MEMBERS(dynamics::CentralBody, mass, inertia, radius, support, torsional_support, errors, damping_ratio);
ANNULUS_MEMBERS(dynamics::PlanetBody, mass, inertia, radius, damping_ratio);
ANNULUS_MEMBERS(dynamics::PlanetBearing, radial, tangential, play, pin);
ANNULUS_MEMBERS(dynamics::StageSpace::TiltInertia, sun, ring, carrier, planet);
ANNULUS_MEMBERS(dynamics::StageSpace::MassPlace, sun, ring, carrier);
template <>
struct Members<dynamics::StageSpace> {
  template <class Space>
  static auto of(Space& s) {
    return std::tie(static_cast<dynamics::SpaceSupports&>(s), s.base_helix_angle, s.planet_working_radius_sun,
                    s.planet_working_radius_ring, s.sun_face, s.ring_face, s.tilt_inertia, s.mass_place, s.ring_mounts);
  }
};
ANNULUS_MEMBERS(dynamics::PlanetaryStage, sun, ring, carrier, planet, planet_bearings, planet_angles, planet_errors,
                sun_tooth_errors, ring_tooth_errors, sun_working_angle, ring_working_angle, sun_teeth, planet_teeth,
                ring_teeth, sun_mesh, ring_mesh, sun_phase_lag, ring_phase_lag, ring_tooth_offset, ring_coupling,
                planet_coupling, sun_half_backlash, ring_half_backlash, mesh_damping_ratio, sun_mesh_damping_ratio,
                ring_mesh_damping_ratio, support_damping_ratio, structural_damping, damping_without_contact,
                sun_friction, ring_friction, sun_film, ring_film, carrier_speed, ring_speed, bearing_speed, sun_torque,
                held, rotating_frame, space, rotors);

ANNULUS_MEMBERS(dynamics::LoadSharing, instantaneous, averaged, quasi_static);
ANNULUS_MEMBERS(dynamics::BranchResult, peak_factor, dynamic_factor, smallest_factor, mean_force, contact_loss,
                back_flanks);
ANNULUS_MEMBERS(dynamics::MeshKindResult, load_sharing, branches);
/// Without its time series.
template <>
struct Members<dynamics::DynamicResponse> {
  template <class Response>
  static auto of(Response& r) {
    return std::tie(static_cast<dynamics::SteadyOutcome&>(r), r.mesh_frequency, r.mean_mesh_force, r.sun_planet,
                    r.ring_planet, r.cycle_force, r.force_balance_relative, r.bodies, r.shafts);
  }
};

ANNULUS_MEMBERS(dynamics::Interval, value, low, high);
ANNULUS_MEMBERS(dynamics::SharingQuantiles, p50, p95, p99);
ANNULUS_MEMBERS(dynamics::AssemblySharing::Contribution, tolerance, radius, alone, without);
ANNULUS_MEMBERS(dynamics::AssemblySharing, torque_shares, factors, quantiles, contributions, largest_force);
ANNULUS_MEMBERS(dynamics::StageTolerances, planet_pin_position, sun_eccentricity, planet_eccentricity,
                ring_eccentricity, within);

ANNULUS_MEMBERS(app::StageModes::Mode, frequency, frequency_error, error_parts, kind, damped_frequency, damping_ratio,
                strain, kinetic);
ANNULUS_MEMBERS(app::StageModes, groups, bodies, list, shapes, campbell, critical_speeds);
ANNULUS_MEMBERS(app::StageMotion, section, section_period, section_clusters, bearing_forces, space, sun_orbit,
                poincare);
ANNULUS_MEMBERS(app::StageResponse, figures, errors, modes, motion, load_sharing, force_factors, waveform,
                sharing_waveform, spectrum, gauge_spectrum, time_series, reused);
ANNULUS_MEMBERS(app::CouplingEffect::Row, model, averaged, instantaneous, quasi_static, sun_factor, ring_factor);
ANNULUS_MEMBERS(app::CouplingEffect, rows, cycles);

}  // namespace annulus
