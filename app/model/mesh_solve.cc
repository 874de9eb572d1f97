#include "app/model/mesh_solve.h"

#include <fmt/format.h>

#include "app/plan/cost_plan.h"
#include "app/process/progress.h"
#include "app/results/cached_files.h"
#include "app/results/content_id.h"
#include "core/log.h"
#include "core/result_store.h"

namespace annulus::app {

namespace {

constexpr const char *cached_meshes = "meshes", *cached_fields = "mesh_fields";

/// Of all that the files of a mesh depend on. Pictures name the ring; studies go without fields.
std::string files_id(const MeshModel& model, const RunOptions& options) {
  return ContentId()
      .add("inputs", model.id())
      .add("mesh", model.mesh)
      .add("ring", model.ring)
      .add("fields", options.for_study ? 0 : 1)
      .id();
}

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

}  // namespace

fem::LoadedMeshResult solve_contact(const MeshModel& model, const RunOptions& options) {
  const int threads = options.threads;
  Progress progress(model.label(), machine_pace() * predicted_cost(mesh_size(model), threads).seconds);
  fem::LoadedMeshSettings settings = model.settings;
  settings.threads = threads;
  settings.store = options.store;
  settings.recovery = options.for_study ? fem::Recovery::stresses : fem::Recovery::fields;
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

std::optional<MeshResult> cached_stiffness(const MeshModel& model, const std::string& folder,
                                           const RunOptions& options) {
  const auto* store = options.store.get();
  const auto id = files_id(model, options);
  const auto fields = store ? store->find(cached_fields, id) : std::nullopt;
  if (!fields || !restore_files(store, cached_meshes, id, options.out / folder)) return std::nullopt;
  auto result = load(model, options.out / folder);
  result.fields = unpacked(*fields);
  return result;
}

MeshResult computed_stiffness(const MeshModel& model, const std::string& folder, const RunOptions& options) {
  auto result = cached_stiffness(model, folder, options);
  note_reuse(options, model.label(), result.has_value());
  if (options.for_study) count_reuse(options, study_meshes, result ? 1 : 0, result ? 0 : 1);
  if (result) {
    log::info(fmt::format("{}: unchanged, reused", model.label()));
    return std::move(*result);
  }
  const auto solved = solve_contact(model, options);
  result = pack(model, solved);
  write_meshes(model, solved, options.out / folder / "mesh");
  save(*result, options.out / folder);
  if (const auto* store = options.store.get()) {
    const auto id = files_id(model, options);
    store->keep(cached_fields, id, packed(result->fields));
    cache_files(store, cached_meshes, id, options.out / folder, mesh_files(model));
  }
  return std::move(*result);
}

}  // namespace annulus::app
