#include "dynamics/system/force_surface.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

struct CurvePoint {
  double g = 0, force = 0, tangent = 0;
};

/// The rational quadratic of [GregoryDelbourgo1982] between two points with positive tangents: rises everywhere
/// between.
ForceSurface::Value rational_quadratic(const CurvePoint& a, const CurvePoint& b, double g) {
  const double width = b.g - a.g, secant = (b.force - a.force) / width, x = (g - a.g) / width, rest = 1 - x;
  const double bend = a.tangent + b.tangent - 2 * secant, denominator = secant + bend * x * rest;
  const double force = a.force + (b.force - a.force) * (secant * x * x + a.tangent * x * rest) / denominator;
  const double tangent = secant * secant * (b.tangent * x * x + 2 * secant * x * rest + a.tangent * rest * rest) /
                         (denominator * denominator);
  return {force, tangent};
}

/// Force over deflection at one position and phase of the table: zero, then every load.
std::vector<CurvePoint> curve_at(const StiffnessTable& table, int position, int phase) {
  std::vector<CurvePoint> curve(1);
  for (std::size_t j = 0; j < table.loads().size(); ++j) {
    const auto& e = table.at(position, phase, static_cast<int>(j));
    const double g = e.lte - e.unloaded_te;
    if (!(g > curve.back().g))
      throw InputError(fmt::format("stiffness table {}: position {}, phase {}: the deflection does not rise to {:g} N",
                                   table.mesh(), position, phase, table.loads()[j]));
    curve.push_back({g, table.loads()[j], e.stiffness_tangent});
  }
  const double secant = curve[1].force / curve[1].g;
  curve[0].tangent = std::max(2 * secant - curve[1].tangent, 0.1 * secant);
  return curve;
}

ForceSurface::Value force_on_curve(const std::vector<CurvePoint>& curve, double g) {
  const auto& end = curve.back();
  if (g >= end.g) return {end.force + end.tangent * (g - end.g), end.tangent};
  std::size_t i = 1;
  while (curve[i].g <= g) ++i;
  return rational_quadratic(curve[i - 1], curve[i], g);
}

double miss(const ForceSurface::Value& value, const CurvePoint& point) {
  return std::max(std::abs(value.force / point.force - 1), std::abs(value.tangent / point.tangent - 1));
}

/// Value and step x tangent of the curve at step k, k = 0 ... cells. The cubic pieces between them pass every load with
/// its tangent. They result from the smallest change (least squares) of the curve's own values.
Eigen::VectorXd resampled(const std::vector<CurvePoint>& curve, double step, int cells) {
  Eigen::VectorXd nodes(2 * cells + 2);
  for (int k = 0; k <= cells; ++k) {
    const auto value = force_on_curve(curve, k * step);
    nodes.segment<2>(2 * k) << value.force, step * value.tangent;
  }
  const auto loads = static_cast<int>(curve.size()) - 1;
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(2 * loads, nodes.size());
  Eigen::VectorXd missed(2 * loads);
  for (int j = 0; j < loads; ++j) {
    const auto& point = curve[static_cast<std::size_t>(j) + 1];
    const int k = std::min(static_cast<int>(point.g / step), cells - 1);
    const double x = point.g / step - k, y = 1 - x;
    conditions.block<1, 4>(2 * j, 2 * k) << y * y * (1 + 2 * x), x * y * y, x * x * (3 - 2 * x), -x * x * y;
    conditions.block<1, 4>(2 * j + 1, 2 * k) << -6 * x * y, y * (1 - 3 * x), 6 * x * y, x * (3 * x - 2);
    missed.segment<2>(2 * j) << point.force, step * point.tangent;
  }
  missed -= conditions * nodes;
  conditions.col(0).setZero();  // no deflection, no force
  nodes += conditions.completeOrthogonalDecomposition().solve(missed);
  return nodes;
}

}  // namespace

ForceSurface::ForceSurface(const StiffnessTable& table)
    : grid_(table.positions(), table.positions() * table.phases()),
      smallest_load_(table.loads().front()),
      largest_load_(table.loads().back()) {
  double largest = 0;
  const int last = static_cast<int>(table.loads().size()) - 1;
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); ++phase) {
      const auto& e = table.at(position, phase, last);
      largest = std::max(largest, e.lte - e.unloaded_te);
    }
  // The tabulated points are met exactly as long as they do not crowd within a cell; then more cells are needed.
  for (int cells = 32; cells <= 512; cells *= 2) {
    build(table, largest, cells);
    if (resampling_error_ <= 1e-9) break;
  }
  check(table);
}

