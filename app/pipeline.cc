#include "app/pipeline.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/plan/cost_actual.h"
#include "app/progress.h"
#include "app/report/report.h"
#include "app/scene/input_place.h"
#include "app/scene/scene_files.h"
#include "app/stage/summary.h"
#include "app/study/planetary_subject.h"
#include "app/study/studies.h"
#include "app/tasks.h"
#include "core/files.h"
#include "core/log.h"

namespace annulus::app {

namespace {

std::vector<geometry::PointData> point_data(const fem::BodyField& field) {
  geometry::PointData displacement{"displacement_m", 3, {}}, von_mises{"von_mises_Pa", 1, {}},
      stress{"stress_xx_yy_zz_xy_yz_zx_Pa", 6, {}};
  for (std::size_t v = 0; v < field.displacement.size(); ++v) {
    for (int c = 0; c < 3; ++c) displacement.values.push_back(static_cast<float>(field.displacement[v][c]));
    von_mises.values.push_back(static_cast<float>(field.von_mises(v)));
    for (const double s : field.stress[v]) stress.values.push_back(static_cast<float>(s));
  }
  return {std::move(displacement), std::move(von_mises), std::move(stress)};
}

void write_meshes(const MeshModel& model, const fem::LoadedMeshResult& solved, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const auto name_of = [&](bool planet) { return model.mesh + "_" + model.body_name(planet); };
  for (const auto& [mesh, planet] : {std::pair{&solved.planet_sector, true}, {&solved.wheel_sector, false}}) {
    if (mesh->cells.empty()) continue;  // a closed form meshes nothing
    const auto name = name_of(planet);
    geometry::write_msh(*mesh, folder / (name + ".msh"));
    geometry::write_vtu(*mesh, folder / (name + ".vtu"));
  }
  for (const auto& field : solved.fields)
    geometry::write_vtu(field.mesh, folder / (name_of(field.body == "planet") + "_field.vtu"), point_data(field));
}

/// The sun mesh belongs to all rings: one added later gets its files from the others.
void copy_meshes(const MeshModel& model, const std::filesystem::path& from, const std::filesystem::path& to) {
  if (from == to || !std::filesystem::exists(from)) return;
  std::filesystem::create_directories(to);
  for (const auto& file : std::filesystem::directory_iterator(from)) {
    const auto name = file.path().filename();
    if (!name.string().starts_with(model.mesh + "_")) continue;
    std::filesystem::copy_file(file.path(), to / name, std::filesystem::copy_options::skip_existing);
  }
}

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
  auto kept = load_effect(id, folder);
  note_reuse(options, fmt::format("effect of the coupling of ring '{}'", scene.rings.at(ring).name), kept.has_value());
  if (kept) return kept;
  stage.ring_coupling = nullptr;
  auto effect = coupling_effect(stage, *ring_mesh.coupling, simulation);
  save(effect, id, folder);
  return effect;
}

std::vector<std::string> ring_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const auto& ring : scene.rings) names.push_back(ring.name);
  return names;
}

std::vector<std::pair<std::string, double>> timings_of(const RunResult& result, const StageTimers& timers) {
  double mesh = 0, condense = 0, contact = 0;
  const auto add = [&](const MeshResult& r) {
    if (r.reused || !r.model.computed()) return;
    mesh += r.fact("mesh_seconds");
    condense += r.fact("condense_seconds");
    contact += r.fact("contact_seconds");
  };
  add(result.sun_mesh);
  for (const auto& ring : result.rings) add(ring.mesh);
  double total = 0;
  for (const auto& [stage, seconds] : timers.report()) {
    if (stage == "total") total = seconds;
  }
  const double dynamics = timers.seconds("dynamics"), studies = timers.seconds("studies");
  return {{"mesh", mesh},       {"condense", condense},
          {"contact", contact}, {"dynamics", dynamics},
          {"studies", studies}, {"other", std::max(0.0, total - mesh - condense - contact - dynamics - studies)},
          {"total", total}};
}

}  // namespace

fem::LoadedMeshResult solve_contact(const MeshModel& model, const RunOptions& options) {
  const int threads = options.threads;
  const auto costs = CostModel::of_this_machine();
  Progress progress(model.label(), costs.predict(mesh_size(model, threads, costs)).seconds);
  fem::LoadedMeshSettings settings = model.settings;
  settings.threads = threads;
  settings.store = options.store;
  settings.want_fields = !options.for_study;
  settings.progress = [&](double fraction) { progress.update(fraction); };
  progress.update(0);
  auto solved = fem::solve_loaded_mesh(*model.problem, settings);
  std::string teeth;
  if (solved.reused_teeth > 0)
    teeth = fmt::format(" ({} of {} teeth reused)", solved.reused_teeth, solved.reused_teeth + solved.condensed_teeth);
  progress.finish(
      fmt::format("{} positions, {} unknowns per pair of sectors; mesh {:.2f} s, condense {:.2f} s{}, contact {:.2f} s",
                  solved.positions.size(), solved.unknowns, solved.mesh_seconds, solved.condense_seconds, teeth,
                  solved.contact_seconds));
  count_reuse(options, condensed_teeth, solved.reused_teeth, solved.condensed_teeth);
  return solved;
}

