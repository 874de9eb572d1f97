#pragma once

#include <vector>

#include "core/stiffness_table.h"

namespace annulus::dynamics {

/// A place on equidistant knots that repeat: the piece between two knots and how far along it, in [0, 1).
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
  /// `cycles` of any sign and size below 9e18 periods; not a number gives a local coordinate that is none.
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

/// Periodic curves on common knots as polynomials, for fast joint evaluation. Exactly the curves it is made of: where
/// their knots differ the pieces are divided, not resampled.
class CurveBundle {
 public:
  CurveBundle() = default;
  explicit CurveBundle(const std::vector<const PeriodicCurve*>& curves);
  [[nodiscard]] const PhaseGrid& grid() const { return grid_; }
  [[nodiscard]] int width() const { return width_; }
  /// Coefficients of the piece: [power 0 ... 3][curve].
  [[nodiscard]] const double* piece(int index) const {
    return coefficients_.data() + static_cast<std::size_t>(index) * 4 * static_cast<std::size_t>(width_);
  }
  /// One value and one derivative (per mesh cycle) per curve.
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