void ForceSurface::build(const StiffnessTable& table, double largest_deflection, int cells) {
  using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  // From (value, slope) at both ends to powers.
  const Matrix hermite = (Matrix() << 1, 0, 0, 0, 0, 1, 0, 0, -3, -2, 3, -1, 2, 1, -2, 1).finished();
  const int pieces = grid_.pieces();
  step_ = largest_deflection / cells;
  inverse_step_ = 1 / step_;
  cells_ = cells + 1;  // one beyond the largest deflection, in which all curves are straight
  last_cell_ = cells;

  // Force, step x tangent and their slopes along the phase at the lower ends of the cells: [cell][phase].
  struct Row {
    std::vector<double> force, tangent, force_slope, tangent_slope;
  };
  std::vector<Row> rows(static_cast<std::size_t>(cells_));
  for (int i = 0; i < pieces; ++i) {
    const auto nodes = resampled(curve_at(table, i / table.phases(), i % table.phases()), step_, cells);
    for (int k = 0; k < cells_; ++k) {
      rows[k].force.push_back(nodes[2 * k]);
      rows[k].tangent.push_back(nodes[2 * k + 1]);
    }
  }
  for (auto& row : rows) {
    row.force_slope = periodic_slopes(row.force);
    row.tangent_slope = periodic_slopes(row.tangent);
  }

  coefficients_.assign(static_cast<std::size_t>(pieces) * cells_ * 16, 0.0);
  energy_.assign(static_cast<std::size_t>(pieces) * cells_ * 4, 0.0);
  for (int i = 0; i < pieces; ++i) {
    const int next = (i + 1) % pieces;
    Eigen::RowVector4d energy = Eigen::RowVector4d::Zero();
    for (int k = 0; k < cells_; ++k) {
      const auto &low = rows[k], &high = rows[std::min(k + 1, cells_ - 1)];
      Matrix nodes;  // rows: value and slope along the phase at both knots; columns: the same along g
      const auto knot = [&](int row, int phase) {
        nodes.row(row) << low.force[phase], low.tangent[phase], high.force[phase], high.tangent[phase];
        nodes.row(row + 1) << low.force_slope[phase], low.tangent_slope[phase], high.force_slope[phase],
            high.tangent_slope[phase];
      };
      knot(0, i);
      knot(2, next);
      Matrix c = hermite * nodes * hermite.transpose();
      if (k + 1 == cells_) {
        c.col(0) = hermite * nodes.col(0);
        c.col(1) = hermite * nodes.col(1);
        c.rightCols<2>().setZero();
      }
      const std::size_t cell = index_of(i, k);
      std::copy_n(c.data(), 16, coefficients_.data() + 16 * cell);
      std::copy_n(energy.data(), 4, energy_.data() + 4 * cell);
      energy += step_ * (c.col(0) + c.col(1) / 2 + c.col(2) / 3 + c.col(3) / 4).transpose();
    }
  }

  resampling_error_ = 0;
  for (int i = 0; i < pieces; ++i)
    for (const auto& point : curve_at(table, i / table.phases(), i % table.phases()))
      if (point.force > 0) resampling_error_ = std::max(resampling_error_, miss(at({i, 0}, point.g), point));
}

void ForceSurface::check(const StiffnessTable& table) const {
  // Makima slopes pass steep flanks slightly: four phases per piece and two deflections per cell see a fall that
  // matters.
  for (int i = 0; i < 4 * grid_.pieces(); ++i)
    for (int k = 0; k < 2 * cells_; ++k)
      if (!(at({i / 4, 0.25 * (i % 4)}, 0.5 * k * step_).tangent > 0))
        throw InputError(
            fmt::format("stiffness table {}: the force does not rise with the deflection at {:.3g} m "
                        "near phase {:.3g}: the deflections change too much from one phase to the next; use more",
                        table.mesh(), 0.5 * k * step_, i / (4 * grid_.rate())));
}

ForceSurface::PhaseCoefficients ForceSurface::coefficients_at(double mesh_cycles, double g, AlongPhase kind) const {
  const auto location = grid_.locate(mesh_cycles);
  PhaseCoefficients found;
  found.x = std::abs(g) * inverse_step_;
  const int k = cell_of(found.x);
  const std::size_t cell = index_of(location.piece, k);
  found.x -= k;
  const double p = location.local;
  const Eigen::RowVector4d powers = kind == AlongPhase::derivative
                                        ? Eigen::RowVector4d(0, 1, 2 * p, 3 * p * p) * grid_.rate()
                                        : Eigen::RowVector4d(1, p, p * p, p * p * p);
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> c(coefficients_.data() + 16 * cell);
  found.in_g = (powers * c).transpose().array();
  found.energy_below = powers.dot(Eigen::Map<const Eigen::RowVector4d>(energy_.data() + 4 * cell));
  return found;
}

double ForceSurface::energy(double mesh_cycles, double g) const {
  const auto [c, below, x] = coefficients_at(mesh_cycles, g, AlongPhase::value);
  return below + step_ * x * (c[0] + x * (c[1] / 2 + x * (c[2] / 3 + x * c[3] / 4)));
}

double ForceSurface::energy_rate(double mesh_cycles, double g) const {
  const auto [c, below, x] = coefficients_at(mesh_cycles, g, AlongPhase::derivative);
  return below + step_ * x * (c[0] + x * (c[1] / 2 + x * (c[2] / 3 + x * c[3] / 4)));
}

}  // namespace annulus::dynamics
