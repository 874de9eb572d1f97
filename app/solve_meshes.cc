#include <fmt/format.h>

#include "app/pipeline.h"
#include "app/plan/cost_plan.h"
#include "app/progress.h"
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

}  // namespace annulus::app
