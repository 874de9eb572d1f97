#include "app/systems/planetary/planetary_subject.h"
#include "app/systems/planetary/rim_coupling.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/content_id.h"
#include "app/pipeline.h"
#include "app/study/study_cases.h"
#include "core/log.h"
#include "dynamics/systems/planetary/initial_spread.h"
#include "dynamics/systems/planetary/planetary_figures.h"

namespace annulus::app {

std::vector<MeshModel> mesh_models(const Scene& scene, const GearGeometry& geometry) {
  std::vector<MeshModel> models = {sun_mesh_model(scene, geometry)};
  for (std::size_t i = 0; i < scene.rings.size(); ++i) models.push_back(ring_mesh_model(scene, geometry, i));
  return models;
}

namespace {

StudyPoint point_of(const ChangedStage& changed, bool quick) {
  auto f = dynamics::evaluate_point(changed.stage, {.simulation = changed.simulation, .motion = !quick});
  auto figures = dynamics::figures(f);
  if (!quick) figures.add(dynamics::motion_figures(f));
  return {.figures = {dynamics::planetary_figures(), figures}, .poincare = std::move(f.poincare)};
}

}  // namespace

std::vector<std::string> PlanetarySubject::variants() const {
  std::vector<std::string> names;
  for (const auto& ring : nominal_.rings) names.push_back(ring.name);
  return names;
}

FigureSet PlanetarySubject::nominal(std::size_t ring) const {
  const auto& response = nominal_.rings.at(ring).response;
  return response ? dynamics::figures(response->figures) : FigureSet{};
}

const MeshResult& PlanetarySubject::nominal_mesh(std::size_t mesh) const {
  return mesh == 0 ? nominal_.sun_mesh : nominal_.rings.at(mesh - 1).mesh;
}

bool PlanetarySubject::prepare(const std::vector<Override>& overrides, const std::string& where,
                               const std::string& folder) const {
  const auto scene = with_overrides(nominal_.scene, overrides);
  const auto geometry = make_geometry(scene);
  const auto models = mesh_models(scene, geometry);
  bool any = false;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (table_serves(nominal_mesh(i).model, models[i], geometry.operating_point.mean_mesh_force)) continue;
    any = true;
    const auto inside = options_in(folder);
    const bool coupled = may_be_coupled(scene, models[i]);
    if (const auto cached = cached_stiffness(models[i], models[i].ring, inside);
        cached && (!coupled || cached_coupling(scene, geometry, models[i], 1 / cached->mean_stiffness().value, inside,
                                               inside.out / models[i].ring))) {
      count_reuse(inside, study_meshes, 1, 0);
      continue;
    }
    log::info(where + ":");
    (void)mesh_stiffness(scene, geometry, models[i], inside);
  }
  return any;
}

ChangedStage PlanetarySubject::stage(const std::vector<Override>& overrides, const std::string& where, std::size_t ring,
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
      kept[which] = changed_mesh(nominal.model, model, force, folder);
      if (!kept[which]) continue;
      if (which == 1 && may_be_coupled(scene, model)) {
        kept[which]->coupling = std::make_shared<SolvedCoupling>(load_coupling(
            scene, geometry, model, 1 / kept[which]->mean_stiffness().value, options_in(folder).out / model.ring));
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

ChangedModel PlanetarySubject::model(const std::vector<Override>& overrides, const std::string& where, std::size_t ring,
                                     const std::string& folder, bool with_id) const {
  auto changed = stage(overrides, where, ring, folder, with_id);
  const std::string id =
      with_id ? ContentId().add("response", changed.id).add("method", dynamics::point_method()).id() : std::string();
  return {id, [changed = std::move(changed)](bool quick) { return point_of(changed, quick); }};
}

std::optional<StartSpread> PlanetarySubject::starts(const std::vector<Override>& overrides, const std::string& where,
                                                    std::size_t ring, const std::string& folder, int count,
                                                    int seed) const {
  const auto changed = stage(overrides, where, ring, folder, false);
  const auto spread = dynamics::initial_spread(
      changed.stage,
      {.random_starts = count - 1, .seed = static_cast<std::uint64_t>(seed), .simulation = changed.simulation});
  const auto& specs = dynamics::planetary_figures();
  StartSpread result{.starts = count, .motions = spread.attractors, .not_steady = spread.unsteady};
  for (const auto& start : spread.starts) {
    const FigureRow row(specs,
                        dynamics::figures(dynamics::PointFigures{start.sun_planet, start.ring_planet, start.steady}));
    if (result.low.empty()) result.low = result.high = row;
    for (const auto& spec : specs) {
      result.low.set(spec.key, std::min(result.low.value(spec.key), row.value(spec.key)));
      result.high.set(spec.key, std::max(result.high.value(spec.key), row.value(spec.key)));
    }
  }
  return result;
}

}  // namespace annulus::app
