#include "app/plan/cost_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fem/cost_size.h"
#include "fem/loaded_mesh.h"
#include "fem/problem/solved_face.h"

namespace annulus::app {

namespace {

/// Wall time of steps, each taking `time_of` it.
template <class TimeOf>
double wall_time(const std::vector<CostStep>& steps, int threads, TimeOf time_of) {
  double in_turn = 0, responses = 0, longest = 0;
  for (const auto& step : steps) {
    const double seconds = time_of(step);
    if (step.kind == CostKind::response) {
      responses += seconds;
      longest = std::max(longest, seconds);
    } else {
      in_turn += seconds;
    }
  }
  return in_turn + std::max(longest, responses / std::max(1, threads));
}

/// The largest of the steps that `of` is known of; NaN where one is NaN or there is none.
template <class Value>
double largest(const std::vector<CostStep>& steps, std::initializer_list<CostKind> kinds, Value of) {
  double value = not_known;
  for (const auto& step : steps) {
    if (std::find(kinds.begin(), kinds.end(), step.kind) == kinds.end()) continue;
    if (std::isnan(of(step))) return not_known;
    value = std::fmax(value, of(step));
  }
  return value;
}

/// Solved at the first level, whatever the mesh needs (rim_coupling.cc).
CostRun coupling_size(const MeshModel& model) {
  const bool solid = fem::is_solid(model.settings.fidelity);
  const bool supported = fem::on_single_supports(model.problem->structure);
  auto settings = model.settings;
  if (settings.fidelity == fem::Fidelity::closed_form) settings.fidelity = fem::Fidelity::plane;
  settings.degree = model.coupling_degree;
  settings.symmetry = false;  // a ring's modes need not be symmetric
  // On single supports every ring position is a system of its own.
  return {.work = solid       ? Work::coupling_solid
                  : supported ? Work::coupling_pins
                              : Work::coupling_plane,
          .degree = settings.degree,
          .level = 1,
          .unknowns = fem::estimated_unknowns(*model.problem, settings, 1) * (supported ? model.positions : 1)};
}

/// Of one of many: searches solve formulas side by side, tables of elements one after another.
double table_seconds(const CostRun& table, int threads, int sharing) {
  return table.work == Work::closed_form ? processor_seconds(table) / sharing : predicted_cost(table, threads).seconds;
}

double study_seconds(const StudyPlan& study, int threads) {
  const int sharing = study.tasks > 0 ? std::min(threads, study.tasks) : threads;
  return study.seconds / sharing + study.tables * table_seconds(study.table, threads, sharing);
}

double expected_error_of(const MeshModel& model, const CostRun& size) {
  if (model.has_elements()) return expected_error(size.work, size.degree, size.level);
  const double error = model.formula_error ? *model.formula_error : fem::closed_form_error(*model.problem);
  return std::isfinite(error) ? error : not_known;
}

}  // namespace

const char* to_text(CostKind kind) {
  constexpr const char* names[] = {"mesh", "coupling", "response", "files", "studies"};
  return names[static_cast<int>(kind)];
}

PlanCost PlanCost::at_worst() const {
  PlanCost result = *this;
  for (auto& step : result.steps)
    if (step.further) step.predicted = *step.further;
  return result;
}

double PlanCost::seconds() const {
  return wall_time(steps, threads, [](const CostStep& s) { return s.predicted.seconds; });
}

double PlanCost::peak_MB() const {
  return largest(steps, {CostKind::mesh, CostKind::response}, [](const CostStep& s) { return s.predicted.peak_MB; });
}

double PlanCost::expected_error() const {
  return largest(steps, {CostKind::mesh}, [](const CostStep& s) { return s.expected_error; });
}

PlanCost PlanCost::at_pace(double machine) const {
  PlanCost result = *this;
  for (auto& step : result.steps) {
    step.predicted.seconds *= machine;
    if (step.further) step.further->seconds *= machine;
  }
  result.pace *= machine;
  return result;
}

double PlanCost::actual_seconds() const {
  return wall_time(steps, threads, [](const CostStep& s) { return s.actual ? s.actual->seconds() : 0.0; });
}

Work work_of(const MeshModel& model) {
  constexpr Work works[] = {Work::closed_form, Work::plane, Work::solid, Work::resolved_plane, Work::resolved_solid};
  const auto fidelity = model.settings.fidelity;
  if (fidelity != fem::Fidelity::solid) return works[static_cast<int>(fidelity)];
  // Every slice of helical teeth and of measured flanks has elements of its own. Half of a face has fewer slices with
  // the same section: the contact falls with them faster than with a coarser section.
  const auto &pinion = model.problem->pair.pinion(), &wheel = model.problem->pair.wheel();
  if (pinion.helix_angle() != 0 || geometry::measured(pinion.parameters()) || geometry::measured(wheel.parameters()))
    return Work::solid_helical;
  return fem::solved_face(*model.problem, model.settings).half ? Work::solid_half : Work::solid;
}

CostRun level_size(const MeshModel& model, int degree, int level) {
  const auto& problem = *model.problem;
  auto settings = model.settings;
  settings.degree = degree;
  CostRun size{.work = work_of(model), .degree = degree, .level = level};
  size.unknowns = fem::estimated_unknowns(problem, settings, level);
  size.supports = fem::support_forces(problem, settings, level);
  const double loads = static_cast<double>(problem.loads.size()), phases = problem.phases;
  size.contacts = loads * (phases + 1) + loads * (phases * model.positions + 1);
  // Formulas look for the borders of every contact patch that a tip relief may cut: 4 to 10 times the work.
  constexpr double of_relief = 7;
  if (size.work == Work::closed_form &&
      (problem.pair.pinion().parameters().tip_relief > 0 || problem.pair.wheel().parameters().tip_relief > 0))
    size.contacts *= of_relief;
  // A plane table of one mesh cycle is solved load by load, others position by position or body by body.
  const bool many = fem::is_solid(settings.fidelity) || model.positions > 1;
  size.tasks = static_cast<int>(many ? size.contacts : loads);
  return size;
}

namespace {

/// Solved with elements of one degree up to the level that is expected to do.
CostRun refined_size(const MeshModel& model, int degree, int last) {
  const auto& settings = model.settings;
  const int needed = expected_level(work_of(model), degree, settings.accuracy, last);
  CostRun size = level_size(model, degree, std::clamp(settings.level.value_or(needed), 0, last));
  // A level that is forced is solved with the one before it; refining starts at level 0 and passes them all.
  size.levels = last == 0 ? 1 : settings.level ? 2 : size.level + 1;
  return size;
}

bool linear_first(const MeshModel& model) { return model.settings.degree == 1 && !model.settings.level; }

/// Pictures of bodies, mostly of their elements, and time series; measured on eighty random scenes, within a factor
/// of 2.
double files_seconds(const std::vector<MeshModel>& meshes, const std::vector<PlannedResponse>& responses) {
  constexpr double any = 0.003, of_elements = 0.22, of_formulas = 0.005, of_a_cycle = 2e-5;
  double seconds = any;
  for (const auto& model : meshes)
    if (model.computed()) seconds += model.has_elements() ? of_elements : of_formulas;
  for (const auto& response : responses) seconds += of_a_cycle * response.size.unknowns;
  return seconds;
}

}  // namespace

CostRun mesh_size(const MeshModel& model) {
  const auto& settings = model.settings;
  if (linear_first(model)) {
    const int last_linear = fem::last_linear_level(*model.problem);
    if (expected_error(work_of(model), 1, last_linear) > settings.accuracy) return *quadratic_size(model);
    return refined_size(model, 1, last_linear);
  }
  return refined_size(model, settings.degree, fem::last_level(settings.fidelity));
}

std::optional<CostRun> quadratic_size(const MeshModel& model) {
  if (!linear_first(model)) return std::nullopt;
  CostRun size = refined_size(model, 2, fem::last_level(model.settings.fidelity));
  CostRun linear = refined_size(model, 1, fem::last_linear_level(*model.problem));
  linear.level = fem::last_linear_level(*model.problem);
  linear.levels = linear.level + 1;
  size.before_s = processor_seconds(linear);
  return size;
}

std::optional<CostRun> finer_size(const MeshModel& model) {
  constexpr double scatter = 3;  // sun and ring mesh of one stage: 0.083 and 0.23 % (data/cost_runs.csv, solid_half)
  const auto& settings = model.settings;
  const auto size = mesh_size(model);
  const int last = fem::last_level(settings.fidelity);
  if (!model.has_elements() || settings.level || size.degree == 1 || size.level >= last) return std::nullopt;
  if (!(scatter * expected_error(size.work, size.degree, size.level) > settings.accuracy)) return std::nullopt;
  CostRun finer = level_size(model, size.degree, size.level + 1);
  finer.levels = size.levels + 1;
  finer.before_s = size.before_s;
  return finer;
}

int comparisons(int tables) {
  constexpr int of_each = 2, of_all = 5;
  return tables > 0 ? of_all + of_each * tables : 0;
}

PlanCost plan_cost(const std::vector<MeshModel>& meshes, const std::vector<PlannedResponse>& responses,
                   const std::vector<StudyPlan>& studies, int threads,
                   const std::function<bool(const MeshModel&)>& coupled) {
  PlanCost cost{.steps = {}, .threads = threads};
  const auto add = [&](CostStep step) {
    if (step.kind != CostKind::files && step.kind != CostKind::studies)
      step.predicted = predicted_cost(step.size, threads);
    cost.steps.push_back(std::move(step));
  };
  for (const auto& model : meshes) {
    if (!model.computed()) continue;
    const auto size = mesh_size(model);
    auto cause = fmt::format(
        "its size follows from `accuracy` and `model` (here {}, {:.3g} unknowns per pair of "
        "sectors, {} ring positions)",
        cost_law(size.work).name, size.unknowns, model.positions);
    add({.kind = CostKind::mesh,
         .label = model.label(),
         .variant = model.variant,
         .size = size,
         .cause = std::move(cause),
         .expected_error = expected_error_of(model, size)});
    auto& step = cost.steps.back();
    if (const auto quadratic = quadratic_size(model); quadratic && size.degree == 1) {
      step.further = predicted_cost(*quadratic, threads);
      step.follow = "quadratic elements follow";
    } else if (const auto finer = finer_size(model)) {
      step.further = predicted_cost(*finer, threads);
      step.follow = fmt::format("level {} follows", finer->level);
    }
    if (coupled(model))
      add({.kind = CostKind::coupling,
           .label = fmt::format("coupling through '{}'", model.variant),
           .variant = model.variant,
           .size = coupling_size(model),
           .cause = fmt::format("it follows from `accuracy` and {} ring positions", model.positions)});
  }
  const bool elements = std::any_of(meshes.begin(), meshes.end(), [](const MeshModel& m) { return m.has_elements(); });
  for (const auto& response : responses) {
    auto size = response.size;
    if (elements) size.held_MB += loaded_elements_MB;
    add({.kind = CostKind::response,
         .label = response.label,
         .variant = response.variant,
         .size = size,
         .cause = "it follows from dynamics.mesh_cycles or, without it, from the period of the errors"});
    auto& step = cost.steps.back();
    if (response.search_s > 0) {
      step.further = step.predicted;
      step.further->seconds += response.search_s / threads;
      step.follow = "other motions are looked for";
    }
  }
  if (!cost.steps.empty())
    add({.kind = CostKind::files,
         .label = "pictures and files",
         .cause = "it follows from the meshes and the period of the errors",
         .predicted = {files_seconds(meshes, responses), not_known}});
  for (const auto& study : studies)
    add({.kind = CostKind::studies,
         .label = study.name,
         .size = {.unknowns = static_cast<double>(study.responses)},
         .cause = fmt::format("it asks for {} responses{}", study.responses,
                              study.tables ? fmt::format(" and {} tables", study.tables) : ""),
         .predicted = {study_seconds(study, threads), not_known}});
  return cost;
}

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds)) return "not known";
  if (seconds < 0.95) return fmt::format("{:.2g} s", std::max(0.01, seconds));
  if (seconds < 90) return fmt::format("{:.{}f} s", seconds, seconds < 9.5 ? 1 : 0);
  return seconds < 5400     ? fmt::format("{:.0f} min", seconds / 60)
         : seconds < 172800 ? fmt::format("{:.1f} h", seconds / 3600)
                            : fmt::format("{:.0f} days", seconds / 86400);
}

std::string memory_text(double MB) {
  if (!std::isfinite(MB)) return "not known";
  return MB < 1e4 ? fmt::format("{:.0f} MB", MB) : fmt::format("{:.3g} GB", MB / 1e3);
}

}  // namespace annulus::app
