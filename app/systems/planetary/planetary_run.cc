#include "app/systems/planetary/planetary_run.h"
#include "app/systems/planetary/rim_coupling.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "app/model/cost_actual.h"
#include "app/model/mesh_figures.h"
#include "app/results/cached_files.h"
#include "app/run/pipeline.h"
#include "app/scene/input_place.h"
#include "core/log.h"
#include "core/parallel.h"
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

namespace {

constexpr const char *cached_responses = "responses", *cached_effects = "coupling_effects";

/// Read back if unchanged, else computed and saved; nothing for a ring whose coupling was not solved, or changes
/// nothing.
std::optional<CouplingEffect> effect_of_coupling(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                                                 const MeshResult& sun_mesh, const MeshResult& ring_mesh,
                                                 const RunOptions& options) {
  if (!ring_mesh.coupling || is_negligible(scene, *ring_mesh.coupling)) return std::nullopt;
  const auto folder = options.out / scene.rings.at(ring).name / "dynamics";
  auto stage = make_stage(scene, geometry, ring, sun_mesh, ring_mesh);
  stage.ring_coupling = taken_coupling(*ring_mesh.coupling, RimCoupling::elastic);
  const auto simulation = simulation_options(scene, stage);
  const auto id = response_id(stage, simulation, sun_mesh, ring_mesh);
  const bool cached = restore_files(options.store.get(), cached_effects, id, folder);
  note_reuse(options, fmt::format("effect of the coupling of ring '{}'", scene.rings.at(ring).name), cached);
  if (cached) return load_effect(folder);
  stage.ring_coupling = nullptr;
  auto effect = coupling_effect(stage, *ring_mesh.coupling, simulation);
  save(effect, id, folder);
  cache_files(options.store.get(), cached_effects, id, folder, {effect_file});
  return effect;
}

/// Results of a response with the parts of their errors.
FigureSet response_figures(const StageResponse& response) {
  const auto& f = response.figures;
  auto set = dynamics::figures(f);
  const auto add_parts = [&](const std::string& mesh, const dynamics::MeshKindResult& kind, const MeshKindErrors& e) {
    set.set(mesh + "_load_sharing_averaged", kind.load_sharing.averaged, e.averaged);
    set.set(mesh + "_load_sharing_instantaneous", kind.load_sharing.instantaneous, e.instantaneous);
    set.set(mesh + "_load_sharing_quasi_static", kind.load_sharing.quasi_static, e.quasi_static);
    const auto factor = set.figure(mesh + "_dynamic_factor");
    for (std::size_t n = 0; n < kind.branches.size() && n < e.dynamic_factor_max.size(); ++n)
      if (kind.branches[n].dynamic_factor_max.value == factor.value) {
        set.set(mesh + "_dynamic_factor", factor, e.dynamic_factor_max[n]);
        break;
      }
  };
  add_parts("sun_planet", f.sun_planet, response.errors.sun_planet);
  add_parts("ring_planet", f.ring_planet, response.errors.ring_planet);
  set.add(frequency_figures(response.modes));
  return set;
}

}  // namespace

MeshResult mesh_stiffness(const Scene& scene, const GearGeometry& geometry, const MeshModel& model,
                          const RunOptions& options) {
  const bool sun = model.mesh == sun_planet;
  if (!model.computed()) {
    const auto& pair = sun ? geometry.sun_mesh() : geometry.rings.front().set.ring_mesh();
    return given_stiffness(model, sun ? scene.sun_planet : scene.ring_planet, scene, pair.contact_ratio(),
                           geometry.operating_point.mean_mesh_force);
  }
  auto result = [&] {
    try {
      return computed_stiffness(model, model.ring, options);
    } catch (const InputError& error) {  // found only by the solve; with its place
      const std::string what = sun ? "sun" : "ring '" + model.ring + "'";
      throw InputError(with_place(scene, what + ": " + error.what()));
    }
  }();
  if (options.with_dynamics && may_be_coupled(scene, model)) {
    result.coupling = std::make_shared<SolvedCoupling>(
        solve_coupling(scene, geometry, model, 1 / result.mean_stiffness().value, options, options.out / model.ring));
    note_reuse(options, fmt::format("coupling of ring '{}'", model.ring), result.coupling->reused);
  }
  return result;
}

