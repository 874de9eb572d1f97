#pragma once

#include "app/model/dynamics_members.h"
#include "app/systems/helical_pair/pair_run.h"
#include "app/systems/shared/space_members.h"

/// What is cached of the response of a pair (core/bytes.h).
namespace annulus {

ANNULUS_MEMBERS(dynamics::Mode, frequency, shape);
ANNULUS_MEMBERS(dynamics::Modes, dofs, modes);
ANNULUS_MEMBERS(dynamics::PairAccelerations, line_of_action, axial, rotation, tooth);
ANNULUS_MEMBERS(dynamics::MotionFigures, mean, peak_to_peak, largest);
ANNULUS_MEMBERS(dynamics::PairMotions, transmission_error, relative);
/// Without its time series.
template <>
struct Members<dynamics::PairResponse> {
  template <class Response>
  static auto of(Response& r) {
    return std::tie(static_cast<dynamics::SteadyOutcome&>(r), r.mesh_frequency, r.static_force, r.force_max,
                    r.force_min, r.force_mean, r.dynamic_factor, r.peak_factor, r.contact_loss, r.acceleration,
                    r.dynamic, r.quasi_static, r.shafts);
  }
};
ANNULUS_MEMBERS(dynamics::PeakToPeak, dynamic, quasi_static);
ANNULUS_MEMBERS(dynamics::TransmissionErrorShares, all, errors_alone, stiffness_alone, load_deflection);
ANNULUS_MEMBERS(app::ShareRow, pinion_torque, shares, largest_dynamic, largest_static, failure);
ANNULUS_MEMBERS(app::SpeedRow::Motion, acceleration, peak_to_peak_force, peak_to_peak_te);
ANNULUS_MEMBERS(app::SpeedRow, pinion_speed, all, errors_alone, stiffness_alone, failure);
ANNULUS_MEMBERS(app::PairResponseResult, figures, results, modes, series, spectrum, space, shares, speeds);

}  // namespace annulus
