#include "app/systems/two_k_v/two_k_v_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/model/cost_actual.h"
#include "app/model/mesh_figures.h"
#include "app/results/cached_files.h"
#include "app/run/pipeline.h"
#include "core/files.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "dynamics/systems/two_k_v/two_k_v_figures.h"

namespace annulus::app {

namespace {

constexpr const char *compared_folder = "computed", *cached_motions = "responses";

void write_arc_table(const Scene& scene, const MeshResult& arc, const std::filesystem::path& folder) {
  if (scene.arc_pins.stiffness != StiffnessShape::computed) return;
  std::filesystem::create_directories(folder);
  arc.table.write_csv(folder / "stiffness_arc_pins.csv");
}

/// Modes and statics of a case.
void vibrate(TwoKVCase& c, const std::vector<double>& published, const std::filesystem::path& folder) {
  const Stopwatch watch;
  c.stage = make_two_k_v(c.scene, c.tables, dynamics::LoadDependence::nominal);
  c.vibration = vibration_of(*c.stage, c.scene.arc_gear.clearance, published);
  write_vibration(*c.vibration, folder / "dynamics");
  c.response_seconds = watch.seconds();
}

/// The model of a case as a function of the tables of its meshes. Every evaluation shoots for the periodic motion
/// as the nominal one does.
dynamics::TabulatedModel errors_in(const TwoKVCase& c, dynamics::SimulationOptions simulation) {
  simulation.keep_series = false;
  simulation.estimate_error = false;
  const auto stage = make_two_k_v(c.scene, c.tables, c.scene.dynamics->load_dependence);
  const bool sun = std::holds_alternative<dynamics::TableStiffness>(stage.sun_mesh),
             arc = std::holds_alternative<dynamics::TableStiffness>(stage.arc_mesh);
  dynamics::TabulatedModel model{
      .meshes = {}, .evaluate = {}, .seeks_steady_state = !simulation.mesh_cycles, .nominal_alike = true};
  if (sun) model.meshes.push_back({"sun mesh", c.tables.sun.table, c.tables.sun.mean_stiffness().parts});
  if (arc) model.meshes.push_back({"arc mesh", c.tables.arc.table, c.tables.arc.mean_stiffness().parts});
  model.evaluate = [&c, simulation, sun, arc](const std::vector<StiffnessTable>& changed) {
    auto tables = c.tables;
    if (sun) tables.sun.table = changed.front();
    if (arc) tables.arc.table = changed.back();
    const auto models = two_k_v_models(c.scene, tables);
    return evaluation_of(models, dynamics::simulate(models.moving, simulation));
  };
  return model;
}

TwoKVMotion motion_in(const TwoKVCase& c, const RunOptions& options, const std::string& folder) {
  const auto out = options.out / folder / "dynamics";
  const auto models = two_k_v_models(c.scene, c.tables);
  const auto simulation = two_k_v_simulation(c.scene, models.moving);
  const auto id = two_k_v_id(models, simulation, c.tables);
  const std::string name = folder.empty() ? "dynamics" : "dynamics with computed stiffness";
  const bool cached = restore_files(options.store.get(), cached_motions, id, out);
  note_reuse(options, name, cached);
  if (cached) {
    log::info(name + ": unchanged, reused");
    return load_two_k_v(out);
  }
  auto motion = simulate_two_k_v(models, simulation, errors_in(c, simulation), id, out);
  cache_files(options.store.get(), cached_motions, id, out, two_k_v_files());
  log::info(fmt::format("{}: {} turns of the crank, {}", name, motion.crank_turns,
                        motion.steady ? "periodic steady state" : "no periodic steady state"));
  return motion;
}

}  // namespace

MeshResult two_k_v_stiffness(const Scene& scene, const MeshModel& sun, const std::string& folder,
                             const RunOptions& options) {
  return sun.computed() ? computed_stiffness(sun, folder, options) : given_sun_result(scene, sun);
}

TwoKVResult::TwoKVResult(const Scene& of) : arc(arc_tooth_mesh(of)), own{.scene = of, .tables = {}} { scene = of; }

void TwoKVResult::solve_meshes(const RunOptions& options) {
  auto other = compared_scene(scene);
  own.tables = {two_k_v_stiffness(scene, two_k_v_sun_model(scene), "", options), arc_pins_result(scene)};
  write_arc_table(scene, own.tables.arc, options.out);
  if (!other) return;
  const bool same_sun = other->sun_planet.stiffness == scene.sun_planet.stiffness;
  TwoKVTables tables{
      same_sun ? own.tables.sun : two_k_v_stiffness(*other, two_k_v_sun_model(*other), compared_folder, options),
      arc_pins_result(*other)};
  computed = TwoKVCase{.scene = std::move(*other), .tables = std::move(tables)};
  write_arc_table(computed->scene, computed->tables.arc, options.out / compared_folder);
}

void TwoKVResult::respond(const RunOptions& options) {
  const auto folder = [&](const TwoKVCase& c) { return &c == &own ? options.out : options.out / compared_folder; };
  std::vector<TwoKVCase*> cases = {&own};
  if (computed) cases.push_back(&*computed);
  {
    const auto timer = timers.measure("modes");
    std::vector<double> published;
    if (reference)
      for (const auto& value : reference->values)
        if (value.quantity == "frequency_1_Hz") published.push_back(value.value);
    for (auto* c : cases) vibrate(*c, published, folder(*c));
  }
  const auto timer = timers.measure("dynamics");
  for_each_task(cases.size(), options.threads, [&](std::size_t i) {
    auto& c = *cases[i];
    const Stopwatch watch;
    c.motion = motion_in(c, options, i == 0 ? "" : compared_folder);
    c.response_seconds += watch.seconds();
  });
}

std::vector<const MeshResult*> TwoKVResult::meshes() const {
  std::vector<const MeshResult*> list = {&own.tables.sun};
  if (computed && !own.tables.sun.model.computed()) list.push_back(&computed->tables.sun);
  return list;
}

std::vector<VariantFigures> TwoKVResult::variants() const {
  std::vector<VariantFigures> list;
  const auto add = [&](const char* name, const TwoKVCase& c) {
    FigureSet set = mesh_figures(c.tables.sun);
    set.add(mesh_figures(c.tables.arc));
    if (c.motion) set.add(c.motion->results);
    list.push_back({name, std::move(set)});
  };
  add("", own);
  if (computed) add("computed stiffness", *computed);
  return list;
}

std::optional<CostRun> TwoKVResult::actual(const CostStep& step) const {
  const auto& other_case = computed ? *computed : own;
  if (step.kind == CostKind::mesh) return actual_mesh(step.size, other_case.tables.sun);
  const auto& c = step.ring.empty() ? own : other_case;
  if (!c.motion || c.motion->reused) return std::nullopt;
  return actual_time(step.size, c.response_seconds);
}

TwoKVResult run_two_k_v(const Scene& scene, const RunOptions& options) {
  TwoKVResult result(scene);
  run_system(result, options);
  return result;
}

const std::vector<FigureSpec>& two_k_v_run_figures() {
  static const auto list = [] {
    auto specs = mesh_figure_specs(sun_planet, "sun mesh", "sun_stiffness", {"planet", "sun"});
    const auto arc = mesh_figure_specs(arc_pins, "arc mesh", "arc_stiffness");
    specs.insert(specs.end(), arc.begin(), arc.end());
    const auto& model = dynamics::two_k_v_figures();
    specs.insert(specs.end(), model.begin(), model.end());
    return specs;
  }();
  return list;
}

}  // namespace annulus::app
