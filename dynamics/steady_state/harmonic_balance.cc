#include "dynamics/steady_state/harmonic_balance.h"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

using Complex = std::complex<double>;

}  // namespace

std::optional<Eigen::Index> load_line(const HarmonicLoad& load, double spacing, Eigen::Index samples) {
  const double line = std::abs(load.rate) / spacing;
  constexpr double whole = 1e-6;
  const auto number = static_cast<Eigen::Index>(std::lround(line));
  if (std::abs(line - static_cast<double>(number)) > whole || number < 1 || number >= samples / 2) return std::nullopt;
  return number;
}

BalanceProblem balance_problem(const LumpedSystem& system, const FrequencyResponse& response,
                               const Eigen::VectorXd& stiffness, double period, Eigen::Index samples) {
  const double spacing = 2 * std::numbers::pi / period;
  BalanceProblem problem{system, response, stiffness, spacing, response.mesh_transfer(spacing, samples / 2 - 1),
                         {},     {}};
  problem.static_transfer.resize(stiffness.size(), stiffness.size());
  const auto& b = response.mesh_vectors();
  for (Eigen::Index m = 0; m < stiffness.size(); ++m)
    problem.static_transfer.col(m) = b.transpose() * response.static_displacement(b.col(m));
  problem.static_approach = b.transpose() * response.static_displacement(system.load());
  for (const auto& load : system.harmonic_loads()) {
    const double rate = std::abs(load.rate);
    const auto line = load_line(load, spacing, samples);
    require(line.has_value(), fmt::format("a load of {:g} rad/s does not fit lines {:g} rad/s apart", rate, spacing));
    const Complex sine(0, std::copysign(1.0, load.rate));
    problem.load_lines.push_back(
        {*line, response.displacement(rate, (load.cosine.cast<Complex>() - sine * load.sine.cast<Complex>()) / 2)});
  }
  return problem;
}

HarmonicBalance::HarmonicBalance(const BalanceProblem& problem, double period, Eigen::Index samples)
    : problem_(problem), meshes_(problem.system, period, samples), transform_(static_cast<int>(samples)) {
  require(samples % 4 == 0 && samples / 2 - 1 <= problem.transfer.cols() / (2 * problem.transfer.rows()),
          fmt::format("{} samples of the harmonic balance do not fit {} lines of its transfer functions", samples,
                      problem.transfer.cols() / (2 * problem.transfer.rows())));
  lines_.resize(samples / 2 + 1, problem.mean_stiffness.size());
  approach_lines_ = lines_;
  line_.resize(lines_.rows());
  loaded_ = problem.static_approach.transpose().replicate(samples, 1);
  Eigen::VectorXd change(samples);
  for (const auto& load : problem.load_lines) {
    const Eigen::VectorXcd amplitude = problem.response.mesh_vectors().transpose() * load.displacement;
    for (Eigen::Index m = 0; m < loaded_.cols(); ++m) {
      line_.setZero();
      line_[load.line] = amplitude[m];
      transform_.inverse(line_.data(), change.data());
      loaded_.col(m) += change;
    }
  }
}

void HarmonicBalance::forward(const Eigen::Ref<const Eigen::MatrixXd>& values, Eigen::MatrixXcd& lines) {
  for (Eigen::Index m = 0; m < values.cols(); ++m) transform_.forward(values.col(m).data(), lines.col(m).data());
}

void HarmonicBalance::respond(Eigen::Ref<Eigen::MatrixXd> approach) {
  const Eigen::Index meshes = lines_.cols(), last = samples() / 2;
  const double scale = 1.0 / static_cast<double>(samples());
  Eigen::VectorXd real(meshes), imaginary(meshes), sum(meshes), imaginary_sum(meshes);
  real = scale * lines_.row(0).real();
  lines_.row(0) = (problem_.static_transfer * real).cast<Complex>();
  for (Eigen::Index j = 1; j < last; ++j) {
    for (Eigen::Index m = 0; m < meshes; ++m) {
      real[m] = scale * lines_(j, m).real();
      imaginary[m] = scale * lines_(j, m).imag();
    }
    const auto re = problem_.transfer.middleCols(2 * meshes * (j - 1), meshes);
    const auto im = problem_.transfer.middleCols(2 * meshes * (j - 1) + meshes, meshes);
    sum.noalias() = re.lazyProduct(real) - im.lazyProduct(imaginary);
    imaginary_sum.noalias() = re.lazyProduct(imaginary) + im.lazyProduct(real);
    for (Eigen::Index m = 0; m < meshes; ++m) lines_(j, m) = Complex(sum[m], imaginary_sum[m]);
  }
  lines_.row(last).setZero();  // the sign of this line's rate is unknown: it is left out
  for (Eigen::Index m = 0; m < meshes; ++m) transform_.inverse(lines_.col(m).data(), approach.col(m).data());
}

