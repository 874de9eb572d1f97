#include "app/systems/planetary/planetary_run.h"

#include <fmt/format.h>

#include "app/results/cached_value.h"
#include "app/run/pipeline.h"
#include "app/scene/input_place.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/rim_coupling.h"
#include "app/systems/planetary/space_dynamics.h"
#include "app/systems/planetary/stage_members.h"
#include "app/systems/shared/faces.h"
#include "app/systems/shared/mesh_names.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/errors.h"
#include "core/log.h"
#include "core/parallel.h"
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

namespace {

constexpr const char *cached_responses = "responses", *cached_effects = "coupling_effects";

/// Nothing for a ring whose coupling was not solved, or changes nothing.
std::optional<CouplingEffect> effect_of_coupling(const Scene& scene, dynamics::PlanetaryStage stage,
                                                 const MeshResult& sun_mesh, const MeshResult& ring_mesh,
                                                 const std::string& name, const RunOptions& options) {
  if (!ring_mesh.coupling || is_negligible(scene, *ring_mesh.coupling) || stage.space) return std::nullopt;
  stage.ring_coupling = taken_coupling(*ring_mesh.coupling, RimCoupling::elastic);
  const auto simulation = simulation_options(scene, stage);
  const auto id = response_id(stage, simulation, sun_mesh, ring_mesh);
  stage.ring_coupling = nullptr;
  const auto [effect, reused] = cached_value(options.store.get(), cached_effects, id,
                                             [&] { return coupling_effect(stage, *ring_mesh.coupling, simulation); });
  note_reuse(options, fmt::format("effect of the coupling of ring '{}'", name), source_of(reused));
  save(effect, id, options.out / name / "dynamics");
  return effect;
}

/// Results of a response with the parts of their errors.
FigureSet response_figures(const StageResponse& response) {
  const auto& f = response.figures;
  auto set = dynamics::figures(f);
  const auto parts = [&](const std::string& key) { return response.errors.find(key)->parts; };
  for (const auto& kind : dynamics::stage_mesh_kinds) {
    const auto& [sharing, branches] = f.*kind.results;
    for (const auto& quantity : dynamics::sharing_quantities) {
      const auto key = dynamics::sharing_key(kind.name, quantity);
      set.set(key, sharing.*quantity.value, parts(key));
    }
    for (const auto& quantity : dynamics::branch_quantities) {
      const auto worst = dynamics::worst_branch(branches, quantity.value);
      set.set(fmt::format("{}_{}", kind.name, quantity.name), branches[worst].*quantity.value,
              parts(dynamics::branch_key(kind.name, worst, quantity)));
    }
  }
  if (!f.shafts.empty()) {
    const auto& shaft = f.shafts[dynamics::worst_shaft(f.shafts)];
    if (shaft.nominal_torque > 0)
      set.set(dynamics::shaft_key, shaft.torque_factor(),
              (1 / shaft.nominal_torque) * parts(dynamics::torque_key(shaft)));
  }
  set.add(frequency_figures(response.modes));
  return set;
}

/// How the motion was found, for people.
std::string course_of(const dynamics::DynamicResponse& f) {
  if (f.total_cycles == 0) return "periodic steady state, by harmonic balance";
  auto course = fmt::format("{} mesh cycles, {} steps, {}", f.total_cycles, f.statistics.steps,
                            f.steady ? "periodic steady state" : "no periodic steady state");
  if (!f.periodic || f.confirmed) return course;
  return fmt::format("{}; found by time integration; {}", course,
                     f.periodic->converged ? fmt::format("the harmonic balance differs (at other samplings by {:.1e})",
                                                         f.periodic->sampling_difference)
                                           : "the harmonic balance failed: " + f.periodic->trouble);
}

}  // namespace

