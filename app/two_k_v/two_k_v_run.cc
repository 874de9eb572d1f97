#include "app/two_k_v/two_k_v_run.h"
#include "app/report/page.h"
#include "app/report/two_k_v/reducer_report_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/plan/cost_actual.h"
#include "app/scene/scene_files.h"
#include "app/study/planetary_subject.h"
#include "app/study/studies.h"
#include "app/tasks.h"
#include "app/two_k_v/two_k_v_subject.h"
#include "core/files.h"
#include "core/log.h"

namespace annulus::app {

namespace {

constexpr const char* compared_folder = "computed";

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

MeshResult sun_result(const Scene& scene, const std::string& folder, const RunOptions& options) {
  const auto model = two_k_v_sun_model(scene);
  if (model.computed()) return computed_stiffness(model, {folder}, options);
  return given_sun_result(scene, model);
}

void write_arc_table(const Scene& scene, const MeshResult& arc, const std::filesystem::path& folder) {
  if (scene.arc_pins.stiffness != StiffnessShape::computed) return;
  std::filesystem::create_directories(folder);
  arc.table.write_csv(folder / "stiffness_arc_pins.csv");
}

/// Without the motion.
TwoKVCase make_case(Scene scene, MeshResult sun, const std::vector<double>& published, const RunOptions& options,
                    const std::string& folder) {
  auto arc = arc_pins_result(scene);
  TwoKVCase c{.scene = std::move(scene), .tables = {std::move(sun), std::move(arc)}};
  write_arc_table(c.scene, c.tables.arc, options.out / folder);
  if (!options.with_dynamics || !c.scene.dynamics) return c;
  const auto start = std::chrono::steady_clock::now();
  c.stage = make_two_k_v(c.scene, c.tables, dynamics::LoadDependence::nominal);
  c.vibration = vibration_of(*c.stage, c.scene.arc_gear.clearance, published);
  write_vibration(*c.vibration, options.out / folder / "dynamics");
  c.response_seconds = seconds_since(start);
  return c;
}

TwoKVMotion motion_in(const TwoKVCase& c, const RunOptions& options, const std::string& folder) {
  const auto out = options.out / folder / "dynamics";
  const auto stage = make_two_k_v(c.scene, c.tables, c.scene.dynamics->load_dependence);
  const auto simulation = two_k_v_simulation(c.scene, stage);
  const auto id = two_k_v_id(stage, simulation, c.tables);
  const std::string name = folder.empty() ? "dynamics" : "dynamics with computed stiffness";
  auto kept = load_two_k_v(id, out);
  note_reuse(options, name, kept.has_value());
  if (kept) {
    log::info(name + ": unchanged, reused");
    return std::move(*kept);
  }
  auto motion = simulate_two_k_v(stage, simulation, id, out);
  log::info(fmt::format("{}: {} turns of the crank, {}", name, motion.crank_turns,
                        motion.steady ? "periodic steady state" : "no periodic steady state"));
  return motion;
}

std::vector<std::pair<std::string, double>> two_k_v_timings(const TwoKVResult& result, const StageTimers& timers) {
  double mesh = 0, condense = 0, contact = 0;
  const auto add = [&](const TwoKVCase& c) {
    const auto& sun = c.tables.sun;
    if (sun.reused || !sun.model.computed()) return;
    mesh += sun.fact("mesh_seconds");
    condense += sun.fact("condense_seconds");
    contact += sun.fact("contact_seconds");
  };
  add(result.own);
  if (result.computed && !result.own.tables.sun.model.computed()) add(*result.computed);
  double total = 0;
  for (const auto& [stage, seconds] : timers.report())
    if (stage == "total") total = seconds;
  const double modes = timers.seconds("modes"), dynamics = timers.seconds("dynamics"),
               studies = timers.seconds("studies");
  return {{"mesh", mesh},
          {"condense", condense},
          {"contact", contact},
          {"modes", modes},
          {"dynamics", dynamics},
          {"studies", studies},
          {"other", std::max(0.0, total - mesh - condense - contact - modes - dynamics - studies)},
          {"total", total}};
}

}  // namespace

TwoKVResult run_two_k_v(const Scene& scene, const RunOptions& given) {
  StageTimers timers;
  const RunOptions options = with_reuse(given);
  std::optional<Reference> reference;
  if (scene.reference) reference = read_reference(file_of_scene(scene, "reference", *scene.reference));
  if (options.with_dynamics) check_studies(scene);  // before anything expensive
  Plan plan = make_two_k_v_plan(scene, options.threads);
  auto other = compared_scene(scene);
  auto sun = sun_result(scene, "", options);
  std::optional<MeshResult> other_sun;
  if (other)
    other_sun =
        other->sun_planet.stiffness == scene.sun_planet.stiffness ? sun : sun_result(*other, compared_folder, options);
  std::optional<TwoKVCase> own, computed;
  {
    const auto timer = timers.measure("modes");
    std::vector<double> published;
    if (reference)
      for (const auto& value : reference->values)
        if (value.quantity == "frequency_1_Hz") published.push_back(value.value);
    own = make_case(scene, std::move(sun), published, options, "");
    if (other) computed = make_case(std::move(*other), std::move(*other_sun), published, options, compared_folder);
  }
  TwoKVResult result{.plan = std::move(plan), .arc = arc_tooth_mesh(scene), .own = std::move(*own)};
  result.computed = std::move(computed);
  result.reference = std::move(reference);
  if (options.with_dynamics && scene.dynamics) {
    const auto timer = timers.measure("dynamics");
    for_each_task(result.computed ? 2 : 1, options.threads, [&](std::size_t i) {
      auto& c = i == 0 ? result.own : *result.computed;
      const auto start = std::chrono::steady_clock::now();
      c.motion = motion_in(c, options, i == 0 ? "" : compared_folder);
      c.response_seconds += seconds_since(start);
    });
  }
  if (options.with_dynamics) {
    const auto timer = timers.measure("studies");
    const auto& c = result.own;
    result.studies = run_studies(TwoKVSubject(c.scene, c.tables, c.motion ? &*c.motion : nullptr, options));
  }
  result.reuse = options.reuse;
  result.timings = two_k_v_timings(result, timers);
  result.peak_memory_MB = peak_memory_MB();
  result.cost = actual_costs(result.plan.cost, [&](const CostStep& step) -> std::optional<CostRun> {
    const auto& other_case = result.computed ? *result.computed : result.own;
    if (step.kind == CostKind::mesh) return actual_mesh(step.size, other_case.tables.sun);
    const auto& c = step.ring.empty() ? result.own : other_case;
    if (!c.motion || c.motion->reused) return std::nullopt;
    return actual_time(step.size, c.response_seconds);
  });
  keep_costs(result.cost);
  std::filesystem::create_directories(options.out);
  write_file(options.out / "summary.json", two_k_v_summary(result));
  write_report(options.out / "report.html", reducer_report(result));
  return result;
}

std::vector<std::string> two_k_v_tables_to_solve(const Scene& nominal, const Scene& changed) {
  const auto before = two_k_v_sun_model(nominal), after = two_k_v_sun_model(changed);
  if (table_serves(before, after, two_k_v_kinematics(changed).mean_sun_mesh_force())) return {};
  return {after.label()};
}

double two_k_v_seconds(const Scene& scene) {
  // Measured: shooting over one crank turn and two windows of some thousand samples.
  constexpr double one_turn = 2;
  return one_turn + two_k_v_marching_seconds(scene);
}

}  // namespace annulus::app
