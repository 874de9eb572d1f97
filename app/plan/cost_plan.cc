#include "app/plan/cost_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "app/plan/accuracy_choice.h"
#include "app/systems/planetary/planetary_subject.h"
#include "app/systems/planetary/rim_coupling.h"
#include "app/systems/planetary/stage_response.h"
#include "dynamics/steady_state/integration_cost.h"
#include "dynamics/systems/planetary/study_point.h"
#include "fem/cost_size.h"
#include "fem/loaded_mesh.h"
#include "fem/problem/solved_face.h"

namespace annulus::app {

namespace {

/// Wall time of steps whose times `time_of` tells.
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
  const bool solid =
      model.settings.fidelity == fem::Fidelity::solid || model.settings.fidelity == fem::Fidelity::resolved_solid;
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
           double marching_s = 0) {
    auto predicted = costs.predict(size);
    predicted.seconds += marching_s;
    cost.steps.push_back({kind, std::move(label), std::move(ring), std::move(size), predicted, marching_s, error});
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
      add(CostKind::response, response.label, response.ring, response.size, unknown_cost, response.marching_s);
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

namespace {

/// The stages with rough stiffness: what periods, steps and DOFs follow from before anything is solved.
std::vector<dynamics::PlanetaryStage> rough_stages(const Scene& scene, const GearGeometry& geometry) {
  Scene rough = scene;
  for (auto* mesh : {&rough.sun_planet, &rough.ring_planet}) {
    const double mean = rough_stiffness(scene, *mesh);
    const bool jumps = mesh->stiffness == StiffnessShape::rectangular;
    if (jumps) continue;
    *mesh = {};
    mesh->stiffness = StiffnessShape::constant;
    mesh->mean = mean;
  }
  // A given stiffness reads no table: any will do.
  const MeshResult none{
      .model = {},
      .table = StiffnessTable("sun_planet", 4, {0.0}, {1.0}, std::vector<StiffnessEntry>(4, {0, 1, 1, 1, 0}))};
  std::vector<dynamics::PlanetaryStage> stages;
  for (std::size_t i = 0; i < scene.rings.size(); ++i) stages.push_back(make_stage(rough, geometry, i, none, none));
  return stages;
}

}  // namespace

double rough_stiffness(const Scene& scene, const MeshInput& mesh) {
  constexpr double per_width = 18e9;  // N/m^2, mean of one and two pairs of steel teeth
  constexpr double steel = 206e9;
  return mesh.mean.value_or(per_width * scene.stage.face_width * scene.material.youngs_modulus / steel);
}

std::vector<double> marching_seconds(const Scene& scene, const GearGeometry& geometry) {
  const auto periods = period_cycles(scene, geometry);
  std::vector<double> seconds;
  for (const auto& stage : rough_stages(scene, geometry)) {
    const auto options = simulation_options(scene, stage);
    const auto system = assemble(stage);
    const double cycles = dynamics::integrated_cycles(system, stage.mesh_frequency(), periods[seconds.size()], options);
    seconds.push_back(dynamics::integration_seconds(system, stage.mesh_frequency(), cycles, options.integrator));
  }
  return seconds;
}

std::vector<int> period_cycles(const Scene& scene, const GearGeometry& geometry) {
  // The period follows from errors and tables, not from stiffness.
  const auto models = mesh_models(scene, geometry);
  const auto stages = rough_stages(scene, geometry);
  std::vector<int> periods;
  for (std::size_t i = 0; i < scene.rings.size(); ++i) {
    const auto& stage = stages[i];
    const int period = std::lcm(stage.error_period(), models[i + 1].positions);
    periods.push_back(std::min(period, std::max(simulation_options(scene, stage).max_window_cycles, 4000)));
  }
  return periods;
}

PlanCost plan_cost(const std::vector<MeshModel>& meshes, const std::vector<PlannedResponse>& responses,
                   const std::vector<StudyPlan>& studies, int threads, const CostModel& costs) {
  CostSteps steps(threads, costs);
  for (const auto& model : meshes)
    if (model.computed()) steps.add_mesh(model);
  steps.add_responses(responses);
  steps.add_studies(studies);
  return steps.cost;
}

double planetary_response_seconds(const Scene& scene, const GearGeometry& geometry) {
  double seconds = 0;
  for (const int period : period_cycles(scene, geometry))
    seconds += dynamics::point_seconds(scene.stage.planets, period);
  // Studies integrate in time only where a number of cycles is asked for.
  if (scene.dynamics->mesh_cycles)
    for (const double integrated : marching_seconds(scene, geometry)) seconds += integrated;
  return seconds;
}

std::vector<PlannedResponse> planetary_responses(const Scene& scene, const GearGeometry& geometry,
                                                 const std::vector<MeshModel>& meshes) {
  if (!scene.dynamics) return {};
  std::vector<std::string> elastic;
  bool computed = false;
  for (const auto& model : meshes) {
    if (!model.computed()) continue;
    computed = true;
    // A ring held all around its outside has no modes as low as the stage's.
    if (may_be_coupled(scene, model) && scene.dynamics->rim_coupling != RimCoupling::statical &&
        !fem::held_outside(model.problem->structure))
      elastic.push_back(model.ring);
  }
  const auto periods = period_cycles(scene, geometry);
  const auto marching = marching_seconds(scene, geometry);
  // With tables their errors are carried through: a base, both meshes stiffer and more rippled, half the phases.
  const double marches = computed && scene.dynamics->mesh_cycles ? 7 : 1;
  std::vector<PlannedResponse> responses;
  for (std::size_t i = 0; i < scene.rings.size(); ++i) {
    const auto& name = scene.rings[i].name;
    CostRun size;
    const bool modes = std::find(elastic.begin(), elastic.end(), name) != elastic.end();
    const bool marched = motion_choice(scene.accuracy).confirm || scene.dynamics->mesh_cycles;
    size.kind = modes ? "response_elastic" : !computed ? "response_given" : marched ? "response" : "response_direct";
    // A window is kept and evaluated, however many cycles lead to it.
    size.unknowns = static_cast<double>(scene.stage.planets) *
                    std::min(periods[i], scene.dynamics->mesh_cycles.value_or(periods[i]));
    responses.push_back({fmt::format("dynamics of '{}'", name), name, size, marches * marching[i]});
  }
  return responses;
}

PlanCost plan_cost(const Scene& scene, const GearGeometry& geometry, const std::vector<MeshModel>& meshes,
                   const std::vector<StudyPlan>& studies, int threads, const CostModel& costs) {
  CostSteps steps(threads, costs);
  for (const auto& model : meshes) {
    if (!model.computed()) continue;
    steps.add_mesh(model);
    if (!may_be_coupled(scene, model)) continue;
    steps.add(CostKind::coupling, fmt::format("coupling through '{}'", model.ring), model.ring,
              coupling_size(model, threads));
  }
  if (!scene.dynamics) return steps.cost;
  steps.add_responses(planetary_responses(scene, geometry, meshes));
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