MeshResult computed_stiffness(const MeshModel& model, const std::vector<std::string>& folders,
                              const RunOptions& options) {
  std::optional<MeshResult> result;
  std::filesystem::path source;
  for (const auto& folder : folders) {
    for (const auto& root : {options.out, options.tables.value_or(options.out)}) {
      if (result) continue;
      result = load(model, root / folder);
      source = root / folder;
    }
  }
  note_reuse(options, model.label(), result.has_value());
  if (options.for_study) count_reuse(options, study_meshes, result ? 1 : 0, result ? 0 : 1);
  if (result) {
    log::info(fmt::format("{}: unchanged, reused", model.label()));
    for (const auto& folder : folders) copy_meshes(model, source / "mesh", options.out / folder / "mesh");
  } else {
    const auto solved = solve_contact(model, options);
    result = pack(model, solved);
    for (const auto& folder : folders) write_meshes(model, solved, options.out / folder / "mesh");
  }
  for (const auto& folder : folders) save(*result, options.out / folder);
  return std::move(*result);
}

MeshResult mesh_stiffness(const Scene& scene, const GearGeometry& geometry, const MeshModel& model,
                          const std::vector<std::string>& rings, const RunOptions& options) {
  const bool sun = model.mesh == sun_planet;
  if (!model.computed()) {
    const auto& pair = sun ? geometry.sun_mesh() : geometry.rings.front().set.ring_mesh();
    return given_stiffness(model, sun ? scene.sun_planet : scene.ring_planet, scene, pair.contact_ratio(),
                           geometry.operating_point.mean_mesh_force);
  }
  auto result = [&] {
    try {
      return computed_stiffness(model, rings, options);
    } catch (const InputError& error) {  // what only the solve tells, with its place
      const std::string what = sun ? "sun" : "ring '" + model.ring + "'";
      throw InputError(with_place(scene, what + ": " + error.what()));
    }
  }();
  if (options.with_dynamics && may_be_coupled(scene, model)) {
    result.coupling = std::make_shared<SolvedCoupling>(solve_coupling(
        scene, geometry, model, 1 / result.mean_stiffness().value, options, options.out / rings.front()));
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
  auto kept = load_response(id, folder);
  note_reuse(options, fmt::format("dynamics of '{}'", name), kept.has_value());
  if (kept) {
    log::info(fmt::format("dynamics of '{}': unchanged, reused", name));
    return std::move(*kept);
  }
  const auto make = [&](const MeshResult& sun, const MeshResult& wheel) {
    return make_stage(scene, geometry, ring, sun, wheel);
  };
  auto response = simulate_and_save(stage, simulation, {make, sun_mesh, ring_mesh}, id, folder);
  const auto& f = response.figures;
  if (f.total_cycles == 0)
    log::info(fmt::format("dynamics of '{}': periodic steady state, solved directly", name));
  else
    log::info(fmt::format("dynamics of '{}': {} mesh cycles, {} steps, {}", name, f.total_cycles, f.statistics.steps,
                          f.steady ? "periodic steady state" : "no periodic steady state"));
  if (f.direct && !f.confirmed && f.total_cycles > 0)
    log::info(fmt::format("dynamics of '{}': found by marching; {}", name,
                          f.direct->converged ? fmt::format("the direct solution differs (half its samples by {:.1e})",
                                                            f.direct->sampling_difference)
                                              : "the direct solution failed: " + f.direct->trouble));
  return response;
}

RunResult run(const Scene& scene, const RunOptions& given) {
  StageTimers timers;
  const RunOptions options = with_reuse(given);
  std::optional<Reference> reference;
  if (scene.reference) reference = read_reference(file_of_scene(scene, "reference", *scene.reference));
  GearGeometry geometry = make_geometry(scene);
  if (options.with_dynamics) check_studies(scene);  // before anything expensive
  Plan plan = make_plan(scene, geometry, options.threads);
  if (options.remodel) std::transform(plan.meshes.begin(), plan.meshes.end(), plan.meshes.begin(), options.remodel);
  auto sun_mesh = mesh_stiffness(scene, geometry, plan.meshes.front(), ring_names(scene), options);
  RunResult result{
      .scene = scene, .geometry = std::move(geometry), .plan = std::move(plan), .sun_mesh = std::move(sun_mesh)};
  result.reference = std::move(reference);
  for (std::size_t i = 0; i < scene.rings.size(); ++i) {
    const auto& name = scene.rings[i].name;
    result.rings.push_back({name, mesh_stiffness(scene, result.geometry, result.plan.meshes[i + 1], {name}, options)});
  }
  if (options.with_dynamics && scene.dynamics) {
    const auto timer = timers.measure("dynamics");
    for_each_task(scene.rings.size(), options.threads, [&](std::size_t i) {
      auto& ring = result.rings[i];
      StageTimers response_timers;
      {
        const auto response_timer = response_timers.measure("response");
        ring.response = dynamic_response(scene, result.geometry, i, result.sun_mesh, ring.mesh, options);
        ring.coupling_effect = effect_of_coupling(scene, result.geometry, i, result.sun_mesh, ring.mesh, options);
      }
      ring.response_seconds = response_timers.seconds("response");
    });
  }
  if (options.with_dynamics) {
    const auto timer = timers.measure("studies");
    result.studies = run_studies(PlanetarySubject(result, options));
  }
  result.reuse = options.reuse;
  result.timings = timings_of(result, timers);
  result.peak_memory_MB = peak_memory_MB();
  result.cost = actual_costs(result);
  keep_costs(result.cost);
  std::filesystem::create_directories(options.out);
  write_file(options.out / "summary.json", summary_json(result));
  write_report(options.out / "report.html", stage_report(result));
  return result;
}

}  // namespace annulus::app
