#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/systems/planetary/planetary_stage.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::dynamics {

/// The state once per mesh cycle.
struct PoincareSection {
  std::vector<std::string> quantities;  ///< sun_x_m, sun_y_m, then of every mesh deflection_m, force_N
  Eigen::MatrixXd points;               ///< quantities x mesh cycles
  Eigen::VectorXd swing;                ///< per quantity, largest less smallest value over the whole series
};
/// The deflection of a mesh is b^T q - e(t), its dynamic transmission error. Sun coordinates are absent when it is
/// rigid.
[[nodiscard]] PoincareSection poincare_section(const PlanetaryStage& stage, const TimeSeries& series,
                                               int samples_per_cycle);

enum class SectionKind {
  period_1,   ///< repeats as the excitation does, with every error period
  period_n,   ///< repeats with several error periods: subharmonic
  irregular,  ///< does not repeat within half the section: quasi-periodic, chaotic, or still transient
  undecided,  ///< the section holds fewer than two error periods
};
[[nodiscard]] std::string to_string(SectionKind kind);

struct SectionPattern {
  SectionKind kind = SectionKind::undecided;
  std::optional<int> period;  ///< mesh cycles after which the points repeat
  int clusters = 0;           ///< points that differ by more than the tolerance
  /// Largest difference, relative to that swing (or to what `tolerance` of it would be the accuracy), between points
  /// one period apart. Where nothing repeats, the least over the multiples of the error period.
  double spread = 0;
};
/// Accuracy of the points of a section: smaller differences do not tell two points apart.
struct SectionAccuracy {
  double force = 0;   ///< N
  double length = 0;  ///< m
};
/// `error_period` in mesh cycles; `tolerance` relative to the largest swing among the quantities of one unit.
[[nodiscard]] SectionPattern section_pattern(const PoincareSection& section, int error_period,
                                             const SectionAccuracy& accuracy = {}, double tolerance = 0.01);

}  // namespace annulus::dynamics
