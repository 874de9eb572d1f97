#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace annulus::geometry {

/// Fractions 0 ... 1 of the ends of `cells` equal cells on a curve.
[[nodiscard]] std::vector<double> uniform_fractions(int cells);

/// The same for a geometric row whose every cell is `ratio` times the one before.
[[nodiscard]] std::vector<double> growing_fractions(int cells, double ratio);

/// The same for a symmetric row with thin cells at both ends: the end cells are `end_cell` (in (0, 1]) times a uniform
/// one and grow geometrically to the middle, with the ratio that fills the row. Two cells are equal.
[[nodiscard]] std::vector<double> both_ends_fractions(int cells, double end_cell);

/// Ratio of neighbouring cells of a geometric row of given total length that starts with a cell of size `first`: 1 when
/// that is no refinement, at most `largest`.
[[nodiscard]] double growth_ratio(double length, double first, int cells, double largest);

/// Points of a smooth curve over t in [0, 1] at fractions of its arc length, both ends included. Arc lengths come from
/// 512 chords; the points lie on the curve exactly.
[[nodiscard]] std::vector<Eigen::Vector2d> points_at(const std::function<Eigen::Vector2d(double)>& curve,
                                                     const std::vector<double>& fractions);

}  // namespace annulus::geometry
