#include "dynamics/steady_state/random_starts.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamics/modes/modes.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/statistics/sampling.h"

namespace annulus::dynamics {

RandomStarts::RandomStarts(const LumpedSystem& system, const SteadyProblem& problem, double size, std::uint64_t seed)
    : system_(system), seed_(seed), size_(size), deflection_(problem.force_scale / problem.stiffness) {
  StaticSolver solver(system);
  auto workspace = system.workspace();
  equilibrium_ = solver.solve(0, workspace);
  double rates = 0, meshes = 0;
  for (int m = 0; m < static_cast<int>(workspace.force.size()); ++m) {
    if (!system.is_gear_mesh(m)) continue;  // shafts are twisted by far more
    const auto i = static_cast<std::size_t>(m);
    deflection_ = std::max(deflection_, std::abs(workspace.force[i]) / workspace.stiffness[i]);
    const Eigen::VectorXd b = system.mesh_vector(m);
    rates += std::sqrt(workspace.stiffness[i] * b.dot(system.mass().llt().solve(b)));
    ++meshes;
  }
  rate_ = std::max(2 * std::numbers::pi * problem.mesh_frequency, rates / meshes);
  for (const auto& mode : modes(system, mean_stiffnesses(system)).modes)
    if (mode.frequency == 0) rigid_.push_back(mode.shape);
}

SystemState RandomStarts::draw(std::uint64_t number) const {
  const double size = size_ * deflection_;
  return {0, equilibrium_ + size * random_vector(number, " displacement"),
          size * rate_ * random_vector(number, " velocity"), 0, 0};
}

SystemState RandomStarts::beside(SystemState state) const {
  constexpr double little = 0.01;
  state.time = 0;
  state.q += little * deflection_ * random_vector(0, " displacement");
  return state;
}

/// Entries within -1 ... 1, rigid motions taken out: they would turn the system at another speed.
Eigen::VectorXd RandomStarts::random_vector(std::uint64_t number, const char* quantity) const {
  Eigen::VectorXd v(system_.dofs());
  for (int i = 0; i < system_.dofs(); ++i)
    v[i] = 2 * uniform_draw(seed_, number, system_.names()[static_cast<std::size_t>(i)] + quantity) - 1;
  for (const auto& nu : rigid_) v -= nu * nu.dot(system_.mass() * v);
  return v;
}

}  // namespace annulus::dynamics