StageResponse dynamic_response(const Scene& scene, const GearGeometry& geometry, std::size_t ring,
                               const MeshResult& sun_mesh, const MeshResult& ring_mesh, const RunOptions& options) {
  const auto& name = scene.rings.at(ring).name;
  const auto folder = options.out / name / "dynamics";
  const auto stage = make_stage(scene, geometry, ring, sun_mesh, ring_mesh);
  const auto simulation = simulation_options(scene, stage);
  const auto id = response_id(stage, simulation, sun_mesh, ring_mesh);
  const bool cached = restore_files(options.store.get(), cached_responses, id, folder);
  note_reuse(options, fmt::format("dynamics of '{}'", name), cached);
  if (cached) {
    log::info(fmt::format("dynamics of '{}': unchanged, reused", name));
    return load_response(folder);
  }
  const auto make = [&](const MeshResult& sun, const MeshResult& wheel) {
    return make_stage(scene, geometry, ring, sun, wheel);
  };
  auto response = simulate_and_save(stage, simulation, {make, sun_mesh, ring_mesh}, id, folder);
  cache_files(options.store.get(), cached_responses, id, folder, response_files());
  const auto& f = response.figures;
  if (f.total_cycles == 0)
    log::info(fmt::format("dynamics of '{}': periodic steady state, by harmonic balance", name));
  else
    log::info(fmt::format("dynamics of '{}': {} mesh cycles, {} steps, {}", name, f.total_cycles, f.statistics.steps,
                          f.steady ? "periodic steady state" : "no periodic steady state"));
  if (f.periodic && !f.confirmed && f.total_cycles > 0)
    log::info(fmt::format("dynamics of '{}': found by time integration; {}", name,
                          f.periodic->converged
                              ? fmt::format("the harmonic balance differs (with half its samples by {:.1e})",
                                            f.periodic->sampling_difference)
                              : "the harmonic balance failed: " + f.periodic->trouble));
  return response;
}

RunResult::RunResult(const Scene& of) : geometry(make_geometry(of)) { scene = of; }

void RunResult::solve_meshes(const RunOptions& options) {
  sun_mesh = mesh_stiffness(scene, geometry, plan.meshes.front(), options);
  for (std::size_t i = 0; i < scene.rings.size(); ++i) {
    const auto& name = scene.rings[i].name;
    rings.push_back({name, mesh_stiffness(scene, geometry, plan.meshes[i + 1], options)});
  }
}

void RunResult::respond(const RunOptions& options) {
  const auto timer = timers.measure("dynamics");
  for_each_task(rings.size(), options.threads, [&](std::size_t i) {
    auto& ring = rings[i];
    StageTimers response_timers;
    {
      const auto response_timer = response_timers.measure("response");
      ring.response = dynamic_response(scene, geometry, i, sun_mesh, ring.mesh, options);
      ring.coupling_effect = effect_of_coupling(scene, geometry, i, sun_mesh, ring.mesh, options);
    }
    ring.response_seconds = response_timers.seconds("response");
  });
}

std::vector<const MeshResult*> RunResult::meshes() const {
  std::vector<const MeshResult*> list = {&sun_mesh};
  for (const auto& ring : rings) list.push_back(&ring.mesh);
  return list;
}

std::vector<VariantFigures> RunResult::variants() const {
  std::vector<VariantFigures> list;
  for (const auto& ring : rings) {
    FigureSet set = mesh_figures(ring.mesh);
    set.add(mesh_figures(sun_mesh));
    if (ring.response) set.add(response_figures(*ring.response));
    list.push_back({ring.name, std::move(set)});
  }
  return list;
}

std::optional<CostRun> RunResult::actual(const CostStep& step) const {
  if (step.kind == CostKind::mesh && step.label == sun_mesh.model.label()) return actual_mesh(step.size, sun_mesh);
  for (const auto& ring : rings) {
    const auto& coupling = ring.mesh.coupling;
    if (step.kind == CostKind::mesh && step.label == ring.mesh.model.label()) return actual_mesh(step.size, ring.mesh);
    if (step.kind == CostKind::coupling && step.ring == ring.name && coupling && !coupling->reused)
      return actual_time(step.size, coupling->seconds);
    if (step.kind == CostKind::response && step.ring == ring.name && ring.response && !ring.response->reused)
      return actual_time(step.size, ring.response_seconds);
  }
  return std::nullopt;
}

RunResult run(const Scene& scene, const RunOptions& options) {
  RunResult result(scene);
  run_system(result, options);
  return result;
}

}  // namespace annulus::app
