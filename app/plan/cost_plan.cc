#include "app/plan/cost_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
      if (std::isnan(seconds)) return seconds;
    } else {
      in_turn += seconds;
    }
  }
  return in_turn + std::max(longest, responses / std::max(1, threads));
}

CostRun coupling_size(const MeshModel& model, int threads) {
  // Solved at the first level, whatever the mesh needs (rim_coupling.cc).
  CostRun size;
  const bool solid = fem::is_solid(model.settings.fidelity);
  const bool supported = fem::on_single_supports(model.problem->structure);
  size.kind = solid ? "coupling_solid" : supported ? "coupling_pins" : "coupling_plane";
  size.level = 1;
  size.cycles = model.positions;
  size.threads = threads;
  auto settings = model.settings;
  if (settings.fidelity == fem::Fidelity::closed_form) settings.fidelity = fem::Fidelity::plane;
  size.degree = settings.degree = model.coupling_degree;
  settings.symmetry = false;  // a ring's modes need not be symmetric
  // On single supports every ring position is a system of its own.
  size.unknowns = fem::estimated_unknowns(*model.problem, settings, 1) * (supported ? model.positions : 1);
  return size;
}

constexpr double unknown_cost = std::numeric_limits<double>::quiet_NaN();

/// The steps of a run in their order.
struct CostSteps {
  PlanCost cost;
  const CostModel& costs;
  double longest_table = 0;  // s

  CostSteps(int threads, const CostModel& model) : cost{.steps = {}, .threads = threads}, costs(model) {}
  void add(CostKind kind, std::string label, std::string ring, CostRun size, double error = unknown_cost,
           double integration_s = 0) {
    auto predicted = costs.predict(size);
    predicted.seconds += integration_s;
    cost.steps.push_back({kind, std::move(label), std::move(ring), std::move(size), predicted, integration_s, error});
  }
  void add_mesh(const MeshModel& model) {
    const auto size = mesh_size(model, cost.threads, costs);
    add(CostKind::mesh, model.label(), model.ring, size, expected_error(model, size));
    longest_table = std::max(longest_table, cost.steps.back().predicted.seconds);
  }
  [[nodiscard]] double expected_error(const MeshModel& model, const CostRun& size) const {
    if (model.settings.fidelity != fem::Fidelity::closed_form)
      return costs.expected_error(size.kind, size.degree, size.level);
    const double error = model.formula_error ? *model.formula_error : fem::closed_form_error(*model.problem);
    return std::isfinite(error) ? error : unknown_cost;
  }
  void add_responses(const std::vector<PlannedResponse>& responses) {
    for (const auto& response : responses)
      add(CostKind::response, response.label, response.ring, response.size, unknown_cost, response.integration_s);
  }
  void add_studies(const std::vector<StudyPlan>& studies) {
    for (const auto& study : studies)
      cost.steps.push_back({CostKind::studies,
                            study.name,
                            "",
                            {},
                            {study.seconds / cost.threads + study.tables * longest_table, unknown_cost},
                            0,
                            unknown_cost});
  }
};

}  // namespace

const char* to_text(CostKind kind) {
  switch (kind) {
    case CostKind::mesh:
      return "mesh";
    case CostKind::coupling:
      return "coupling";
    case CostKind::response:
      return "response";
    case CostKind::studies:
      break;
  }
  return "studies";
}

double PlanCost::seconds() const {
  return wall_time(steps, threads, [](const CostStep& s) { return s.predicted.seconds; });
}

double PlanCost::peak_MB() const {
  double peak = 0;
  for (const auto& step : steps) {
    if (step.kind == CostKind::studies || step.kind == CostKind::coupling) continue;
    if (std::isnan(step.predicted.peak_MB)) return step.predicted.peak_MB;
    peak = std::max(peak, step.predicted.peak_MB);
  }
  return peak;
}