MeshResult mesh_stiffness(const Scene& scene, const GearGeometry& geometry, const MeshModel& model,
                          const RunOptions& options) {
  const bool sun = model.mesh == sun_planet;
  if (!model.computed()) {
    const auto& pair = sun ? geometry.sun_mesh() : geometry.rings.front().set.ring_mesh();
    return prescribed_stiffness(
        model, in_transverse_section(sun ? sun_and_planets(scene).sun_planet : planetary(scene).ring_planet, pair),
        scene, pair.contact_ratio(), geometry.operating_point.mean_mesh_force);
  }
  MeshResult result;
  about(scene, sun ? "sun" : "ring '" + model.variant + "'",
        [&] { result = computed_stiffness(model, model.variant, options); });
  if (options.with_dynamics && scene.dynamics && moves_in_space(scene))
    result.face = face_in_motion(result, geometry.operating_point.mean_mesh_force, options);
  if (options.with_dynamics && may_be_coupled(scene, model)) {
    result.coupling = std::make_shared<SolvedCoupling>(solve_coupling(
        scene, geometry, model, 1 / result.mean_stiffness().value, options, options.out / model.variant));
    note_reuse(options, fmt::format("coupling of ring '{}'", model.variant), source_of(result.coupling->reused));
  }
  return result;
}

std::unique_ptr<RingResponse> ring_response(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                            const MeshResult& sun_mesh, const MeshResult& ring_mesh,
                                            const RunOptions& options) {
  const auto& name = planetary(scene).rings.at(ring).name;
  const auto make = [&](const MeshResult& sun, const MeshResult& wheel) {
    return make_stage(scene, geometry, ring, sun, wheel);
  };
  const auto stage = make(sun_mesh, ring_mesh);
  auto simulation = simulation_options(scene, stage);
  simulation.other_motions.threads = options.threads;
  auto id = response_id(stage, simulation, sun_mesh, ring_mesh);
  if (!ring_mesh.gauges.rows.empty()) id = identity_of(id, ring_mesh.gauges.text());
  auto [response, reused] = cached_value(options.store.get(), cached_responses, id, [&] {
    auto found = simulate_stage(stage, simulation, {make, sun_mesh, ring_mesh});
    if (stage.space)
      add_face_loads(found.motion.space, moving_stage_faces(scene, geometry, ring, sun_mesh, ring_mesh, options),
                     options.threads);
    return found;
  });
  note_reuse(options, fmt::format("dynamics of '{}'", name), source_of(reused));
  save(response, id, options.out / name / "dynamics");
  response.time_series.clear();
  response.reused = reused;
  log::info(fmt::format("dynamics of '{}': {}", name, reused ? "unchanged, reused" : course_of(response.figures)));
  auto result = std::make_unique<RingResponse>();
  result->figures = response_figures(response);
  result->motions = response.figures.motions;
  result->shafts = response.figures.shafts;
  result->reused = reused;
  result->stage = std::move(response);
  result->tolerances = tolerance_sharing(scene, geometry, ring, stage, sun_mesh, ring_mesh, options);
  if (result->tolerances) result->figures.add(figures(*result->tolerances));
  result->coupling_effect = effect_of_coupling(scene, stage, sun_mesh, ring_mesh, name, options);
  return result;
}

RunResult::RunResult(const SystemRun& of)
    : RunView(of), geometry(make_geometry(of.scene)), sun_mesh(of.tables.front()) {
  for (std::size_t i = 0; i < planetary(scene).rings.size(); ++i) {
    auto& ring = rings.emplace_back(RingResult{planetary(scene).rings[i].name, of.tables.at(i + 1)});
    if (of.responses.empty()) continue;
    const auto& response = static_cast<const RingResponse&>(*of.responses.at(i));
    ring.response = &response.stage;
    if (response.coupling_effect) ring.coupling_effect = &*response.coupling_effect;
    if (response.tolerances) ring.tolerances = &*response.tolerances;
  }
}

RunResult run(const Scene& scene, const RunOptions& options) { return RunResult(*run_system(scene, options)); }

}  // namespace annulus::app
