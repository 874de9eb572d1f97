#include "app/model/mesh_solve.h"

#include <fmt/format.h>

#include <optional>

#include "app/model/field_files.h"
#include "app/plan/cost_plan.h"
#include "app/process/held_limits.h"
#include "app/process/progress.h"
#include "app/results/cached_value.h"
#include "core/file_guard.h"
#include "core/log.h"
#include "geometry/vtu_file.h"

namespace annulus::app {

namespace {

constexpr const char* cached_meshes = "meshes";

/// All that the result of a mesh depends on. Pictures name the variant; studies go without fields.
std::string result_id(const MeshModel& model, const RunOptions& options) {
  return identity_of(model.id(), model.mesh, model.variant, options.for_study);
}

/// The .msh and .vtu files of both bodies and of their fields, written into `folder`; nothing for those that the
/// solution does not have.
FileSet body_files(const MeshModel& model, const fem::LoadedMeshResult& solved, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::vector<std::string> names;
  const auto file = [&](const std::string& name) {
    names.push_back(name);
    remove_file(folder / name);
    return folder / name;
  };
  for (const auto& [mesh, body] :
       {std::pair{&solved.pinion_sector, model.pinion_body}, {&solved.wheel_sector, model.wheel_body}}) {
    const auto stem = model.mesh + "_" + body;
    const auto msh = file(stem + ".msh"), vtu = file(stem + ".vtu");
    if (mesh->cells.empty()) continue;  // a closed form meshes nothing
    geometry::write_msh(*mesh, msh);
    geometry::write_vtu(*mesh, vtu);
  }
  const auto fields = model.mesh + "_field";
  for (const auto& name : field_file_names(model, fields)) (void)file(name);
  if (!solved.fields.empty()) write_field_files(model, solved, folder, {fields});
  return read_files(folder, names);
}

}  // namespace

fem::LoadedMeshResult solve_contact(const MeshModel& model, const RunOptions& options, fem::Recovery recovery) {
  const int threads = options.threads;
  // Formulas take a fraction of a second: the study that asks for them has a progress of its own.
  std::optional<Progress> progress;
  if (!options.for_study || model.has_elements())
    progress.emplace(model.label(), machine_pace() * predicted_cost(mesh_size(model), threads).seconds);
  const auto update = [&](double fraction) {
    if (progress) progress->update(fraction);
  };
  fem::LoadedMeshSettings settings = model.settings;
  settings.threads = threads;
  settings.store = options.store;
  settings.recovery = recovery;
  settings.progress = update;
  settings.before_level = [&](int degree, int level) {
    check_held_memory(
        peak_memory(level_size(model, degree, level), threads),
        fmt::format("{} elements of level {} of the {}", degree == 1 ? "linear" : "quadratic", level, model.label()),
        "ask for less accuracy (accuracy), fewer threads (--threads) or another model (model)");
  };
  update(0);
  auto solved = fem::solve_loaded_mesh(*model.problem, settings);
  std::string teeth;
  if (solved.reused_teeth > 0)
    teeth = fmt::format(" ({} of {} teeth reused)", solved.reused_teeth, solved.reused_teeth + solved.condensed_teeth);
  if (progress)
    progress->finish(fmt::format(
        "{} positions, {} unknowns per pair of sectors; mesh {:.2f} s, condense {:.2f} s{}, contact {:.2f} s",
        solved.positions.size(), solved.unknowns, solved.mesh_seconds, solved.condense_seconds, teeth,
        solved.contact_seconds));
  count_reuse(options, condensed_teeth, solved.reused_teeth, solved.condensed_teeth);
  return solved;
}

MeshResult solved_stiffness(const MeshModel& model, const std::filesystem::path& folder, const RunOptions& options) {
  const auto solved =
      solve_contact(model, options, options.for_study ? fem::Recovery::stresses : fem::Recovery::fields);
  auto result = pack(model, solved);
  result.bodies = body_files(model, solved, folder / "mesh");
  save(result, folder);
  return result;
}

MeshResult computed_stiffness(const MeshModel& model, const std::string& folder, const RunOptions& options) {
  const auto out = options.out / folder;
  auto [result, reused] = cached_value(options.store.get(), cached_meshes, result_id(model, options),
                                       [&] { return solved_stiffness(model, out, options); });
  note_reuse(options, model.label(), source_of(reused));
  if (options.for_study) count_reuse(options, study_meshes, reused ? 1 : 0, reused ? 0 : 1);
  result.model = model;
  if (reused) log::info(fmt::format("{}: unchanged, reused", model.label()));
  if (options.times == Times::left_out) leave_out_course_of_solve(result);
  if (reused || options.times == Times::left_out) save(result, out);
  result.reused = reused;
  result.bodies.clear();
  return std::move(result);
}

}  // namespace annulus::app
