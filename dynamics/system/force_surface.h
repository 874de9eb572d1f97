#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "dynamics/system/curve_bundle.h"
#include "dynamics/system/two_doubles.h"

namespace annulus::dynamics {

/// Elastic law of a mesh whose stiffness depends on its load: F = F(phase, g). g is the deflection beyond the unloaded
/// transmission error and beyond the backlash. F is smooth and rises with g.
///
/// A table lists two stiffnesses per load, the secant F/g and the tangent dF/dg. The secant at the nominal load gives
/// the right mean deflection only; the tangent gives the right small vibrations about the nominal load only. The law
/// contains both: it passes through the tabulated deflection of every load with the tabulated tangent. Modes are small
/// vibrations about the nominal load and use the tangent there.
///
/// Curve over g at a knot of the phase:
/// - from zero to the lowest load: the parabola with the secant and tangent of that load. If its initial tangent would
///   be below a tenth of the secant, a rational curve with that initial tangent.
/// - between loads: the rational quadratic curve of [GregoryDelbourgo1982], which keeps positive tangents and never
///   falls.
/// - beyond the largest load: a straight line with its tangent.
///
/// These curves are resampled as cubic pieces on equidistant deflections, which still pass the tabulated points with
/// their tangents. Between the knots of the phase makima slopes act as in PeriodicCurve. The result is one bicubic
/// polynomial per cell with continuous first derivatives.
///
/// The table describes the drive flanks. For g < 0 the law continues as an odd function. It then stands for the back
/// flanks, read at the phase of TableStiffness::back_flank_phase, and for meshes without backlash, which pull.
class ForceSurface {
 public:
  /// Throws InputError when the deflection does not rise with the load or the resulting force does not rise with it.
  explicit ForceSurface(const StiffnessTable& table);

  struct Value {
    double force = 0;    ///< N
    double tangent = 0;  ///< dF/dg, N/m
  };
  /// Force at a phase (mesh cycles) and a deflection g (m).
  [[nodiscard]] Value operator()(double mesh_cycles, double g) const { return at(grid_.locate(mesh_cycles), g); }
  /// The same at a location on `grid` found before. The right-hand side calls this one.
  [[nodiscard]] Value at(const PhaseLocation& location, double g) const;
  /// U = integral of F dg from 0 to g, J.
  [[nodiscard]] double energy(double mesh_cycles, double g) const;
  /// dU/d(mesh cycles) at constant g, J.
  [[nodiscard]] double energy_rate(double mesh_cycles, double g) const;

  [[nodiscard]] const PhaseGrid& grid() const { return grid_; }
  [[nodiscard]] double smallest_load() const { return smallest_load_; }  ///< N, tabulated
  [[nodiscard]] double largest_load() const { return largest_load_; }    ///< N, tabulated
  /// Largest relative deviation of F and dF/dg from a tabulated load and tangent at its deflection.
  [[nodiscard]] double resampling_error() const { return resampling_error_; }

 private:
  /// Polynomial coefficients in the deflection at a phase, or their derivatives along the phase.
  struct PhaseCoefficients {
    // phase
    Eigen::Array4d in_g;
    double energy_below = 0, x = 0;
  };
  [[nodiscard]] int cell_of(double x) const {
    const double capped = x < last_cell_ ? x : last_cell_;  // NaN as well: x itself passes it on
    return static_cast<int>(capped);
  }
  /// The phase is the fastest index: from one evaluation to the next the deflection changes little.
  [[nodiscard]] std::size_t index_of(int piece, int cell) const {
    return static_cast<std::size_t>(cell) * static_cast<std::size_t>(grid_.pieces()) + static_cast<std::size_t>(piece);
  }
  enum class AlongPhase { value, derivative };
  [[nodiscard]] PhaseCoefficients coefficients_at(double mesh_cycles, double g, AlongPhase kind) const;
  void build(const StiffnessTable& table, double largest_deflection, int cells);
  void check(const StiffnessTable& table) const;

  PhaseGrid grid_;
  double step_ = 1, inverse_step_ = 1;  ///< of the deflection, m
  double last_cell_ = 0;                ///< the cell in which the law is straight; it holds for all larger deflections
  int cells_ = 0;
  std::vector<double> coefficients_;  ///< [cell][phase piece][power of the phase 0 ... 3][power of g 0 ... 3], N
  std::vector<double> energy_;        ///< [cell][phase piece][power of the phase]: U at the lower end of the cell, J
  double smallest_load_ = 0, largest_load_ = 0, resampling_error_ = 0;
};

inline ForceSurface::Value ForceSurface::at(const PhaseLocation& location, double g) const {
  const double x = std::abs(g) * inverse_step_, p = location.local;
  const int cell = cell_of(x);
  const double* c = coefficients_.data() + 16 * index_of(location.piece, cell);
  const TwoDoubles low =
      two_doubles_at(c) + p * (two_doubles_at(c + 4) + p * (two_doubles_at(c + 8) + p * two_doubles_at(c + 12)));
  const TwoDoubles high =
      two_doubles_at(c + 2) + p * (two_doubles_at(c + 6) + p * (two_doubles_at(c + 10) + p * two_doubles_at(c + 14)));
  const double s = x - cell;
  const double force = low[0] + s * (low[1] + s * (high[0] + s * high[1]));
  const double tangent = (low[1] + s * (2 * high[0] + 3 * s * high[1])) * inverse_step_;
  return {std::copysign(force, g), tangent};
}

}  // namespace annulus::dynamics
