#include "dynamics/steady_state/harmonic_balance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "core/errors.h"
#include "dynamics/steady_state/second_angle.h"

namespace annulus::dynamics {

namespace {

using Complex = std::complex<double>;

/// Rates of the lines of the first angle beside line l of the second one, without that at 0.
Eigen::VectorXd rates_beside(const BalanceGrid& grid, int l, Eigen::Index samples) {
  const Eigen::Index first = l == 0 ? 1 : 0, count = samples / 2 - first;
  Eigen::VectorXd rates(count);
  for (Eigen::Index j = 0; j < count; ++j) rates[j] = grid.rate(j + first, l);
  return rates;
}

}  // namespace

double BalanceGrid::spacing() const { return 2 * std::numbers::pi / period; }

double BalanceGrid::rate(Eigen::Index j, int l) const {
  return static_cast<double>(j) * spacing() + (2 * l > rows ? l - rows : l) * second_rate;
}

std::optional<Eigen::Index> load_line(const HarmonicLoad& load, double spacing, Eigen::Index samples) {
  const double line = std::abs(load.rate) / spacing;
  constexpr double whole = 1e-6;
  const auto number = static_cast<Eigen::Index>(std::lround(line));
  if (std::abs(line - static_cast<double>(number)) > whole || number < 1 || number >= samples / 2) return std::nullopt;
  return number;
}

BalanceProblem balance_problem(const LumpedSystem& system, const FrequencyResponse& response,
                               const Eigen::VectorXd& stiffness, BalanceGrid grid, Eigen::Index samples) {
  require(grid.rows % 2 == 1, fmt::format("the second angle has {} values, which must be odd", grid.rows));
  BalanceProblem problem{system, response, stiffness, std::move(grid), {}, {}, {}};
  resolve(problem, samples);
  problem.static_transfer.resize(stiffness.size(), stiffness.size());
  const auto& b = response.mesh_vectors();
  for (Eigen::Index m = 0; m < stiffness.size(); ++m)
    problem.static_transfer.col(m) = b.transpose() * response.static_displacement(b.col(m));
  problem.static_approach = b.transpose() * response.static_displacement(system.load());
  for (const auto& load : system.harmonic_loads()) {
    const double rate = std::abs(load.rate), spacing = problem.grid.spacing();
    const auto line = load_line(load, spacing, samples);
    require(line.has_value(), fmt::format("a load of {:g} rad/s does not fit lines {:g} rad/s apart", rate, spacing));
    const Complex sine(0, std::copysign(1.0, load.rate));
    problem.load_lines.push_back(
        {*line, response.displacement(rate, (load.cosine.cast<Complex>() - sine * load.sine.cast<Complex>()) / 2)});
  }
  return problem;
}

void resolve(BalanceProblem& problem, Eigen::Index samples) {
  const Eigen::Index meshes = problem.mean_stiffness.size();
  problem.transfer.resize(static_cast<std::size_t>(problem.grid.rows));
  for (int l = 0; l < problem.grid.rows; ++l) {
    auto& transfer = problem.transfer[static_cast<std::size_t>(l)];
    const auto rates = rates_beside(problem.grid, l, samples);
    if (transfer.cols() < 2 * meshes * rates.size()) transfer = problem.response.mesh_transfer(rates);
  }
}

HarmonicBalance::HarmonicBalance(const BalanceProblem& problem, Eigen::Index samples)
    : problem_(problem), transform_(static_cast<int>(samples)) {
  const auto& grid = problem.grid;
  const Eigen::Index meshes = problem.mean_stiffness.size(), last = samples / 2;
  require(samples % 4 == 0 && last - 1 <= problem.transfer.front().cols() / (2 * meshes),
          fmt::format("{} samples of the harmonic balance do not fit {} lines of its transfer functions", samples,
                      problem.transfer.front().cols() / (2 * meshes)));
  for (int row = 0; row < grid.rows; ++row) meshes_.emplace_back(problem.system, grid.period, samples);
  scale_ = 1.0 / static_cast<double>(samples * grid.rows);
  lines_.resize(grid.rows * (last + 1), meshes);
  approach_lines_ = lines_;
  line_.resize(lines_.rows());
  across_.resize(last + 1, grid.rows);
  turn_.resize(grid.rows, grid.rows);
  for (int i = 0; i < grid.rows; ++i)
    for (int k = 0; k < grid.rows; ++k)
      turn_(i, k) = std::polar(1.0, 2 * std::numbers::pi * ((i * k) % grid.rows) / grid.rows);
  rate_of_.setZero(lines_.rows());
  for (int l = 0; l < grid.rows; ++l)
    for (Eigen::Index j = 0; j < last; ++j) rate_of_[l * (last + 1) + j] = grid.rate(j, l);
  shift_.setZero(grid.rows, meshes);
  shift_rate_ = shift_;
  for (const auto& [mesh, error] : grid.waves)
    for (int row = 0; row < grid.rows; ++row) {
      const double angle = error.rate / grid.second_rate * 2 * std::numbers::pi * row / grid.rows + error.phase;
      shift_(row, mesh) += error.amount * std::sin(angle);
      shift_rate_(row, mesh) += error.amount * error.rate * std::cos(angle);
    }
  loaded_ = problem.static_approach.transpose().replicate(samples * grid.rows, 1);
  Eigen::VectorXd change(loaded_.rows());
  for (const auto& load : problem.load_lines) {
    const Eigen::VectorXcd amplitude = problem.response.mesh_vectors().transpose() * load.displacement;
    for (Eigen::Index m = 0; m < loaded_.cols(); ++m) {
      line_.setZero();
      line_[load.line] = amplitude[m];
      to_values(line_.data(), change.data());
      loaded_.col(m) += change;
    }
  }
}

/// Fourier transform of each line of the first angle over the rows, of which there are few.
void HarmonicBalance::across_rows(Complex* lines, Sense sense) {
  if (rows() == 1) return;
  Eigen::Map<Eigen::MatrixXcd> of_rows(lines, lines_of_row(), rows());
  if (sense == Sense::forward)
    across_.noalias() = of_rows * turn_.conjugate();
  else
    across_.noalias() = of_rows * turn_;
  of_rows = across_;
}

void HarmonicBalance::to_lines(const double* values, Complex* lines) {
  for (int row = 0; row < rows(); ++row) transform_.forward(values + row * samples(), lines + row * lines_of_row());
  across_rows(lines, Sense::forward);
}

void HarmonicBalance::to_values(Complex* lines, double* values) {
  across_rows(lines, Sense::back);
  for (int row = 0; row < rows(); ++row) transform_.inverse(lines + row * lines_of_row(), values + row * samples());
}

void HarmonicBalance::forward(const Eigen::Ref<const Eigen::MatrixXd>& values, Eigen::MatrixXcd& lines) {
  for (Eigen::Index m = 0; m < values.cols(); ++m) to_lines(values.col(m).data(), lines.col(m).data());
}

void HarmonicBalance::respond(Eigen::Ref<Eigen::MatrixXd> approach) {
  const Eigen::Index meshes = lines_.cols(), last = samples() / 2;
  Eigen::VectorXd real(meshes), imaginary(meshes), sum(meshes), imaginary_sum(meshes);
  real = scale_ * lines_.row(0).real();
  lines_.row(0) = (problem_.static_transfer * real).cast<Complex>();
  for (int l = 0; l < rows(); ++l) {
    const auto& transfer = problem_.transfer[static_cast<std::size_t>(l)];
    const Eigen::Index first = l == 0 ? 1 : 0, begin = l * lines_of_row();
    for (Eigen::Index j = first; j < last; ++j) {
      for (Eigen::Index m = 0; m < meshes; ++m) {
        real[m] = scale_ * lines_(begin + j, m).real();
        imaginary[m] = scale_ * lines_(begin + j, m).imag();
      }
      const auto re = transfer.middleCols(2 * meshes * (j - first), meshes);
      const auto im = transfer.middleCols(2 * meshes * (j - first) + meshes, meshes);
      sum.noalias() = re.lazyProduct(real) - im.lazyProduct(imaginary);
      imaginary_sum.noalias() = re.lazyProduct(imaginary) + im.lazyProduct(real);
      for (Eigen::Index m = 0; m < meshes; ++m) lines_(begin + j, m) = Complex(sum[m], imaginary_sum[m]);
    }
    lines_.row(begin + last).setZero();  // the sign of this line's rate is unknown: it is left out
  }
  for (Eigen::Index m = 0; m < meshes; ++m) to_values(lines_.col(m).data(), approach.col(m).data());
}

Eigen::MatrixXd HarmonicBalance::rate_of(const Eigen::Ref<const Eigen::MatrixXd>& values) {
  Eigen::MatrixXd rate(values.rows(), values.cols());
  for (Eigen::Index m = 0; m < values.cols(); ++m) {
    to_lines(values.col(m).data(), line_.data());
    line_.array() *= Complex(0, scale_) * rate_of_.array();
    to_values(line_.data(), rate.col(m).data());
  }
  return rate;
}

Eigen::MatrixXd HarmonicBalance::linear_solution(const Eigen::MatrixXd& start, const Eigen::MatrixXd& start_rate,
                                                 const Eigen::MatrixXd& force) {
  Eigen::MatrixXd rest = force;
  for (Eigen::Index m = 0; m < rest.cols(); ++m)
    rest.col(m) -= problem_.mean_stiffness[m] * start.col(m) + problem_.system.meshes()[m].damping * start_rate.col(m);
  forward(rest, lines_);
  Eigen::MatrixXd approach(rest.rows(), rest.cols());
  respond(approach);
  return loaded_ - approach;
}

void HarmonicBalance::at_deflection(const Eigen::VectorXd& deflection, Eigen::MatrixXd& approach,
                                    Eigen::MatrixXd& rate) {
  Eigen::MatrixXd of_row, rate_of_row;
  meshes().at_deflection(deflection, of_row, rate_of_row);
  approach = of_row.replicate(rows(), 1);
  rate = rate_of_row.replicate(rows(), 1);
  for (int row = 0; row < rows(); ++row) {
    approach.middleRows(row * samples(), samples()).rowwise() += shift_.row(row);
    rate.middleRows(row * samples(), samples()).rowwise() += shift_rate_.row(row);
  }
}

void HarmonicBalance::forces(const Eigen::MatrixXd& approach, const Eigen::MatrixXd& rate, Eigen::MatrixXd& force) {
  if (rows() == 1) return meshes().evaluate(approach, rate, force);
  force.resize(approach.rows(), approach.cols());
  Eigen::MatrixXd of_row;
  for (int row = 0; row < rows(); ++row) {
    const Eigen::Index begin = row * samples();
    meshes_[static_cast<std::size_t>(row)].evaluate(approach.middleRows(begin, samples()).rowwise() - shift_.row(row),
                                                    rate.middleRows(begin, samples()).rowwise() - shift_rate_.row(row),
                                                    of_row);
    force.middleRows(begin, samples()) = of_row;
  }
}

void HarmonicBalance::at_instants(const Eigen::MatrixXd& approach, const Eigen::MatrixXd& rate, Eigen::MatrixXd& force,
                                  std::vector<LumpedSystem::Contact>& contact) {
  const Eigen::Index total = approach.rows();
  force.resize(total, approach.cols());
  contact.resize(static_cast<std::size_t>(force.size()));
  Eigen::MatrixXd of_row;
  std::vector<LumpedSystem::Contact> contact_of_row;
  for (int row = 0; row < rows(); ++row) {
    const Eigen::Index begin = row * samples();
    meshes().evaluate_at_instants(approach.middleRows(begin, samples()).rowwise() - shift_.row(row),
                                  rate.middleRows(begin, samples()).rowwise() - shift_rate_.row(row), of_row,
                                  contact_of_row);
    force.middleRows(begin, samples()) = of_row;
    for (Eigen::Index m = 0; m < approach.cols(); ++m)
      std::copy_n(contact_of_row.begin() + m * samples(), samples(), contact.begin() + m * total + begin);
  }
}

Eigen::MatrixXd HarmonicBalance::force_change(const Eigen::MatrixXd& change) const {
  Eigen::MatrixXd force(change.rows(), change.cols());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(change.cols());
  for (int row = 0; row < rows(); ++row) {
    const Eigen::Index begin = row * samples();
    meshes_[static_cast<std::size_t>(row)].apply_tangent(change.middleRows(begin, samples()), none,
                                                         force.middleRows(begin, samples()));
  }
  return force;
}

void HarmonicBalance::residual(const Eigen::Ref<const Eigen::MatrixXd>& approach, Eigen::Ref<Eigen::MatrixXd> result) {
  forward(approach, approach_lines_);
  rate_.resize(approach.rows(), approach.cols());
  for (Eigen::Index m = 0; m < approach.cols(); ++m) {
    line_ = approach_lines_.col(m).array() * Complex(0, scale_) * rate_of_.array();
    to_values(line_.data(), rate_.col(m).data());
  }
  forces(approach, rate_, force_);
  forward(force_, lines_);
  for (Eigen::Index m = 0; m < approach.cols(); ++m) {
    const double k = problem_.mean_stiffness[m], c = problem_.system.meshes()[m].damping;
    for (Eigen::Index i = 0; i < lines_.rows(); ++i)
      lines_(i, m) -= Complex(k, c * rate_of_[i]) * approach_lines_(i, m);
  }
  approach_lines_ = scale_ * lines_;  // for the motion
  respond(result);
  for (Eigen::Index m = 0; m < approach.cols(); ++m) result.col(m) += approach.col(m) - loaded_.col(m);
}

void HarmonicBalance::apply_derivative(const Eigen::Ref<const Eigen::MatrixXd>& change,
                                       Eigen::Ref<Eigen::MatrixXd> result) {
  // `result` holds the change of the forces first.
  for (int row = 0; row < rows(); ++row) {
    const Eigen::Index begin = row * samples();
    meshes_[static_cast<std::size_t>(row)].apply_tangent(change.middleRows(begin, samples()), problem_.mean_stiffness,
                                                         result.middleRows(begin, samples()));
  }
  Eigen::VectorXd beyond(change.rows());
  for (Eigen::Index m = 0; m < change.cols(); ++m) {
    const double c = problem_.system.meshes()[m].damping;
    for (int row = 0; row < rows(); ++row)
      beyond.segment(row * samples(), samples()) = meshes_[static_cast<std::size_t>(row)].damping().col(m).array() - c;
    if (beyond.any()) result.col(m).array() += beyond.array() * rate_of(change.col(m)).array();
  }
  forward(result, lines_);
  respond(result);
  result += change;
}

Eigen::MatrixXd HarmonicBalance::refined(const Eigen::MatrixXd& values, Eigen::Index factor, int rows) {
  const Eigen::Index coarse = values.rows() / rows, fine = factor * coarse;
  const RealTransform from(static_cast<int>(coarse)), to(static_cast<int>(fine));
  Eigen::VectorXcd line(fine / 2 + 1);
  Eigen::MatrixXd result(fine * rows, values.cols());
  for (Eigen::Index m = 0; m < values.cols(); ++m)
    for (int row = 0; row < rows; ++row) {
      from.forward(values.col(m).data() + row * coarse, line.data());
      line.tail(line.size() - coarse / 2).setZero();
      line.head(coarse / 2) /= static_cast<double>(coarse);
      to.inverse(line.data(), result.col(m).data() + row * fine);
    }
  return result;
}

Eigen::MatrixXd HarmonicBalance::along(const Eigen::MatrixXd& values, Eigen::Index count) const {
  const double advance = problem_.grid.second_rate * problem_.grid.period / static_cast<double>(samples());
  return along_both_angles(values, rows(), advance, count);
}

void HarmonicBalance::motion(Eigen::MatrixXd& displacement, Eigen::MatrixXd& velocity) {
  const Eigen::Index last = samples() / 2, total = samples() * rows();
  const auto& response = problem_.response;
  Eigen::MatrixXcd amplitudes(problem_.system.dofs(), lines_.rows());
  amplitudes.setZero();
  for (int l = 0; l < rows(); ++l) {
    const Eigen::Index first = l == 0 ? 1 : 0, begin = l * lines_of_row() + first;
    amplitudes.middleCols(begin, last - first) = response.displacements(
        rate_of_.segment(begin, last - first), -approach_lines_.middleRows(begin, last - first).transpose());
  }
  for (const auto& load : problem_.load_lines) amplitudes.col(load.line) += load.displacement;
  const Eigen::VectorXd mean = response.static_displacement(
      problem_.system.load() - response.mesh_vectors() * approach_lines_.row(0).real().transpose());
  amplitudes.col(0) = mean.cast<Complex>();
  displacement.resize(amplitudes.rows(), total);
  velocity.resize(amplitudes.rows(), total);
  Eigen::VectorXd values(total);
  for (Eigen::Index i = 0; i < amplitudes.rows(); ++i) {
    line_ = amplitudes.row(i).transpose();
    to_values(line_.data(), values.data());
    displacement.row(i) = values;
    line_ = amplitudes.row(i).transpose().array() * Complex(0, 1) * rate_of_.array();
    to_values(line_.data(), values.data());
    velocity.row(i) = values;
  }
}

}  // namespace annulus::dynamics
