#include "dynamics/systems/planetary/poincare.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/errors.h"
#include "dynamics/figures/motion.h"

namespace annulus::dynamics {

PoincareSection poincare_section(const PlanetaryStage& stage, const TimeSeries& series, int samples_per_cycle) {
  require(samples_per_cycle > 0 && series.time.size() >= samples_per_cycle,
          fmt::format("a section needs a mesh cycle of {} samples; the series has {}", samples_per_cycle,
                      series.time.size()));
  const LumpedSystem system = assemble(stage);
  require(series.dofs == system.names(),
          fmt::format("a time series of {} degrees of freedom belongs to another stage than this one of {}",
                      series.dofs.size(), system.dofs()));
  PoincareSection result;
  Eigen::MatrixXd sun(2, series.time.size());
  Eigen::Index first = 0;
  for (const std::string dof : {"sun_x", "sun_y"})
    if (const int i = system.find(dof); i >= 0) {
      sun.row(first++) = series.displacement.row(i);
      result.quantities.push_back(dof + "_m");
    }
  const Eigen::Index toothed = 2 * static_cast<Eigen::Index>(stage.planets());  // bearings with play follow
  for (const char* quantity : {"_deflection_m", "_force_N"})
    for (Eigen::Index m = 0; m < toothed; ++m)
      result.quantities.push_back(system.meshes()[static_cast<std::size_t>(m)].name + quantity);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(result.quantities.size()), series.time.size());
  values << sun.topRows(first), deflections(system, series.time, series.displacement).topRows(toothed),
      series.force.topRows(toothed);
  result.swing = values.rowwise().maxCoeff() - values.rowwise().minCoeff();
  const Eigen::Index cycles = values.cols() / samples_per_cycle;
  result.points.resize(values.rows(), cycles);
  for (Eigen::Index c = 0; c < cycles; ++c) result.points.col(c) = values.col(c * samples_per_cycle);
  return result;
}

std::string to_string(SectionKind kind) {
  switch (kind) {
    case SectionKind::period_1:
      return "period_1";
    case SectionKind::period_n:
      return "period_n";
    case SectionKind::irregular:
      return "irregular";
    case SectionKind::undecided:
      break;
  }
  return "undecided";
}

SectionPattern section_pattern(const PoincareSection& section, int error_period, const SectionAccuracy& accuracy,
                               double tolerance) {
  require(error_period > 0 && tolerance > 0,
          fmt::format("a section needs a positive error period and tolerance, not {} and {}", error_period, tolerance));
  // Relative to the largest swing of its unit: a quantity that hardly moves in comparison is not significant.
  const auto unit_of = [&](Eigen::Index r) {
    const auto& name = section.quantities[static_cast<std::size_t>(r)];
    return name.substr(name.rfind('_') + 1);
  };
  Eigen::VectorXd scale(section.swing.size());
  for (Eigen::Index r = 0; r < scale.size(); ++r) {
    double largest = 0, size = 0;
    for (Eigen::Index other = 0; other < scale.size(); ++other)
      if (unit_of(other) == unit_of(r)) {
        largest = std::max(largest, section.swing[other]);
        size = std::max(size, section.points.row(other).cwiseAbs().maxCoeff());
      }
    const double known = (unit_of(r) == "N" ? accuracy.force : accuracy.length) / tolerance;
    scale[r] = largest > 1e-9 * size ? 1 / std::max(largest, known) : 0.0;  // nothing moves but for rounding
  }
  const Eigen::MatrixXd points = scale.asDiagonal() * section.points;
  const Eigen::Index cycles = points.cols();

  SectionPattern pattern;
  std::vector<Eigen::Index> leaders;
  for (Eigen::Index c = 0; c < cycles; ++c) {
    const auto near = [&](Eigen::Index leader) {
      return (points.col(c) - points.col(leader)).cwiseAbs().maxCoeff() <= tolerance;
    };
    if (std::none_of(leaders.begin(), leaders.end(), near)) leaders.push_back(c);
  }
  pattern.clusters = static_cast<int>(leaders.size());

  if (cycles < 2 * error_period) return pattern;
  pattern.kind = SectionKind::irregular;
  pattern.spread = std::numeric_limits<double>::infinity();
  for (Eigen::Index shift = error_period; shift <= cycles / 2; shift += error_period) {
    const double distance = (points.rightCols(cycles - shift) - points.leftCols(cycles - shift)).cwiseAbs().maxCoeff();
    pattern.spread = std::min(pattern.spread, distance);
    if (distance > tolerance) continue;
    pattern.spread = distance;
    pattern.period = static_cast<int>(shift);
    pattern.kind = shift == error_period ? SectionKind::period_1 : SectionKind::period_n;
    break;
  }
  return pattern;
}

}  // namespace annulus::dynamics
