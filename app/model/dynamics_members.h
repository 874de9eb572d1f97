#pragma once

#include "core/bytes.h"
#include "dynamics/figures/shaft_results.h"
#include "dynamics/friction/flank_friction.h"
#include "dynamics/modes/structural_damping.h"
#include "dynamics/steady_state/branches.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/system/mesh_excitation.h"

/// Inputs and results that lumped models of all kinds share, for identities and cached values (core/bytes.h).
namespace annulus {

ANNULUS_MEMBERS(dynamics::ConstantStiffness, mean);
ANNULUS_MEMBERS(dynamics::HarmonicStiffness, mean, ripple, phase_shift);
ANNULUS_MEMBERS(dynamics::RectangularStiffness, mean, ripple, duty, phase_shift);

/// For identities alone: nothing is read back.
template <>
struct Members<PeriodicCurve> {
  template <class Archive>
  static void pass(Archive& archive, PeriodicCurve& curve) {
    for (int piece = 0; piece < curve.pieces(); ++piece)
      for (double c : curve.coefficients(piece)) annulus::pass(archive, c);
    double period = curve.period(), pieces = curve.pieces();
    annulus::pass(archive, period);
    annulus::pass(archive, pieces);
  }
};
ANNULUS_MEMBERS(dynamics::ToothError, curve, phase_offset);
ANNULUS_MEMBERS(dynamics::Sliding, side, distance);
ANNULUS_MEMBERS(dynamics::FlankFriction, coefficient, sliding);
ANNULUS_MEMBERS(dynamics::SqueezeFilm, coefficient, least_gap);

/// The curves follow from a table, which is an input of its own (table_behind).
template <>
struct Members<dynamics::TableStiffness> {
  template <class Archive>
  static void pass(Archive& archive, dynamics::TableStiffness& stiffness) {
    bool all_loads = stiffness.surface != nullptr;
    annulus::pass(archive, all_loads);
    annulus::pass(archive, stiffness.phase_shift);
    annulus::pass(archive, stiffness.back_flank_phase);
  }
};

ANNULUS_MEMBERS(dynamics::IntegratorOptions, method, relative_tolerance, absolute_tolerance, fixed_step, max_steps);
ANNULUS_MEMBERS(dynamics::PeriodicOptions, samples, sampling_tolerance, max_samples, max_ahead, tolerance,
                max_iterations);
ANNULUS_MEMBERS(dynamics::StructuralDamping, modal_ratio, of_mass, of_stiffness);
ANNULUS_MEMBERS(dynamics::SystemState, time, q, v, supplied, dissipated);
/// The number of threads changes no result.
template <>
struct Members<dynamics::MotionSearch> {
  template <class Archive>
  static void pass(Archive& archive, dynamics::MotionSearch& search) {
    annulus::pass(archive, search.starts);
    annulus::pass(archive, search.size);
  }
};
ANNULUS_MEMBERS(dynamics::SimulationOptions, steady_state, confirmation, sampling, beyond, tolerance_rule, keep_series,
                periodic, integrator, start, mesh_cycles, steady_tolerance, max_windows, samples, min_window,
                max_window, estimate_error, other_motions);

ANNULUS_MEMBERS(dynamics::Rotor::Ripple, order, amplitude, phase);
ANNULUS_MEMBERS(dynamics::Rotor, name, on, inertia, shaft_stiffness, shaft_damping_ratio, half_backlash, ripples);
ANNULUS_MEMBERS(dynamics::ShaftResult, name, on, nominal_torque, mean_torque, smallest_torque, largest_torque,
                contact_loss);
ANNULUS_MEMBERS(dynamics::PeriodicSolution, method, converged, trouble, residual, newton_iterations, linear_iterations,
                sampling_difference, largest_multiplier, longer_angle);
ANNULUS_MEMBERS(dynamics::IntegratorChoice, method, reason, stability_step, implicit_step, explicit_steps,
                least_damping);
ANNULUS_MEMBERS(dynamics::EnergyBalance, supplied, dissipated, change, relative);
ANNULUS_MEMBERS(dynamics::IntegratorStatistics, steps, rhs_evaluations, jacobian_evaluations, contact_events,
                stiffness_restarts);
ANNULUS_MEMBERS(dynamics::FoundMotion, period, largest_force, contact_loss, starts, taken);
ANNULUS_MEMBERS(dynamics::FoundMotions, reach, wanted, starts, not_tried, list, undecided);
ANNULUS_MEMBERS(dynamics::SteadyOutcome, window_cycles, whole_period, total_cycles, steady, confirmed,
                steady_difference, periodic, integrator, energy, statistics, motions, begin, end);

ANNULUS_MEMBERS(dynamics::BranchPoint, input, largest_force, contact_loss, multiplier, stable);
ANNULUS_MEMBERS(dynamics::BranchEvent, kind, input, error, before);
ANNULUS_MEMBERS(dynamics::Branch, points, events, end);

}  // namespace annulus
