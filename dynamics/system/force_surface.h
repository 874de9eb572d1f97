#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "dynamics/system/curve_bundle.h"
#include "dynamics/system/pair.h"

namespace annulus::dynamics {

/// The elastic law of a mesh whose stiffness depends on its load: F = F(phase, g), g the deflection beyond the unloaded
/// transmission error (and beyond the backlash). It is smooth and rises with g.
///
/// Why a law and not a stiffness: a table lists two stiffnesses per load, the secant F/g and the tangent dF/dg. The
/// secant at the nominal load makes the mean deflection right and every change of it wrong; the tangent makes small
/// vibrations about the nominal load right and everything else wrong. The force over the deflection contains both: it
/// passes the tabulated deflection at every load with the tabulated tangent, whatever load the mesh carries at the
/// moment. Modes are small vibrations about the nominal load and use the tangent there.
///
/// At a knot of the phase: from zero to the lowest load the parabola with the secant and tangent of that load (if it
/// would start with less than a tenth of the secant, a rational curve that starts with that); between loads the
/// rational quadratic curve of Gregory and Delbourgo (IMA J. Numer. Anal. 2, 1982), which takes positive tangents as
/// they are and never falls; beyond the largest load straight on with its tangent. These curves are resampled as cubic
/// pieces on equidistant deflections, which still pass the tabulated points with their tangents; between the knots of
/// the phase makima slopes act as in PeriodicCurve. The result is one bicubic polynomial per cell, once continuously
/// differentiable everywhere.
///
/// The table describes the drive flanks. The law is continued as an odd function to g < 0: mirrored for contact of the
/// back flanks (whose own stiffness is not tabulated), and for meshes without backlash, which pull.
class ForceSurface {
 public:
  /// Throws InputError when the deflection does not rise with the load or the resulting law is not rising.
  explicit ForceSurface(const StiffnessTable& table);

  struct Value {
    double force = 0;    ///< N
    double tangent = 0;  ///< dF/dg, N/m
  };
  [[nodiscard]] Value operator()(double mesh_cycles, double g) const { return at(grid_.locate(mesh_cycles), g); }
  /// The same at a place found before on `grid`; what the right-hand side calls.
  [[nodiscard]] Value at(const PhaseLocation& place, double g) const;
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
  struct Place {  // polynomial coefficients in the deflection at a phase, or their derivatives along the phase
    Eigen::Array4d in_g;
    double energy_below = 0, x = 0;
  };
  [[nodiscard]] int cell_of(double x) const {
    const double capped = x < last_cell_ ? x : last_cell_;  // also where x is not a number: x itself carries that on
    return static_cast<int>(capped);
  }
  /// The phase runs fastest: from one evaluation to the next the deflection changes little and the phase moves on.
  [[nodiscard]] std::size_t index_of(int piece, int cell) const {
    return static_cast<std::size_t>(cell) * static_cast<std::size_t>(grid_.pieces()) + static_cast<std::size_t>(piece);
  }
  [[nodiscard]] Place place_of(double mesh_cycles, double g, bool derivative) const;
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

inline ForceSurface::Value ForceSurface::at(const PhaseLocation& place, double g) const {
  const double x = std::abs(g) * inverse_step_, p = place.local;
  const int cell = cell_of(x);
  const double* c = coefficients_.data() + 16 * index_of(place.piece, cell);
  const Pair low = pair_at(c) + p * (pair_at(c + 4) + p * (pair_at(c + 8) + p * pair_at(c + 12)));
  const Pair high = pair_at(c + 2) + p * (pair_at(c + 6) + p * (pair_at(c + 10) + p * pair_at(c + 14)));
  const double s = x - cell;
  const double force = low[0] + s * (low[1] + s * (high[0] + s * high[1]));
  const double tangent = (low[1] + s * (2 * high[0] + 3 * s * high[1])) * inverse_step_;
  return {std::copysign(force, g), tangent};
}

}  // namespace annulus::dynamics
