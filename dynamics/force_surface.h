#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "dynamics/curve_bundle.h"

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
/// they are and never falls; beyond the largest load straight on with its tangent. These curves are resampled on
/// equidistant deflections with their values and tangents; between the knots of the phase makima slopes act as in
/// PeriodicCurve. The result is one bicubic polynomial per cell, once continuously differentiable everywhere.
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
  /// Largest deviation of F from a tabulated load at its deflection, relative to that load: the resampling error.
  [[nodiscard]] double resampling_error() const { return resampling_error_; }

 private:
  struct Place {  // polynomial coefficients in the deflection at a phase, or their derivatives along the phase
    Eigen::Array4d in_g;
    double energy_below = 0, x = 0;
  };
  [[nodiscard]] std::size_t cell_of(double x) const {
    const double capped = x < last_cell_ ? x : last_cell_;  // also where x is not a number: x itself carries that on
    return static_cast<std::size_t>(capped);
  }
  [[nodiscard]] Place place_of(double mesh_cycles, double g, bool derivative) const;
  void build(const StiffnessTable& table, double largest_deflection, int cells);
  void check(const StiffnessTable& table) const;

  PhaseGrid grid_;
  double step_ = 1, inverse_step_ = 1;  ///< of the deflection, m
  double last_cell_ = 0;                ///< the cell in which the law is straight; it holds for all larger deflections
  std::size_t cells_ = 0;
  std::vector<double> coefficients_;  ///< [phase piece][cell][power of the phase 0 ... 3][power of g 0 ... 3], N
  std::vector<double> energy_;        ///< [phase piece][cell][power of the phase]: U at the lower end of the cell, J
  double smallest_load_ = 0, largest_load_ = 0, resampling_error_ = 0;
};

inline ForceSurface::Value ForceSurface::at(const PhaseLocation& place, double g) const {
  using Row = Eigen::Map<const Eigen::Array4d>;
  const double x = std::abs(g) * inverse_step_, p = place.local;
  const std::size_t cell = cell_of(x);
  const double* c = coefficients_.data() + 16 * (static_cast<std::size_t>(place.piece) * cells_ + cell);
  const Eigen::Array4d in_g = Row(c) + p * (Row(c + 4) + p * (Row(c + 8) + p * Row(c + 12)));
  const double s = x - static_cast<double>(cell);
  const double force = in_g[0] + s * (in_g[1] + s * (in_g[2] + s * in_g[3]));
  const double tangent = (in_g[1] + s * (2 * in_g[2] + 3 * s * in_g[3])) * inverse_step_;
  return {std::copysign(force, g), tangent};
}

}  // namespace annulus::dynamics
