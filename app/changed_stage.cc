#include "app/changed_stage.h"

#include <fmt/format.h>

#include "core/log.h"

namespace annulus::app {

std::vector<MeshModel> mesh_models(const Scene& scene, const GearGeometry& geometry) {
  std::vector<MeshModel> models = {sun_mesh_model(scene, geometry)};
  for (std::size_t i = 0; i < scene.rings.size(); ++i) models.push_back(ring_mesh_model(scene, geometry, i));
  return models;
}

bool table_serves(const MeshModel& nominal, const MeshModel& changed, double mean_mesh_force) {
  if (!nominal.computed() || !changed.computed()) return nominal.computed() == changed.computed();
  const auto& loads = nominal.problem->loads;
  if (mean_mesh_force < loads.front() || mean_mesh_force > loads.back()) return false;
  MeshModel same_loads = changed;
  same_loads.problem->loads = loads;
  return same_loads.id() == nominal.id();
}

void rethrow_at(const Scene& scene, const std::string& where) {
  try {
    throw;
  } catch (const SceneError& error) {
    throw InputError(scene.file.string() + ": " + where + ": " + error.problems().front().message);
  } catch (const InputError& error) {
    throw InputError(scene.file.string() + ": " + where + ": " + error.what());
  }
}

ChangedScene change_scene(const Scene& scene, const StudyCase& study_case) {
  try {
    Scene changed = with_overrides(scene, study_case.overrides);
    GearGeometry geometry = make_geometry(changed);
    return {std::move(changed), std::move(geometry)};
  } catch (const InputError&) {
    rethrow_at(scene, study_case.where);
  }
}

const MeshResult& ChangedStages::nominal_mesh(std::size_t mesh) const {
  return mesh == 0 ? nominal_.sun_mesh : nominal_.rings.at(mesh - 1).mesh;
}

RunOptions ChangedStages::options_in(const std::string& folder) const {
  RunOptions inside = options_;
  inside.out = options_.out / folder;
  if (options_.tables) inside.tables = *options_.tables / folder;
  return inside;
}

bool ChangedStages::prepare(const std::vector<Override>& overrides, const std::string& where,
                            const std::string& folder) const {
  const auto scene = with_overrides(nominal_.scene, overrides);
  const auto geometry = make_geometry(scene);
  const auto models = mesh_models(scene, geometry);
  bool any = false;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (table_serves(nominal_mesh(i).model, models[i], geometry.operating_point.mean_mesh_force)) continue;
    any = true;
    // The sun mesh is kept with the first ring.
    const auto& ring = scene.rings[i == 0 ? 0 : i - 1].name;
    const auto inside = options_in(folder);
    const bool coupled = may_be_coupled(scene, models[i]);
    if (const auto kept = load(models[i], inside.out / ring);
        kept &&
        (!coupled || load_coupling(scene, geometry, models[i], 1 / kept->mean_stiffness().value, inside.out / ring)))
      continue;
    log::info(where + ":");
    (void)mesh_stiffness(scene, geometry, models[i], {ring}, inside);
  }
  return any;
}

ChangedStage ChangedStages::stage(const std::vector<Override>& overrides, const std::string& where, std::size_t ring,
                                  const std::string& folder, bool with_id) const {
  try {
    const auto scene = with_overrides(nominal_.scene, overrides);
    const auto geometry = make_geometry(scene);
    const double force = geometry.operating_point.mean_mesh_force;
    std::optional<MeshResult> kept[2];
    const MeshResult* tables[2];
    for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
      const auto model = which == 0 ? sun_mesh_model(scene, geometry) : ring_mesh_model(scene, geometry, ring);
      const auto& nominal = nominal_mesh(which == 0 ? 0 : ring + 1);
      tables[which] = &nominal;
      if (table_serves(nominal.model, model, force)) continue;
      if (folder.empty())
        throw InputError(fmt::format("the {} is not tabulated for a mean mesh force of {} kN", model.label(),
                                     to_text(force / 1e3, 5)));
      kept[which] = load(model, options_in(folder).out / scene.rings[which == 0 ? 0 : ring].name);
      if (!kept[which]) throw InternalError("internal error: a changed scene without its stiffness tables");
      if (which == 1 && may_be_coupled(scene, model)) {
        auto coupling = load_coupling(scene, geometry, model, 1 / kept[which]->mean_stiffness().value,
                                      options_in(folder).out / scene.rings[ring].name);
        if (!coupling) throw InternalError("internal error: a changed scene without the coupling of its ring");
        kept[which]->coupling = std::make_shared<SolvedCoupling>(std::move(*coupling));
      }
      tables[which] = &*kept[which];
    }
    ChangedStage changed{make_stage(scene, geometry, ring, *tables[0], *tables[1]), {}, {}};
    changed.simulation = simulation_options(scene, changed.stage);
    if (with_id) changed.id = response_id(changed.stage, changed.simulation, *tables[0], *tables[1]);
    return changed;
  } catch (const InputError&) {
    rethrow_at(nominal_.scene, where);
  }
}

}  // namespace annulus::app
