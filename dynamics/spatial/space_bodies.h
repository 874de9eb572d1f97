#pragma once

#include <functional>
#include <vector>

#include "dynamics/spatial/linear_supports.h"
#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Coordinates of a body as forms of DOFs; empty ones stay 0. Displacements and u in m, tilts in rad; those of a planet
/// are radial and tangential.
struct BodyForms {
  LinearForm x, y, u, z, tilt_x, tilt_y;
};

/// A body that moves along the axis and tilts.
struct SpaceBody {
  StageBody body;
  double mass = 0, inertia = 0;  ///< kg, kg m^2 about the axis
  double radius = 0;             ///< m: u is this times the rotation
  double tilt_inertia = 0;       ///< kg m^2, about axes across the body's own, in its middle
  double mass_place = 0;         ///< m, z of the centre of mass from the middle; 0 of planets
  double spin = 0;               ///< rad/s about its axis, in space
  double torsional_support = 0;  ///< N/m on the radius; `rigid`: it does not turn beside its speed
  double damping_ratio = 0;      ///< of its bearings; of modes in which several bodies move, mixed
};

/// What all bodies have in common.
struct SpaceFrame {
  double speed = 0;          ///< rad/s, of the axes in which they are described
  double carrier_speed = 0;  ///< rad/s, past what stands in the housing
};

/// Coordinates (x, y, z, about x, about y) of the body `on` in the middle of another one and in its axes; 5 empty ones
/// for the housing. `forms`: of the bodies before it, in their order.
using SeatOf = std::function<std::vector<LinearForm>(const std::vector<BodyForms>& forms, const StageBody& body,
                                                     const StageBody& on)>;

/// Adds bodies with their bearings and loads, in this order. DOFs of each: x, y, z, tiltx, tilty (radius x tilt, m) as
/// far as no bearing holds them rigidly, and u. A spring carries the name of its body and its bearing. Throws
/// InputError where a body has less tilting inertia than its mass beside its middle.
[[nodiscard]] std::vector<BodyForms> add_space_bodies(LumpedSystemBuilder& builder, const SpaceSupports& supports,
                                                      const std::vector<SpaceBody>& bodies, const SpaceFrame& frame,
                                                      const SeatOf& seat);

/// 5 empty coordinates.
[[nodiscard]] std::vector<LinearForm> seat_in_housing();
/// Coordinates of a body against what it stands on, in its middle.
[[nodiscard]] std::vector<LinearForm> against(const BodyForms& body, const std::vector<LinearForm>& seat);
/// Those at z = `place` (m).
[[nodiscard]] std::vector<LinearForm> at_place(const std::vector<LinearForm>& in_middle, double place);

/// Spreads a mesh over its face, which takes its backlash: the mesh and what its end approaches by more than its middle
/// become the components of a face. `tilt`: that approach. Returns the second component, to be added as mesh `second`.
[[nodiscard]] MeshElement spread_over_face(LumpedSystemBuilder& builder, MeshElement& mesh, const SpreadFace& face,
                                           const LinearForm& tilt, int number, int second);

}  // namespace annulus::dynamics
