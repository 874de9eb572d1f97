#include "app/systems/helical_pair/pair_stiffness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/model/excitation.h"
#include "app/model/mesh_solve.h"
#include "core/errors.h"
#include "core/not_known.h"

namespace annulus::app {

namespace {

constexpr double steel_single_stiffness = 14e9;  // c' of ISO 6336-1, Pa

ExternalMesh external_pair(const Scene& scene, const PairGeometry& geometry) {
  return {.mesh = pinion_wheel,
          .pair = geometry.gears,
          .input = scene.pinion_wheel,
          .planet = scene.pinion,
          .wheel = scene.wheel,
          .planet_name = "pinion",
          .wheel_name = "wheel",
          .misalignment = scene.errors.pinion_wheel_misalignment,
          .mean_force = geometry.transverse_force};
}

/// The same teeth as a spur gear: module, pressure angle and shift of the transverse section.
geometry::Gear transverse_section(const geometry::Gear& gear) {
  auto p = gear.parameters();
  const double c = std::cos(p.helix_angle);
  p.module = gear.transverse_module();
  p.pressure_angle = gear.transverse_pressure_angle();
  p.profile_shift *= c;
  p.root_fillet_factor *= c;
  p.tip_diameter = 2 * gear.tip_radius();
  p.root_diameter = 2 * gear.root_radius();
  p.helix_angle = 0;
  return geometry::Gear(p);
}

bool modified(const GearInput& gear) {
  return gear.tip_relief != 0 || gear.profile_crowning != 0 || gear.lead_crowning != 0 || gear.lead_slope != 0;
}

double mean_secant(const StiffnessTable& table, double load) {
  return curves_at_load(table, load).stiffness_secant.mean();
}

}  // namespace

MeshModel pair_mesh_model(const Scene& scene, const PairGeometry& geometry) {
  auto model = external_mesh_model(scene, external_pair(scene, geometry));
  const auto asked = [&](const char* fidelity, const char* what, const char* shape) {
    model.fidelity = fidelity;
    model.reason = fmt::format("{} (stiffness = \"{}\")", what, shape);
  };
  if (scene.pinion_wheel.stiffness == StiffnessShape::iso_6336) asked("formula", "ISO 6336-1, method B", "iso_6336");
  if (scene.pinion_wheel.stiffness == StiffnessShape::closed_form)
    asked("closed_form", "tooth formulas of the transverse section, staggered along the helix", "closed_form");
  return model;
}

std::string pair_solid_reason(const Scene& scene, const PairGeometry& geometry) {
  return solid_reason(scene, external_pair(scene, geometry));
}

double iso_pair_stiffness(const Scene& scene, const PairGeometry& geometry) {
  return dynamics::iso_6336_mesh_stiffness({scene.stage.face_width, geometry.gears.contact_ratio(),
                                            scene.stage.helix_angle,
                                            scene.pinion_wheel.single_stiffness.value_or(steel_single_stiffness)});
}

std::string no_closed_form(const Scene& scene) {
  if (modified(scene.pinion) || modified(scene.wheel)) return "flanks with modifications have no closed form here";
  if (scene.errors.pinion_wheel_misalignment != 0) return "misaligned flanks have no closed form";
  if (!scene.pinion.bore_diameter || !scene.wheel.bore_diameter) return "it needs bore_diameter_mm of both gears";
  if (scene.stage.pinion_torque == 0) return "it needs a torque";
  return "";
}

StiffnessTable closed_form_pair_table(const Scene& scene, const PairGeometry& geometry, double transverse_force) {
  if (const auto why = no_closed_form(scene); !why.empty()) throw InputError("no closed form: " + why);
  constexpr int phases = 64, slices = 64;
  fem::LoadedMeshProblem problem{
      .pair = geometry::GearPair(transverse_section(geometry.pinion()), transverse_section(geometry.wheel()),
                                 geometry.gears.centre_distance()),
      .material = {scene.material.youngs_modulus, scene.material.poisson_ratio, scene.material.density},
      .face_width = scene.stage.face_width,
      .planet_bore_radius = *scene.pinion.bore_diameter / 2,
      .wheel_support_radius = *scene.wheel.bore_diameter / 2,
      .phases = phases};
  for (const double factor : table_load_factors) problem.loads.push_back(factor * transverse_force);
  fem::LoadedMeshSettings settings;
  settings.fidelity = fem::Fidelity::closed_form;
  const auto spur = fem::solve_loaded_mesh(problem, settings).table;
  const double overlap = geometry.gears.overlap_ratio();
  const auto loads = static_cast<int>(spur.loads().size());
  std::vector<StiffnessEntry> entries(static_cast<std::size_t>(phases * loads));
  for (int load = 0; load < loads; ++load) {
    std::vector<double> secant, tangent;
    for (int i = 0; i < phases; ++i) {
      secant.push_back(spur.at(0, i, load).stiffness_secant);
      tangent.push_back(spur.at(0, i, load).stiffness_tangent);
    }
    const PeriodicCurve secants(secant, phases), tangents(tangent, phases);
    for (int i = 0; i < phases; ++i) {
      StiffnessEntry e;
      for (int j = 0; j < slices; ++j) {
        const double cycles = static_cast<double>(i) / phases + overlap * ((j + 0.5) / slices - 0.5);
        e.stiffness_secant += secants(cycles) / slices;
        e.stiffness_tangent += tangents(cycles) / slices;
      }
      e.lte = spur.loads()[static_cast<std::size_t>(load)] / e.stiffness_secant;
      e.error_relative = spur.at(0, i, load).error_relative;
      e.error_parts = spur.at(0, i, load).error_parts;
      entries[static_cast<std::size_t>(i) * static_cast<std::size_t>(loads) + static_cast<std::size_t>(load)] = e;
    }
  }
  return {pinion_wheel, phases, {0.0}, spur.loads(), std::move(entries)};
}

StiffnessTable along_normal(const StiffnessTable& transverse, double base_helix_angle) {
  const double c = std::cos(base_helix_angle);
  auto loads = transverse.loads();
  for (auto& load : loads) load /= c;
  std::vector<StiffnessEntry> entries;
  for (int position = 0; position < transverse.positions(); ++position) {
    for (int phase = 0; phase < transverse.phases(); ++phase) {
      for (int load = 0; load < static_cast<int>(loads.size()); ++load) {
        auto e = transverse.at(position, phase, load);
        e.unloaded_te *= c;
        e.lte *= c;
        e.stiffness_secant /= c * c;
        e.stiffness_tangent /= c * c;
        entries.push_back(e);
      }
    }
  }
  return {transverse.mesh(), transverse.phases(), transverse.ring_angles(), std::move(loads), std::move(entries)};
}

MeshResult pair_stiffness(const Scene& scene, const PairGeometry& geometry, const MeshModel& model,
                          const RunOptions& options) {
  const auto& input = scene.pinion_wheel;
  if (model.computed()) return computed_stiffness(model, "", options);
  if (input.stiffness == StiffnessShape::closed_form)
    return {.model = model,
            .table = closed_form_pair_table(scene, geometry, geometry.transverse_force),
            .nominal = nominal_load_index};
  if (input.stiffness == StiffnessShape::table)
    return given_stiffness(model, input, scene, geometry.gears.contact_ratio(), geometry.transverse_force);
  return {.model = model, .table = {}, .tabulated = false};
}

PairMesh::PairMesh(const MeshResult& mesh) : model(mesh.model) {
  if (model.computed()) computed = mesh;
  if (mesh.tabulated) table = mesh.table;
}

dynamics::MeshExcitation pair_excitation(const Scene& scene, const PairGeometry& geometry,
                                         const StiffnessTable& table) {
  auto input = scene.pinion_wheel;
  if (input.stiffness == StiffnessShape::iso_6336) {
    input.mean = iso_pair_stiffness(scene, geometry);
    input.stiffness = input.ripple.value_or(0) == 0 ? StiffnessShape::constant : StiffnessShape::harmonic;
  }
  MeshResult mesh;
  if (table.phases() > 0) mesh.table = along_normal(table, geometry.base_helix_angle);
  return excitation_of(input, mesh, geometry.transverse_force / std::cos(geometry.base_helix_angle),
                       scene.dynamics->load_dependence);
}

std::vector<MeanStiffness> mean_stiffnesses(const Scene& scene, const PairGeometry& geometry, const PairMesh& mesh) {
  const auto shape = scene.pinion_wheel.stiffness;
  std::vector<MeanStiffness> list;
  list.push_back({"iso_6336", iso_pair_stiffness(scene, geometry), not_known,
                  "ISO 6336-1 method B: c′ cos β (0.75 ε_α + 0.25) b", shape == StiffnessShape::iso_6336});
  MeanStiffness closed{"closed_form", not_known, not_known, no_closed_form(scene),
                       shape == StiffnessShape::closed_form};
  if (closed.note.empty()) {
    const auto table = closed.taken ? *mesh.table : closed_form_pair_table(scene, geometry, geometry.transverse_force);
    closed.value = geometry.to_normal() * mean_secant(table, geometry.transverse_force);
    closed.note = "tooth cantilevers, rims and line contact of the transverse section, staggered along the helix";
  } else {
    closed.note = "not available: " + closed.note;
  }
  list.push_back(closed);
  MeanStiffness computed{"computed", not_known, not_known,
                         "not solved here; stiffness = \"computed\" in [mesh.pinion_wheel] asks for it",
                         shape == StiffnessShape::computed};
  if (mesh.computed) {
    const auto mean = mesh.computed->mean_stiffness();
    computed.value = geometry.to_normal() * mean.value;
    computed.error_relative = mean.error_relative;
    computed.note =
        fmt::format("finite elements ({}), mean over {} phases", mesh.model.fidelity, mesh.computed->table.phases());
  }
  list.push_back(computed);
  if (std::none_of(list.begin(), list.end(), [](const auto& s) { return s.taken; })) {
    double value = scene.pinion_wheel.mean.value_or(0);
    if (mesh.table) {
      const auto& loads = mesh.table->loads();
      value = geometry.to_normal() *
              mean_secant(*mesh.table, std::clamp(geometry.transverse_force, loads.front(), loads.back()));
    }
    list.push_back({"given", value, not_known, mesh.model.reason, true});
  }
  return list;
}

}  // namespace annulus::app
