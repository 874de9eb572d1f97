#include "app/systems/helical_pair/pair_stiffness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/model/excitation.h"
#include "app/model/mesh_solve.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/helical_pair/pair_space.h"
#include "app/systems/shared/faces.h"
#include "app/systems/shared/mesh_names.h"
#include "core/errors.h"
#include "core/not_known.h"
#include "fem/closed_form/helical_table.h"

namespace annulus::app {

namespace {

constexpr double steel_single_stiffness = 14e9;  // c' of [ISO6336-1], Pa

GearMesh external_pair(const Scene& scene, const PairGeometry& geometry) {
  return {.mesh = pinion_wheel,
          .title = "mesh of pinion and wheel",
          .pair = geometry.gears,
          .input = helical_pair(scene).pinion_wheel,
          .pinion = helical_pair(scene).pinion,
          .wheel = helical_pair(scene).wheel,
          .pinion_name = "pinion",
          .wheel_name = "wheel",
          .wheel_support_diameter = helical_pair(scene).wheel.bore_diameter,
          .misalignment = helical_pair(scene).errors.pinion_wheel_misalignment,
          .mean_force = geometry.transverse_force,
          .why_it_tilts = why_gears_tilt(scene, geometry)};
}

double mean_secant(const StiffnessTable& table, double load) {
  return curves_at_load(table, load).stiffness_secant.mean();
}

}  // namespace

MeshModel pair_mesh_model(const Scene& scene, const PairGeometry& geometry) {
  auto model = mesh_model(scene, external_pair(scene, geometry));
  const auto asked = [&](const char* fidelity, const char* what, const char* shape) {
    model.fidelity = fidelity;
    model.reason = fmt::format("{} (stiffness = \"{}\")", what, shape);
  };
  if (helical_pair(scene).pinion_wheel.stiffness == StiffnessShape::iso_6336)
    asked("formula", "ISO 6336-1, method B", "iso_6336");
  if (helical_pair(scene).pinion_wheel.stiffness == StiffnessShape::closed_form)
    asked("closed_form", "tooth formulas of the transverse section, staggered along the helix", "closed_form");
  return model;
}

std::string pair_solid_reason(const Scene& scene, const PairGeometry& geometry) {
  return solid_reason(scene, external_pair(scene, geometry));
}

double iso_pair_stiffness(const Scene& scene, const PairGeometry& geometry) {
  return dynamics::iso_6336_mesh_stiffness(
      {geometry.gears.common_face().width, geometry.gears.contact_ratio(), scene.stage.helix_angle,
       helical_pair(scene).pinion_wheel.single_stiffness.value_or(steel_single_stiffness)});
}

std::string no_closed_form(const Scene& scene, const PairGeometry& geometry) {
  auto why = fem::no_helical_closed_form(geometry.pinion().parameters(), geometry.wheel().parameters(),
                                         helical_pair(scene).errors.pinion_wheel_misalignment);
  if (!why.empty()) return why;
  if (!helical_pair(scene).pinion.bore_diameter || !helical_pair(scene).wheel.bore_diameter)
    return "it needs bore_diameter_mm of both gears";
  return helical_pair(scene).stage.pinion_torque == 0 ? "it needs a torque" : "";
}

StiffnessTable closed_form_pair_table(const Scene& scene, const PairGeometry& geometry, double transverse_force) {
  if (const auto why = no_closed_form(scene, geometry); !why.empty()) throw InputError("no closed form: " + why);
  const auto face = geometry.gears.common_face();
  fem::LoadedMeshProblem problem{
      .pair = geometry.gears,
      .materials = {material_of(scene, helical_pair(scene).pinion), material_of(scene, helical_pair(scene).wheel)},
      .face_width = face.width,
      .pinion_bore_radius = *helical_pair(scene).pinion.bore_diameter / 2,
      .wheel_support_radius = *helical_pair(scene).wheel.bore_diameter / 2,
      .pinion_overhang = face.pinion,
      .wheel_overhang = face.wheel,
      .phases = 64,
      .name = pinion_wheel};
  for (const double factor : fem::table_load_factors) problem.loads.push_back(factor * transverse_force);
  return fem::helical_closed_form(problem);
}

MeshResult pair_stiffness(const Scene& scene, const PairGeometry& geometry, const MeshModel& model,
                          const RunOptions& options) {
  const auto& input = helical_pair(scene).pinion_wheel;
  if (model.computed()) {
    auto result = computed_stiffness(model, "", options);
    if (options.with_dynamics && scene.dynamics && pair_in_space(scene))
      result.face = face_in_motion(result, geometry.transverse_force, options);
    return result;
  }
  if (input.stiffness == StiffnessShape::closed_form)
    return {.model = model,
            .table = closed_form_pair_table(scene, geometry, geometry.transverse_force),
            .nominal = fem::nominal_load_index};
  if (input.stiffness == StiffnessShape::table)
    return prescribed_stiffness(model, input, scene, geometry.gears.contact_ratio(), geometry.transverse_force);
  return {.model = model, .table = {}, .tabulated = false};
}

PairMesh::PairMesh(const MeshResult& mesh) : model(mesh.model) {
  if (model.computed()) computed = mesh;
  if (mesh.tabulated) table = mesh.table;
}

dynamics::MeshExcitation pair_excitation(const Scene& scene, const PairGeometry& geometry,
                                         const StiffnessTable& table) {
  auto input = helical_pair(scene).pinion_wheel;
  if (input.stiffness == StiffnessShape::iso_6336) {
    input.mean = iso_pair_stiffness(scene, geometry);
    input.stiffness = input.ripple.value_or(0) == 0 ? StiffnessShape::constant : StiffnessShape::harmonic;
  }
  MeshResult mesh;
  if (table.phases() > 0) mesh.table = fem::along_normal(table, geometry.base_helix_angle);
  return excitation_of(input, mesh, geometry.transverse_force / std::cos(geometry.base_helix_angle),
                       scene.dynamics->load_dependence, geometry.gears.back_flank_phase());
}

std::vector<MeanStiffness> mean_stiffnesses(const Scene& scene, const PairGeometry& geometry, const PairMesh& mesh) {
  const auto shape = helical_pair(scene).pinion_wheel.stiffness;
  std::vector<MeanStiffness> list;
  list.push_back({"iso_6336", iso_pair_stiffness(scene, geometry), not_known,
                  "ISO 6336-1 method B: c′ cos β (0.75 ε_α + 0.25) b", shape == StiffnessShape::iso_6336});
  MeanStiffness closed{"closed_form", not_known, not_known, no_closed_form(scene, geometry),
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
                         "not computed; set stiffness = \"computed\" in [mesh.pinion_wheel] to compute it",
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
    double value = helical_pair(scene).pinion_wheel.mean.value_or(0);
    if (mesh.table) {
      const auto& loads = mesh.table->loads();
      value = geometry.to_normal() *
              mean_secant(*mesh.table, std::clamp(geometry.transverse_force, loads.front(), loads.back()));
    }
    list.push_back({"prescribed", value, not_known, mesh.model.reason, true});
  }
  return list;
}

}  // namespace annulus::app
