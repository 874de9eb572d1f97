#include "dynamics/spatial/series_law.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "dynamics/spatial/elastic_laws.h"

namespace annulus::dynamics {

Eigen::MatrixXd free_coordinates(const Eigen::MatrixXd& held) {
  if (held.rows() == 0) return Eigen::MatrixXd::Identity(held.cols(), held.cols());
  const Eigen::FullPivLU<Eigen::MatrixXd> factors(held);
  if (factors.dimensionOfKernel() == 0) return Eigen::MatrixXd(held.cols(), 0);
  return factors.kernel();
}

SeriesLaw::SeriesLaw(Eigen::MatrixXd below, std::vector<Part> parts, const Eigen::MatrixXd& held)
    : below_(std::move(below)), free_(free_coordinates(held)), parts_(std::move(parts)) {
  require(held.cols() == below_.rows() && below_.cols() == below_.rows(),
          fmt::format("{} held coordinates on a stiffness of {} x {}", held.cols(), below_.rows(), below_.cols()));
  Eigen::MatrixXd sum = below_;
  for (const auto& part : parts_) {
    require(part.measures.rows() == part.law->size() && part.measures.cols() == below_.rows(),
            fmt::format("{} x {} measures for a law of {} coordinates on {}", part.measures.rows(),
                        part.measures.cols(), part.law->size(), below_.rows()));
    sum += part.measures.transpose() * part.law->in_contact() * part.measures;
  }
  const Eigen::LDLT<Eigen::MatrixXd> factors(free_.transpose() * sum * free_);
  if (free_.cols() > 0 && !(factors.vectorD().minCoeff() > 0))
    throw InputError(fmt::format("nothing resists some deflection of elastic parts in series: least pivot {:g}",
                                 factors.vectorD().minCoeff()));
  first_guess_ = factors.solve(free_.transpose() * below_);
}

SeriesLaw::Inner SeriesLaw::inner(const Eigen::VectorXd& free_deflection, const Eigen::VectorXd& deflection) const {
  const Eigen::VectorXd s = free_ * free_deflection, force = below_ * (deflection - s);
  Inner result{force.dot(deflection - s) / 2, {}, {}};
  Eigen::VectorXd unbalanced = -force;
  Eigen::MatrixXd tangent = below_;
  for (const auto& part : parts_) {
    const auto state = part.law->at(part.measures * s);
    result.energy += state.energy;
    unbalanced += part.measures.transpose() * state.force;
    tangent += part.measures.transpose() * state.tangent * part.measures;
  }
  result.gradient = free_.transpose() * unbalanced;
  result.tangent = free_.transpose() * tangent * free_;
  return result;
}

ElasticLaw::State SeriesLaw::at(const Eigen::VectorXd& deflection) const {
  Eigen::VectorXd s = first_guess_ * deflection;
  Inner now = inner(s, deflection);
  Eigen::LDLT<Eigen::MatrixXd> factors;
  constexpr int most_steps = 100, most_halvings = 40;
  constexpr double rounding = 1e-14;  // of an energy
  double decrement = 0;
  for (int iteration = 0;; ++iteration) {
    factors.compute(now.tangent);
    const Eigen::VectorXd step = -factors.solve(now.gradient);
    decrement = -step.dot(now.gradient);  // twice the energy that is left, as of a linear system
    if (!(decrement > rounding * rounding * now.energy)) break;
    if (iteration == most_steps)
      throw SolverError(fmt::format("bearings in series with what they stand on: {} steps leave {:g} J of {:g} J",
                                    most_steps, decrement / 2, now.energy));
    double share = 1;
    Inner next = inner(s + step, deflection);
    for (int i = 0; i < most_halvings && !(next.energy <= now.energy * (1 + rounding)); ++i) {
      share /= 2;
      next = inner(s + share * step, deflection);
    }
    const bool at_rounding = decrement <= rounding * now.energy;
    s += share * step;
    now = std::move(next);
    if (at_rounding) {  // one more step squares what is left
      factors.compute(now.tangent);
      break;
    }
  }
  if (!std::isfinite(now.energy))
    throw SolverError(fmt::format("bearings in series with what they stand on have an energy of {:g} J", now.energy));
  State state{now.energy, below_ * (deflection - free_ * s), {}};
  const Eigen::MatrixXd cross = free_.transpose() * below_;
  state.tangent = below_ - cross.transpose() * factors.solve(cross);
  state.tangent = (state.tangent + state.tangent.transpose()).eval() / 2;
  return state;
}

Eigen::MatrixXd SeriesLaw::in_contact() const { return below_ - below_ * free_ * first_guess_; }

std::shared_ptr<const ElasticLaw> series_law(const BearingsInSeries& series) {
  const Eigen::Index size = series.below.rows();
  std::vector<SeriesLaw::Part> parts;
  for (const auto& [bearing, first, place] : series.bearings)
    for (auto& part : parts_of(bearing, series.motions)) {
      Eigen::MatrixXd measures = Eigen::MatrixXd::Zero(std::ssize(part.coordinates), size);
      measures.middleCols<5>(first) = to_place(place)(part.coordinates, Eigen::all);
      parts.push_back({std::move(measures), std::move(part.law)});
    }
  for (const auto& [coordinate, stiffness] : series.springs)
    parts.push_back({Eigen::RowVectorXd::Unit(size, coordinate),
                     std::make_shared<LinearLaw>(Eigen::MatrixXd::Constant(1, 1, stiffness))});
  Eigen::MatrixXd held = series.held;
  if (series.motions == Motions::in_plane)  // what is below does not leave it either
    for (Eigen::Index i = 0; i < size; ++i)
      if (i % 5 >= 2) {
        held.conservativeResize(held.rows() + 1, size);
        held.bottomRows<1>() = Eigen::RowVectorXd::Unit(size, i);
      }
  return std::make_shared<SeriesLaw>(series.below, std::move(parts), held);
}

}  // namespace annulus::dynamics
