#include "app/systems/helical_pair/pair_subject.h"

#include "app/content_id.h"
#include "app/study/study_cases.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

/// How responses of studies are found; enters the identity of cached results.
constexpr const char* pair_point_method = "harmonic balance, time integration where contact is lost; 1";

}  // namespace

FigureSet PairSubject::nominal(std::size_t /*variant*/) const {
  return nominal_.response ? dynamics::figures(nominal_.response->figures) : FigureSet{};
}

bool PairSubject::prepare(const std::vector<Override>& overrides, const std::string& where,
                          const std::string& folder) const {
  const auto changed = with_overrides(nominal_.scene, overrides);
  const auto geometry = make_pair_geometry(changed);
  return prepare_mesh(nominal_.mesh.model, pair_mesh_model(changed, geometry), geometry.transverse_force, where,
                      folder);
}

ChangedModel PairSubject::model(const std::vector<Override>& overrides, const std::string& where,
                                std::size_t /*variant*/, const std::string& folder, bool with_id) const {
  try {
    const auto changed = with_overrides(nominal_.scene, overrides);
    const auto geometry = make_pair_geometry(changed);
    const auto mesh_model = pair_mesh_model(changed, geometry);
    std::optional<MeshResult> solved;
    if (mesh_model.computed()) {
      solved = changed_mesh(nominal_.mesh.model, mesh_model, geometry.transverse_force, folder);
      if (!solved) solved = nominal_.mesh.computed;
    }
    const auto mesh = pair_mesh(changed, geometry, mesh_model, std::move(solved));
    const auto errors = pair_errors(changed, &nominal_.errors);
    auto pair = make_pair(changed, geometry, pair_excitation(changed, geometry, mesh), errors.amplitude);
    auto simulation = pair_simulation(changed);
    simulation.confirm = false;
    simulation.keep_series = false;
    std::string id;
    if (with_id)
      id = ContentId()
               .add("response", pair_id(pair, simulation, mesh.table ? &*mesh.table : nullptr))
               .add("method", pair_point_method)
               .id();
    return {id, [pair = std::move(pair), simulation](bool quick) {
              auto figures = dynamics::figures(dynamics::evaluate_pair(pair, simulation));
              if (!quick) figures.add(dynamics::frequency_figures(pair));
              return StudyPoint{.figures = {dynamics::pair_figures(), figures}};
            }};
  } catch (const InputError&) {
    rethrow_at(nominal_.scene, where);
  }
}

}  // namespace annulus::app
