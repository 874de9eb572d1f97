#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "core/stiffness_table.h"
#include "dynamics/system/force_surface.h"

namespace annulus::dynamics {

/// Mesh stiffness that never changes.
struct ConstantStiffness {
  double mean = 0;  ///< N/m
};

/// k = mean (1 + ripple cos 2 pi (phase - phase_shift)), phase in mesh cycles.
struct HarmonicStiffness {
  double mean = 0;         ///< N/m
  double ripple = 0;       ///< kappa, in [0, 1)
  double phase_shift = 0;  ///< mesh cycles
};

/// k = mean (1 + ripple (s - duty)): s = 1 while the fractional part of (phase - phase_shift) is below `duty`, else 0.
/// The integrators restart at the jumps, which are never smoothed.
struct RectangularStiffness {
  double mean = 0;         ///< N/m, the mean over a cycle
  double ripple = 0;       ///< eps; the stiffness must stay positive
  double duty = 0.5;       ///< in (0, 1)
  double phase_shift = 0;  ///< mesh cycles
};

/// Stiffness and unloaded transmission error from a table (see curves_at_load), in one of two ways:
/// - without `surface`: linear, F = k g with the *secant* stiffness at the nominal mesh force. The nominal load then
///   acts at the tabulated loaded transmission error, but changes of the load act on the wrong stiffness.
/// - with `surface`: the law of force over deflection, right at every tabulated load (see ForceSurface).
/// In both cases `modes` uses the mean tangent: modes are small vibrations about the nominal load.
struct TableStiffness {
  PeriodicCurve secant;                           ///< N/m
  PeriodicCurve tangent;                          ///< N/m
  PeriodicCurve unloaded_te;                      ///< m; enters e(t)
  double phase_shift = 0;                         ///< mesh cycles
  std::shared_ptr<const ForceSurface> surface{};  ///< absent: linear
  /// Mesh cycles: at phase p back flanks have what the table has at this less p (geometry::GearPair::back_flank_phase).
  /// Absent: what it has at p. Their unloaded transmission error is that of the driving flanks in any case.
  std::optional<double> back_flank_phase{};
};

/// Excitation of one kind of mesh. Several meshes share it, each shifted by its own phase.
using MeshExcitation = std::variant<ConstantStiffness, HarmonicStiffness, RectangularStiffness, TableStiffness>;

/// Part of the transmission error of a mesh: amount x sin(rate t + phase), in m, rad/s and rad.
struct HarmonicError {
  double amount = 0, rate = 0, phase = 0;
  bool operator==(const HarmonicError&) const = default;
};

/// Part of the transmission error of a mesh that follows its teeth, m: the curve at `frequency` t + `phase_offset` mesh
/// cycles.
struct ToothError {
  PeriodicCurve curve;
  double phase_offset = 0;
};

enum class LoadDependence {
  nominal,  ///< linear with the secant stiffness at the nominal load
  table,    ///< the law of force over deflection that all loads of the table give
};

/// TableStiffness at one total normal force `load` (N). Throws InputError outside the tabulated loads.
[[nodiscard]] TableStiffness table_stiffness(const StiffnessTable& table, double load, double phase_shift = 0,
                                             LoadDependence dependence = LoadDependence::nominal);

/// Mean stiffness over the period, N/m; for tables the secant at the nominal load.
[[nodiscard]] double mean_stiffness(const MeshExcitation& excitation);
/// Mean stiffness for modes, N/m; for tables the tangent at the nominal load.
[[nodiscard]] double mean_tangent_stiffness(const MeshExcitation& excitation);
/// Whole mesh cycles after which the excitation repeats.
[[nodiscard]] int period_in_cycles(const MeshExcitation& excitation);
/// Throws InputError with `name` when the stiffness is not positive at every phase or a ratio is out of range.
void check(const MeshExcitation& excitation, const std::string& name);

}  // namespace annulus::dynamics