double PlanCost::expected_error() const {
  double error = std::numeric_limits<double>::quiet_NaN();
  for (const auto& step : steps) {
    if (step.kind != CostKind::mesh) continue;
    if (std::isnan(step.expected_error)) return step.expected_error;
    error = std::isnan(error) ? step.expected_error : std::max(error, step.expected_error);
  }
  return error;
}

PlanCost PlanCost::done() const {
  PlanCost result{.steps = {}, .threads = threads};
  for (const auto& step : steps)
    if (step.actual) result.steps.push_back(step);
  return result;
}

double PlanCost::actual_seconds() const {
  return wall_time(steps, threads, [](const CostStep& s) { return s.actual ? s.actual->seconds() : 0.0; });
}

std::string cost_kind(const MeshModel& model) {
  if (!model.computed() || model.settings.fidelity != fem::Fidelity::solid) return model.fidelity;
  // The contact of helical teeth moves along the face width: every slice has elements of its own.
  if (model.problem->pair.planet().helix_angle() != 0) return "solid_helical";
  // Fewer slices with the same section: the contact falls with them faster than with a coarser section.
  return fem::solved_face(*model.problem, model.settings).half ? "solid_half" : model.fidelity;
}

CostRun mesh_size(const MeshModel& model, int threads, const CostModel& costs) {
  auto settings = model.settings;
  int last = fem::last_level(settings.fidelity);
  CostRun size;
  size.kind = cost_kind(model);
  if (settings.degree == 1 && !settings.level) {
    const int last_linear = fem::last_linear_level(*model.problem);
    if (costs.expected_error(size.kind, 1, last_linear) > settings.accuracy)
      settings.degree = 2;  // they follow where linear ones do not do
    else
      last = last_linear;
  }
  size.degree = settings.degree;
  size.level = std::clamp(
      settings.level.value_or(costs.expected_level(size.kind, size.degree, settings.accuracy, last)), 0, last);
  // A level that is forced is solved with the one before it; refining starts at level 0 and passes them all.
  size.levels = last == 0 ? 1 : settings.level ? 2 : size.level + 1;
  size.unknowns = fem::estimated_unknowns(*model.problem, settings, size.level);
  size.supports = fem::support_forces(*model.problem, settings, size.level);
  size.loads = static_cast<int>(model.problem->loads.size());
  size.phases = model.problem->phases;
  size.cycles = model.positions;
  size.threads = threads;
  return size;
}

double rough_stiffness(const Scene& scene, const MeshInput& mesh) {
  constexpr double per_width = 18e9;  // N/m^2, mean of one and two pairs of steel teeth
  constexpr double steel = 206e9;
  return mesh.mean.value_or(per_width * scene.stage.face_width * scene.material.youngs_modulus / steel);
}

PlanCost plan_cost(const std::vector<MeshModel>& meshes, const std::vector<PlannedResponse>& responses,
                   const std::vector<StudyPlan>& studies, int threads, const CostModel& costs,
                   const std::function<bool(const MeshModel&)>& coupled) {
  CostSteps steps(threads, costs);
  for (const auto& model : meshes) {
    if (!model.computed()) continue;
    steps.add_mesh(model);
    if (coupled(model))
      steps.add(CostKind::coupling, fmt::format("coupling through '{}'", model.ring), model.ring,
                coupling_size(model, threads));
  }
  steps.add_responses(responses);
  steps.add_studies(studies);
  return steps.cost;
}

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds)) return "not known";
  if (seconds < 0.95) return fmt::format("{:.2g} s", std::max(0.01, seconds));
  if (seconds < 90) return fmt::format("{:.{}f} s", seconds, seconds < 9.5 ? 1 : 0);
  return seconds < 5400     ? fmt::format("{:.0f} min", seconds / 60)
         : seconds < 172800 ? fmt::format("{:.1f} h", seconds / 3600)
                            : fmt::format("{:.0f} days", seconds / 86400);
}

std::string memory_text(double MB) { return std::isfinite(MB) ? fmt::format("{:.0f} MB", MB) : "not known"; }

}  // namespace annulus::app
