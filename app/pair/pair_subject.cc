#include "app/pair/pair_subject.h"

#include <fmt/format.h>

#include <limits>

#include "app/content_id.h"
#include "app/study/planetary_subject.h"
#include "app/study/study_cases.h"
#include "core/errors.h"
#include "core/log.h"

namespace annulus::app {

namespace {

constexpr std::size_t listed_pair_frequencies = 5;  // six DOFs turn freely together

/// How responses of studies are found; enters the identity of kept results.
constexpr const char* pair_point_method = "harmonic balance, marching where teeth part; 1";

}  // namespace

std::vector<StudyFigure> pair_figures() {
  std::vector<StudyFigure> list;
  list.push_back({.column = "acceleration_max_m_per_s2",
                  .title = "Largest acceleration of the teeth",
                  .label = "m/s²",
                  .plotted = true,
                  .spread = true,
                  .ordering = true});
  list.push_back({.column = "acceleration_line_of_action_m_per_s2",
                  .title = "Largest acceleration of the axes along the line of action",
                  .label = "m/s²"});
  list.push_back({.column = "acceleration_axial_m_per_s2", .title = "Largest axial acceleration", .label = "m/s²"});
  list.push_back({.column = "acceleration_rotation_m_per_s2",
                  .title = "Largest acceleration of the base circles",
                  .label = "m/s²"});
  list.push_back({.column = "mesh_force_max_N",
                  .title = "Largest mesh force",
                  .label = "kN",
                  .scale = 1e-3,
                  .plotted = true,
                  .spread = true});
  list.push_back({.column = "mesh_force_min_N", .title = "Smallest mesh force", .label = "kN", .scale = 1e-3});
  list.push_back({.column = "dynamic_factor",
                  .title = "Dynamic factor",
                  .label = "largest force / static force",
                  .plotted = true,
                  .spread = true,
                  .ordering = true});
  list.push_back(
      {.column = "contact_loss", .title = "Time without contact", .label = "%", .scale = 100, .plotted = true});
  list.push_back({.column = "transmission_error_max_m",
                  .title = "Largest transmission error",
                  .label = "µm",
                  .scale = 1e6,
                  .plotted = true,
                  .spread = true,
                  .with = "transmission_error_static_max_m"});
  list.push_back({.column = "transmission_error_peak_to_peak_m",
                  .title = "Transmission error, peak to peak",
                  .label = "µm",
                  .scale = 1e6,
                  .plotted = true,
                  .spread = true,
                  .ordering = true,
                  .with = "transmission_error_static_peak_to_peak_m"});
  list.push_back(
      {.column = "transmission_error_mean_m", .title = "Transmission error, mean", .label = "µm", .scale = 1e6});
  list.push_back({.column = "transmission_error_static_max_m",
                  .title = "Largest transmission error, quasi-static",
                  .label = "µm",
                  .scale = 1e6});
  list.push_back({.column = "transmission_error_static_peak_to_peak_m",
                  .title = "Transmission error, peak to peak, quasi-static",
                  .label = "µm",
                  .scale = 1e6});
  list.push_back({.column = "relative_motion_max_m",
                  .title = "Largest relative motion with the bending of shafts and bearings",
                  .label = "µm",
                  .scale = 1e6});
  list.push_back({.column = "relative_motion_peak_to_peak_m",
                  .title = "Relative motion with the bending of shafts and bearings, peak to peak",
                  .label = "µm",
                  .scale = 1e6});
  list.push_back({.column = "steady", .title = "Periodic"});
  for (std::size_t i = 1; i <= listed_pair_frequencies; ++i)
    list.push_back({.column = fmt::format("frequency_{}_Hz", i),
                    .title = fmt::format("Natural frequency {}", i),
                    .label = "Hz",
                    .quick = false});
  return list;
}

std::vector<double> pair_frequencies(const dynamics::HelicalPair& pair) {
  std::vector<double> list;
  for (const auto& mode : dynamics::modes(pair).modes) {
    if (mode.frequency > 0) list.push_back(mode.frequency);
  }
  return list;
}

std::vector<double> pair_figure_values(const dynamics::PairResponse& r, const std::vector<double>& frequencies) {
  const auto& te = r.dynamic.transmission_error;
  const auto& still = r.quasi_static.transmission_error;
  const auto force = loaded_force(r);
  std::vector<double> values = {r.acceleration.tooth.value,
                                r.acceleration.line_of_action.value,
                                r.acceleration.axial.value,
                                r.acceleration.rotation.value,
                                force.largest.value,
                                force.smallest.value,
                                r.dynamic_factor.value,
                                r.contact_loss,
                                te.largest.value,
                                te.peak_to_peak.value,
                                te.mean,
                                still.largest.value,
                                still.peak_to_peak.value,
                                r.dynamic.relative.largest.value,
                                r.dynamic.relative.peak_to_peak.value,
                                r.steady ? 1.0 : 0.0};
  for (std::size_t i = 0; i < listed_pair_frequencies; ++i)
    values.push_back(i < frequencies.size() ? frequencies[i] : std::numeric_limits<double>::quiet_NaN());
  return values;
}

NominalFigures PairSubject::nominal(std::size_t /*variant*/) const {
  if (!nominal_.response) return {};
  const auto& r = nominal_.response->figures;
  const auto& te = r.dynamic.transmission_error;
  const auto force = loaded_force(r);
  return {{"acceleration_max_m_per_s2", r.acceleration.tooth},
          {"mesh_force_max_N", force.largest},
          {"mesh_force_min_N", force.smallest},
          {"dynamic_factor", r.dynamic_factor},
          {"transmission_error_max_m", te.largest},
          {"transmission_error_peak_to_peak_m", te.peak_to_peak}};
}

bool PairSubject::table_serves_pair(const MeshModel& changed, const PairGeometry& geometry) const {
  return table_serves(nominal_.mesh.model, changed, geometry.transverse_force);
}

bool PairSubject::prepare(const std::vector<Override>& overrides, const std::string& where,
                          const std::string& folder) const {
  const auto changed = with_overrides(nominal_.scene, overrides);
  const auto geometry = make_pair_geometry(changed);
  const auto model = pair_mesh_model(changed, geometry);
  if (table_serves_pair(model, geometry)) return false;
  const auto inside = options_in(folder);
  if (load(model, inside.out)) {
    count_reuse(inside, study_meshes, 1, 0);
    return true;
  }
  log::info(where + ":");
  (void)computed_stiffness(model, {""}, inside);
  return true;
}

ChangedModel PairSubject::model(const std::vector<Override>& overrides, const std::string& where,
                                std::size_t /*variant*/, const std::string& folder, bool with_id) const {
  try {
    const auto changed = with_overrides(nominal_.scene, overrides);
    const auto geometry = make_pair_geometry(changed);
    const auto mesh_model = pair_mesh_model(changed, geometry);
    std::optional<MeshResult> solved;
    if (mesh_model.computed()) {
      if (table_serves_pair(mesh_model, geometry)) {
        solved = nominal_.mesh.computed;
      } else if (folder.empty()) {
        throw InputError(fmt::format("the mesh is not tabulated for a mesh force of {} kN",
                                     to_text(geometry.transverse_force / 1e3, 5)));
      } else {
        solved = load(mesh_model, options_in(folder).out);
        if (!solved) throw InternalError("internal error: a changed scene without its stiffness table");
      }
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
              StudyPoint point;
              point.values = pair_figure_values(dynamics::evaluate_pair(pair, simulation),
                                                quick ? std::vector<double>{} : pair_frequencies(pair));
              return point;
            }};
  } catch (const InputError&) {
    rethrow_at(nominal_.scene, where);
  }
}

}  // namespace annulus::app
