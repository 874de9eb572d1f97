#pragma once

#include <vector>

#include "core/stiffness_table.h"

namespace annulus::dynamics {

/// A position on periodic equidistant knots: the piece between two knots and the local coordinate in it, in [0, 1).
struct PhaseLocation {
  int piece = 0;
  double local = 0;
};

/// Equidistant knots over a period of whole mesh cycles.
class PhaseGrid {
 public:
  PhaseGrid() = default;
  PhaseGrid(double period, int pieces)
      : period_(period), inverse_period_(1 / period), size_(static_cast<double>(pieces)), pieces_(pieces) {}
  /// `cycles` may have any sign and up to 9e18 periods; NaN gives a NaN local coordinate.
  [[nodiscard]] PhaseLocation locate(double cycles) const {
    // Conversion to integer instead of std::floor, which is a call on processors without SSE4.1.
    const double turns = cycles * inverse_period_;
    long whole = static_cast<long>(turns);
    whole -= turns < static_cast<double>(whole) ? 1 : 0;
    const double x = (turns - static_cast<double>(whole)) * size_;
    const int piece = x < size_ ? static_cast<int>(x) : pieces_ - 1;
    return {piece, x - piece};
  }
  [[nodiscard]] double period() const { return period_; }  ///< mesh cycles
  [[nodiscard]] int pieces() const { return pieces_; }
  /// d local / d cycles.
  [[nodiscard]] double rate() const { return size_ * inverse_period_; }

 private:
  double period_ = 1, inverse_period_ = 1, size_ = 1;
  int pieces_ = 1;
};

/// Periodic curves as polynomials on common knots, for fast joint evaluation. It reproduces its curves exactly: where
/// their knots differ, pieces are divided and not resampled.
class CurveBundle {
 public:
  CurveBundle() = default;
  /// Periods of the curves are whole mesh cycles.
  explicit CurveBundle(const std::vector<const PeriodicCurve*>& curves);
  [[nodiscard]] const PhaseGrid& grid() const { return grid_; }
  [[nodiscard]] int width() const { return width_; }  ///< number of curves
  /// Coefficients of the piece: [power 0 ... 3][curve].
  [[nodiscard]] const double* piece(int index) const {
    return coefficients_.data() + static_cast<std::size_t>(index) * 4 * static_cast<std::size_t>(width_);
  }
  /// Writes `width` values and `width` derivatives (per mesh cycle) at `cycles` mesh cycles.
  void evaluate(double cycles, double* values, double* derivatives) const;
  [[nodiscard]] bool same_as(const CurveBundle& other) const {
    return grid_.period() == other.grid_.period() && width_ == other.width_ && coefficients_ == other.coefficients_;
  }

 private:
  PhaseGrid grid_;
  int width_ = 0;
  std::vector<double> coefficients_;
};

}  // namespace annulus::dynamics
