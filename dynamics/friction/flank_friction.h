#pragma once

#include <vector>

#include "core/pair_shares.h"
#include "dynamics/system/lumped_system.h"

namespace annulus::geometry {
class GearPair;
}

namespace annulus::dynamics {

/// Where tooth pairs carry the force of their mesh, over a mesh cycle: means over all pairs by their shares of it.
struct Sliding {
  PeriodicCurve side;  ///< 1 of a pair beyond the pitch point, in the sense in which it moves as the phase grows; -1
  PeriodicCurve distance;  ///< m, from the pitch point along the line of action
  bool operator==(const Sliding&) const = default;
};

/// The load of a pair is even along its contact lines. `shares` are linear between their phases. Both curves have 256
/// values per mesh cycle or more, each the mean around its phase: at the pitch point the side changes within one of
/// these. Throws InputError for shares without phases.
[[nodiscard]] Sliding sliding_of(const geometry::GearPair& pair, const PairShares& shares);

/// Shares by the lengths of contact lines on the theoretical path of contact: those of stiff teeth with an even load.
[[nodiscard]] PairShares even_shares(const geometry::GearPair& pair);

/// Friction on the flanks of a mesh, by Coulomb's law.
struct FlankFriction {
  /// Coefficient of friction; where the force of the mesh is that of the transverse section, over cos(base helix
  /// angle): friction is the coefficient times the force along the normal.
  double coefficient = 0;
  Sliding sliding;
  bool operator==(const FlankFriction&) const = default;
};

/// The motion of a body of a mesh at the pitch point less that of the other one. The first body is the one that
/// presses on the other along n.
struct PitchPointMotion {
  LinearForm across;    ///< m, along z x n
  LinearForm rotation;  ///< rad, counter-clockwise
};

/// Senses, +1 or -1.
struct SlidingSense {
  int contact = 1;   ///< of the contact along n as the phase grows
  int rotation = 1;  ///< of the first body against the second, counter-clockwise; 0: they do not turn
};

/// A pair at a distance s from the pitch point along n slides with (w_1 - w_2) s across n. Its friction acts against
/// that on the first body, with the moment -mu F |s| sgn(w_1 - w_2) about the pitch point, and on the second body the
/// other way round. Both are power lost: mu F |s| |w_1 - w_2|. Back flanks slide like driving ones.
[[nodiscard]] std::vector<FrictionShare> friction_shares(const FlankFriction& friction, const PitchPointMotion& motion,
                                                         const SlidingSense& sense);

/// m: of the curvature of both flanks in the pitch point together, over cos(base helix angle).
[[nodiscard]] double pitch_point_radius(const geometry::GearPair& pair);

/// Inputs of the mean coefficient of friction.
struct MeanFilm {
  double line_load = 0;         ///< N/m: transverse force over the face width; at least 150 N/mm are taken
  double pitch_velocity = 0;    ///< m/s, of the pitch circles against the axes of both gears; at most 50 m/s are taken
  double viscosity = 0;         ///< Pa s, of the oil at its temperature
  double roughness = 0;         ///< m: Ra, mean of both gears
  double lubricant_factor = 1;  ///< X_L: 1 mineral oil
};

/// mu = 0.048 (w / (v_sum rho))^0.2 eta^-0.05 Ra^0.25 X_L, with w in N/mm, v_sum = 2 v sin(alpha_wt) in m/s, rho in mm
/// the curvature of both flanks in the pitch point over cos(base helix angle), eta in mPa s and Ra in µm
/// [ISO14179-2]. Throws InputError when an input is not positive.
[[nodiscard]] double mean_coefficient_of_friction(const geometry::GearPair& pair, const MeanFilm& film);

}  // namespace annulus::dynamics
