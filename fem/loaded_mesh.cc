#include "fem/loaded_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/errors.h"
#include "core/stopwatch.h"
#include "fem/body/resolution.h"
#include "fem/closed_form/closed_form_mesh.h"
#include "fem/cost_size.h"
#include "fem/levels/error_estimate.h"
#include "fem/levels/level.h"
#include "fem/problem/problem_check.h"
#include "fem/problem/solved_pair.h"

namespace annulus::fem {
namespace {

/// Finished fraction of the whole work from that of one level. The work grows with the number of cells, and at least
/// the first level is solved after the one before it; a further one makes the finished part smaller again.
ProgressFunction progress_of_level(const LoadedMeshSettings& settings, int first_level, int level) {
  if (!settings.progress) return [](double) {};
  return [progress = settings.progress, first_level, level](double fraction) {
    constexpr double growth = level_ratio * level_ratio;
    double before = 0, whole = 0;
    for (int l = first_level - 1; l <= std::max(level, first_level); ++l) {
      const double work = std::pow(growth, l);
      before += l < level ? work : l == level ? fraction * work : 0;
      whole += work;
    }
    progress(before / whole);
  };
}

/// Solves level after level until the estimated error of one is within the accuracy.
class Refinement {
 public:
  Refinement(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings)
      : problem_(problem),
        settings_(settings),
        flanks_(solved_pair(problem.pair)),
        last_level_(fem::last_level(settings.fidelity)),
        first_level_(settings.level.value_or(1)) {
    if (first_level_ < 1 || first_level_ > last_level_)
      throw InputError(fmt::format("level {} is not available: 1 to {} are", first_level_, last_level_));
  }

  [[nodiscard]] LoadedMeshResult run() {
    coarser_ = solve(first_level_ - 1, {});
    int level = first_level_;
    while (!accept(level)) level = next(level);
    LoadedMeshResult result = tabulated(problem_, std::move(finer_.positions));
    static_cast<SolvedBodies&>(result) = std::move(finer_);
    static_cast<SolveCost&>(result) = cost_;
    result.level = level;
    result.degree = settings_.degree;
    result.worst_error_relative = errors_.worst;
    result.pinion_stress_error = errors_.pinion_stress;
    result.wheel_stress_error = errors_.wheel_stress;
    result.face_load_factor_error = errors_.face_load_factor;
    return result;
  }

 private:
  [[nodiscard]] SolvedLevel solve(int level, const AcceptLevel& accept) {
    if (settings_.before_level) settings_.before_level(settings_.degree, level);
    auto solved = (is_resolved(settings_.fidelity) ? solve_resolved_level : solve_condensed_level)(
        problem_, settings_, flanks_, level, accept, progress_of_level(settings_, first_level_, level));
    cost_ += solved;
    return solved;
  }

  /// Solves a level and estimates its error against the coarser one; true when it becomes the result.
  [[nodiscard]] bool accept(int level) {
    bool accepted = false;
    const auto estimate = [&](SolvedLevel& finer) {
      const auto errors =
          estimate_errors(problem_, settings_, finer.own, coarser_.positions, finer.positions, difference_);
      errors_ = errors;
      return accepted = settings_.level || errors_.worst <= settings_.accuracy;
    };
    finer_ = solve(level, estimate);
    if (!accepted) return false;
    estimate(finer_);  // of all positions
    return true;
  }

  /// The level to solve after one that is not accurate enough; linear elements give way to quadratic ones.
  [[nodiscard]] int next(int level) {
    difference_ = errors_.difference;
    if (settings_.degree == 1 && level >= last_linear_level(problem_)) {
      settings_.degree = 2;
      coarser_ = solve(0, {});
      difference_.reset();
      return 1;
    }
    if (level == last_level_)
      throw SolverError(
          fmt::format("the mesh stiffness reached a relative accuracy of {:.2g} at the finest resolution, not "
                      "the wanted {:.2g}: ask for less accuracy",
                      errors_.worst, settings_.accuracy));
    std::swap(coarser_, finer_);
    return level + 1;
  }

  const LoadedMeshProblem& problem_;
  LoadedMeshSettings settings_;
  FlankContact flanks_;
  int last_level_, first_level_;
  SolvedLevel coarser_, finer_;
  std::optional<double> difference_;  // of the last two levels
  LevelErrors errors_;
  SolveCost cost_;
};

}  // namespace

LoadedMeshResult solve_loaded_mesh(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings) {
  check_problem(problem, settings.fidelity);
  const ProcessorStopwatch watch;
  auto result = settings.fidelity == Fidelity::closed_form ? solve_closed_form(problem, settings)
                                                           : Refinement(problem, settings).run();
  result.processor_seconds = watch.seconds();
  return result;
}

}  // namespace annulus::fem
