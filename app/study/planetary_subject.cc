#include "app/study/planetary_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "app/content_id.h"
#include "app/study/study_cases.h"
#include "core/log.h"
#include "dynamics/systems/planetary/initial_spread.h"

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

namespace {

constexpr std::size_t listed_frequencies = 6;

void append(std::vector<double>& row, const dynamics::KindFigures& f) {
  row.insert(row.end(), {f.averaged, f.instantaneous, f.quasi_static, f.dynamic_factor, f.contact_loss});
}

StudyPoint point_of(const ChangedStage& changed, bool quick) {
  auto f = dynamics::evaluate_point(changed.stage, {.simulation = changed.simulation, .motion = !quick});
  StudyPoint point;
  append(point.values, f.sun_planet);
  append(point.values, f.ring_planet);
  point.values.push_back(f.steady ? 1 : 0);
  if (!quick) {
    for (const auto* m : {&f.sun, &f.sun_mesh, &f.ring_mesh})
      point.values.insert(point.values.end(), {m->rms, m->peak_to_peak});
    for (std::size_t i = 0; i < listed_frequencies; ++i)
      point.values.push_back(i < f.frequencies.size() ? f.frequencies[i] : std::numeric_limits<double>::quiet_NaN());
    point.poincare = std::move(f.poincare);
  }
  return point;
}

/// The one of the branch with the largest dynamic factor.
Figure largest_factor(const dynamics::MeshKindResult& kind) {
  return std::max_element(
             kind.branches.begin(), kind.branches.end(),
             [](const auto& a, const auto& b) { return a.dynamic_factor_max.value < b.dynamic_factor_max.value; })
      ->dynamic_factor_max;
}

}  // namespace

std::vector<StudyFigure> planetary_figures() {
  constexpr const char* share = "N F / ΣF";
  constexpr const char* factor = "largest F / mean mesh force";
  std::vector<StudyFigure> list;
  for (const std::string mesh : {"sun", "ring"}) {
    const std::string column = mesh + "_planet_", of = " of the " + mesh + " meshes";
    list.push_back({.column = column + "load_sharing_averaged",
                    .title = "Load sharing" + of + ", averaged over a mesh cycle",
                    .label = share,
                    .plotted = true,
                    .spread = true,
                    .ordering = true,
                    .with = column + "load_sharing_quasi_static"});
    list.push_back({.column = column + "load_sharing_instantaneous",
                    .title = "Load sharing" + of + ", instantaneous",
                    .label = share,
                    .spread = true});
    list.push_back({.column = column + "load_sharing_quasi_static",
                    .title = "Load sharing" + of + ", quasi-static",
                    .label = share,
                    .spread = true});
    list.push_back({.column = column + "dynamic_factor",
                    .title = "Dynamic factor" + of,
                    .label = factor,
                    .plotted = true,
                    .spread = true,
                    .ordering = mesh == "sun"});
    list.push_back({.column = column + "contact_loss",
                    .title = "Time without contact, " + mesh + " meshes",
                    .label = "worst planet, %",
                    .scale = 100,
                    .plotted = true});
  }
  list.push_back({.column = "steady", .title = "Periodic"});
  for (const auto& [column, title] : {std::pair{"sun", "Motion of the sun"},
                                      {"sun_planet_deflection", "Deflection of the sun mesh"},
                                      {"ring_planet_deflection", "Deflection of the ring mesh"}}) {
    const bool sun = std::string(column) == "sun", ring_mesh = std::string(column).starts_with("ring");
    list.push_back({.column = std::string(column) + "_rms_m",
                    .title = title,
                    .label = "rms, µm",
                    .scale = 1e6,
                    .quick = false,
                    .plotted = sun});
    list.push_back({.column = std::string(column) + "_peak_to_peak_m",
                    .title = title,
                    .label = "peak to peak, µm",
                    .scale = 1e6,
                    .quick = false,
                    .plotted = ring_mesh});
  }
  for (std::size_t i = 1; i <= listed_frequencies; ++i)
    list.push_back({.column = fmt::format("frequency_{}_Hz", i),
                    .title = fmt::format("Natural frequency {}", i),
                    .label = "Hz",
                    .quick = false});
  return list;
}

std::vector<std::string> PlanetarySubject::variants() const {
  std::vector<std::string> names;
  for (const auto& ring : nominal_.rings) names.push_back(ring.name);
  return names;
}

NominalFigures PlanetarySubject::nominal(std::size_t ring) const {
  NominalFigures figures;
  const auto& response = nominal_.rings.at(ring).response;
  if (!response) return figures;
  for (const auto& [mesh, kind] :
       {std::pair{"sun_planet_", &response->figures.sun_planet}, {"ring_planet_", &response->figures.ring_planet}}) {
    const std::string column = mesh;
    figures[column + "load_sharing_averaged"] = kind->load_sharing.averaged;
    figures[column + "load_sharing_instantaneous"] = kind->load_sharing.instantaneous;
    figures[column + "load_sharing_quasi_static"] = kind->load_sharing.quasi_static;
    figures[column + "dynamic_factor"] = largest_factor(*kind);
  }
  return figures;
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
    // The sun mesh is kept with the first ring.
    const auto& ring = scene.rings[i == 0 ? 0 : i - 1].name;
    const auto inside = options_in(folder);
    const bool coupled = may_be_coupled(scene, models[i]);
    if (const auto kept = load(models[i], inside.out / ring);
        kept &&
        (!coupled || load_coupling(scene, geometry, models[i], 1 / kept->mean_stiffness().value, inside.out / ring))) {
      count_reuse(inside, study_meshes, 1, 0);
      continue;
    }
    log::info(where + ":");
    (void)mesh_stiffness(scene, geometry, models[i], {ring}, inside);
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
  StartSpread result{
      .starts = count, .motions = spread.attractors, .low = {}, .high = {}, .not_steady = spread.unsteady};
  for (const auto& start : spread.starts) {
    std::vector<double> row;
    append(row, start.sun_planet);
    append(row, start.ring_planet);
    row.push_back(start.steady ? 1 : 0);
    if (result.low.empty()) result.low = result.high = row;
    for (std::size_t i = 0; i < row.size(); ++i) {
      result.low[i] = std::min(result.low[i], row[i]);
      result.high[i] = std::max(result.high[i], row[i]);
    }
  }
  return result;
}

}  // namespace annulus::app