Eigen::MatrixXd HarmonicBalance::rate_of(const Eigen::Ref<const Eigen::MatrixXd>& values) {
  Eigen::MatrixXd rate(values.rows(), values.cols());
  const Eigen::Index last = samples() / 2;
  const double scale = problem_.spacing / static_cast<double>(samples());
  for (Eigen::Index m = 0; m < values.cols(); ++m) {
    transform_.forward(values.col(m).data(), line_.data());
    for (Eigen::Index j = 0; j < last; ++j) line_[j] *= Complex(0, static_cast<double>(j) * scale);
    line_[last] = 0;
    transform_.inverse(line_.data(), rate.col(m).data());
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

void HarmonicBalance::residual(const Eigen::Ref<const Eigen::MatrixXd>& approach, Eigen::Ref<Eigen::MatrixXd> result) {
  const Eigen::Index last = samples() / 2;
  const double scale = problem_.spacing / static_cast<double>(samples());
  forward(approach, approach_lines_);
  rate_.resize(approach.rows(), approach.cols());
  for (Eigen::Index m = 0; m < approach.cols(); ++m) {
    for (Eigen::Index j = 0; j < last; ++j)
      line_[j] = approach_lines_(j, m) * Complex(0, static_cast<double>(j) * scale);
    line_[last] = 0;
    transform_.inverse(line_.data(), rate_.col(m).data());
  }
  meshes_.evaluate(approach, rate_, force_);
  forward(force_, lines_);
  for (Eigen::Index m = 0; m < approach.cols(); ++m) {
    const double k = problem_.mean_stiffness[m], c = problem_.system.meshes()[m].damping * problem_.spacing;
    for (Eigen::Index j = 0; j < last; ++j)
      lines_(j, m) -= Complex(k, c * static_cast<double>(j)) * approach_lines_(j, m);
  }
  approach_lines_.topRows(last) = lines_.topRows(last) / static_cast<double>(samples());  // for the motion
  respond(result);
  for (Eigen::Index m = 0; m < approach.cols(); ++m) result.col(m) += approach.col(m) - loaded_.col(m);
}

void HarmonicBalance::apply_derivative(const Eigen::Ref<const Eigen::MatrixXd>& change,
                                       Eigen::Ref<Eigen::MatrixXd> result) {
  // `result` holds the change of the forces first.
  meshes_.apply_tangent(change, problem_.mean_stiffness, result);
  for (Eigen::Index m = 0; m < change.cols(); ++m) {
    const double c = problem_.system.meshes()[m].damping;
    if ((meshes_.damping().col(m).array() != c).any())
      result.col(m).array() += (meshes_.damping().col(m).array() - c) * rate_of(change.col(m)).array();
  }
  forward(result, lines_);
  respond(result);
  result += change;
}

Eigen::MatrixXd HarmonicBalance::refined(const Eigen::MatrixXd& values, Eigen::Index factor) {
  const Eigen::Index coarse = values.rows(), fine = factor * coarse;
  const RealTransform from(static_cast<int>(coarse)), to(static_cast<int>(fine));
  Eigen::VectorXcd line(fine / 2 + 1);
  Eigen::MatrixXd result(fine, values.cols());
  for (Eigen::Index m = 0; m < values.cols(); ++m) {
    from.forward(values.col(m).data(), line.data());
    line.tail(line.size() - coarse / 2).setZero();
    line.head(coarse / 2) /= static_cast<double>(coarse);
    to.inverse(line.data(), result.col(m).data());
  }
  return result;
}

void HarmonicBalance::motion(Eigen::MatrixXd& displacement, Eigen::MatrixXd& velocity) {
  const Eigen::Index last = samples() / 2;
  const auto& response = problem_.response;
  Eigen::MatrixXcd amplitudes =
      response.displacements(problem_.spacing, -approach_lines_.middleRows(1, last - 1).transpose());
  for (const auto& load : problem_.load_lines) amplitudes.col(load.line - 1) += load.displacement;
  const Eigen::VectorXd mean = response.static_displacement(
      problem_.system.load() - response.mesh_vectors() * approach_lines_.row(0).real().transpose());
  displacement.resize(amplitudes.rows(), samples());
  velocity.resize(amplitudes.rows(), samples());
  Eigen::VectorXd values(samples());
  for (Eigen::Index i = 0; i < amplitudes.rows(); ++i) {
    line_[0] = mean[i];
    line_[last] = 0;
    line_.segment(1, last - 1) = amplitudes.row(i);
    transform_.inverse(line_.data(), values.data());
    displacement.row(i) = values;
    line_[0] = line_[last] = 0;
    for (Eigen::Index j = 1; j < last; ++j)
      line_[j] = amplitudes(i, j - 1) * Complex(0, static_cast<double>(j) * problem_.spacing);
    transform_.inverse(line_.data(), values.data());
    velocity.row(i) = values;
  }
}

}  // namespace annulus::dynamics
