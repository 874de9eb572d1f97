#include "dynamics/steady_state/reach_of_backlash.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>

#include "core/errors.h"
#include "core/floating_point.h"
#include "dynamics/modes/modes.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/steady_state/frequency_response.h"
#include "dynamics/steady_state/real_transform.h"
#include "dynamics/steady_state/sampled_meshes.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::dynamics {

namespace {

/// Half the backlash of a mesh, of its face where it is spread over one; absent: flanks pull as well.
std::optional<double> half_backlash(const LumpedSystem& system, int mesh) {
  for (const auto& face : system.faces())
    if (face.approach == mesh) return face.half_backlash;
  return system.meshes()[static_cast<std::size_t>(mesh)].half_backlash;
}

}  // namespace

std::vector<int> meshes_with_backlash(const LumpedSystem& system) {
  std::vector<int> list;
  for (int m = 0; m < static_cast<int>(system.meshes().size()); ++m)
    if (system.is_whole_mesh(m) && half_backlash(system, m).value_or(0) > 0) list.push_back(m);
  return list;
}

namespace {

double bound_over_deflection(const LumpedSystem& system, const SteadyProblem& problem, const std::vector<int>& meshes) {
  const auto count = static_cast<Eigen::Index>(system.meshes().size());
  const int cycles = std::min(problem.period_in_cycles, longest_searched_period);
  const double period = cycles / problem.mesh_frequency;
  constexpr int most_positions = 400, per_cycle = 16, samples_of_cycle = 64;
  const int positions = std::min(per_cycle * cycles, most_positions);
  const auto path = static_path(system, Eigen::VectorXd::LinSpaced(positions, 0, period * (positions - 1) / positions));
  StaticSolver solver(system);
  auto workspace = system.workspace();
  (void)solver.solve(0, workspace);
  const Eigen::VectorXd deflection = Eigen::Map<const Eigen::VectorXd>(workspace.delta.data(), count);
  SampledMeshes sampled(system, period, static_cast<Eigen::Index>(cycles) * samples_of_cycle);
  Eigen::MatrixXd approach, rate, forces;
  sampled.at_deflection(deflection, approach, rate);
  approach = approach.colwise().mean().replicate(approach.rows(), 1).eval();
  sampled.evaluate(approach, Eigen::MatrixXd::Zero(rate.rows(), rate.cols()), forces);
  Eigen::VectorXd tangent = sampled.tangent().colwise().mean();
  for (Eigen::Index m = 0; m < count; ++m)
    if (!(tangent[m] > 0)) tangent[m] = mean_stiffness(system.meshes()[static_cast<std::size_t>(m)].excitation);
  const FrequencyResponse linear(system, tangent);
  // Harmonics of the forces, each at the natural frequencies that it reaches while the speed changes by a factor of 3.
  const Eigen::Index samples = forces.rows();
  const RealTransform transform(static_cast<int>(samples));
  Eigen::MatrixXcd lines(samples / 2 + 1, count);
  for (Eigen::Index m = 0; m < count; ++m) transform.forward(forces.col(m).data(), lines.col(m).data());
  lines *= 2.0 / static_cast<double>(samples);
  constexpr double lowest = 0.3, highest = 3;
  Eigen::VectorXd bound = Eigen::VectorXd::Zero(count);
  for (const auto& mode : modes(system, tangent).modes) {
    if (mode.frequency == 0) continue;
    const double own_rate = 2 * std::numbers::pi * mode.frequency;
    const Eigen::MatrixXd at = linear.mesh_transfer(Eigen::VectorXd::Constant(1, own_rate));
    const Eigen::MatrixXcd transfer = at.leftCols(count) + std::complex<double>(0, 1) * at.rightCols(count);
    const double line = mode.frequency * period;
    const auto first = static_cast<Eigen::Index>(std::max(1.0, std::ceil(lowest * line)));
    const auto last = static_cast<Eigen::Index>(std::min(static_cast<double>(samples / 2 - 1), highest * line));
    for (Eigen::Index h = first; h <= last; ++h)
      bound = bound.cwiseMax((transfer * lines.row(h).transpose()).cwiseAbs());
    for (const auto& load : system.harmonic_loads()) {
      const double own = std::abs(load.rate);
      if (own < lowest * own_rate || own > highest * own_rate) continue;
      const Eigen::VectorXcd force = load.cosine - std::complex<double>(0, 1) * load.sine;
      bound = bound.cwiseMax((linear.mesh_vectors().transpose() * linear.displacement(own_rate, force)).cwiseAbs());
    }
  }
  double reach = 0;
  for (const int m : meshes) {
    const double smallest = path.force.row(m).cwiseAbs().minCoeff();
    constexpr double nothing = 1e-6;
    const double here = smallest > nothing * problem.force_scale ? bound[m] * tangent[m] / smallest
                                                                 : std::numeric_limits<double>::infinity();
    if (std::isnan(here)) return std::numeric_limits<double>::infinity();
    reach = std::max(reach, here);
  }
  return reach;
}

}  // namespace

double reach_of_backlash(const LumpedSystem& system, const SteadyProblem& problem) {
  const auto meshes = meshes_with_backlash(system);
  if (meshes.empty()) return 0;
  const UntrappedFloatingPoint untrapped;  // the response of undamped systems is not bounded
  try {
    return bound_over_deflection(system, problem, meshes);
  } catch (const SolverError&) {
    return std::numeric_limits<double>::infinity();
  }
}

}  // namespace annulus::dynamics
