#include "app/systems/two_k_v/two_k_v_run.h"

#include <fmt/format.h>

#include "app/results/cached_value.h"
#include "app/run/pipeline.h"
#include "app/systems/shared/mesh_names.h"
#include "app/systems/shared/sun_planet_input.h"
#include "app/systems/two_k_v/two_k_v_members.h"
#include "core/log.h"

namespace annulus::app {

namespace {

constexpr const char *compared_folder = "computed", *cached_motions = "responses";

/// Whether both scenes take the sun mesh from the same source.
bool same_sun(const Scene& a, const Scene& b) {
  return sun_and_planets(a).sun_planet.stiffness == sun_and_planets(b).sun_planet.stiffness;
}

}  // namespace

std::vector<MeshModel> two_k_v_run_meshes(const Scene& scene) {
  std::vector<MeshModel> list = {two_k_v_sun_model(scene), arc_pins_model(scene)};
  if (const auto other = compared_scene(scene)) {
    list.push_back(arc_pins_model(*other));
    if (!same_sun(*other, scene)) list.push_back(two_k_v_sun_model(*other));
  }
  return list;
}

std::vector<RunVariant> two_k_v_run_variants(const Scene& scene) {
  std::vector<RunVariant> list = {{"", "", {0, 1}}};
  if (const auto other = compared_scene(scene))
    list.push_back({"computed stiffness", compared_folder, {same_sun(*other, scene) ? std::size_t{0} : 3, 2}});
  return list;
}

MeshResult two_k_v_stiffness(const Scene& scene, const MeshModel& mesh, const RunOptions& options) {
  if (mesh.mesh == arc_pins)
    return arc_pins_result(mesh.fidelity == arc_pins_model(scene).fidelity ? scene : *compared_scene(scene));
  if (!mesh.computed()) return prescribed_sun_result(scene, mesh);
  return computed_stiffness(mesh, two_k_v_sun_model(scene).computed() ? "" : compared_folder, options);
}

std::unique_ptr<TwoKVResponse> two_k_v_response(const Scene& scene, const RunVariant& variant,
                                                const std::vector<const MeshResult*>& tables,
                                                const std::vector<double>& published, const RunOptions& options) {
  const TwoKVTables both{*tables.front(), *tables.back()};
  const auto models = two_k_v_models(scene, both);
  const auto folder = options.out / variant.folder / "dynamics";
  auto result = std::make_unique<TwoKVResponse>();
  result->vibration = vibration_of(models.at_nominal, models.arc_clearance, published);
  write_vibration(result->vibration, folder);
  auto simulation = two_k_v_simulation(scene, models.moving);
  simulation.other_motions.threads = options.threads;
  const auto id = two_k_v_id(models, simulation, both);
  auto [motion, reused] =
      cached_value(options.store.get(), cached_motions, id, [&] { return simulate_two_k_v(scene, both, simulation); });
  const std::string name = variant.name.empty() ? "dynamics" : "dynamics with " + variant.name;
  note_reuse(options, name, source_of(reused));
  save(motion, id, folder);
  log::info(name + ": " +
            (reused ? "unchanged, reused"
                    : fmt::format("{} turns of the crank, {}", motion.crank_turns,
                                  motion.steady ? "periodic steady state" : "no periodic steady state")));
  motion.time_series.clear();
  motion.reused = reused;
  result->figures = motion.results;
  result->motions = motion.motions;
  result->shafts = motion.shafts;
  result->reused = reused;
  result->motion = std::move(motion);
  return result;
}

TwoKVResult::TwoKVResult(const SystemRun& of) : RunView(of), arc(arc_tooth_mesh(of.scene)) {
  const auto case_of = [&](std::size_t variant, const Scene& shown) {
    const auto tables = of.tables_of(variant);
    TwoKVCase result{.scene = shown, .tables = {*tables.front(), *tables.back()}};
    if (of.responses.empty()) return result;
    const auto& response = static_cast<const TwoKVResponse&>(*of.responses.at(variant));
    result.stage = make_two_k_v(shown, result.tables, dynamics::LoadDependence::nominal);
    result.vibration = &response.vibration;
    result.motion = &response.motion;
    return result;
  };
  own = case_of(0, scene);
  if (const auto other = compared_scene(scene)) computed = case_of(1, *other);
}

TwoKVResult run_two_k_v(const Scene& scene, const RunOptions& options) {
  return TwoKVResult(*run_system(scene, options));
}

}  // namespace annulus::app
