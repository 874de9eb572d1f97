#include "app/plan/mesh_model.h"

#include <fmt/format.h>

#include "app/results/content_id.h"
#include "fem/loaded_mesh.h"
#include "fem/problem/solved_face.h"

namespace annulus::app {

namespace {

fem::LoadedMeshProblem problem_of(const Scene& scene, const std::string& mesh, const geometry::GearPair& pair,
                                  const HubGearInput& planet) {
  return {.pair = pair,
          .material = {scene.material.youngs_modulus, scene.material.poisson_ratio, scene.material.density},
          .face_width = scene.stage.face_width,
          .planet_bore_radius = planet.bore_diameter.value_or(0) / 2,
          .name = mesh};
}

void use(MeshModel& model, fem::Fidelity fidelity) {
  model.settings.fidelity = fidelity;
  model.fidelity = fidelity_name(fidelity);
}

/// The cheapest model the mesh permits, unless the scene asks for another.
void set_fidelity(MeshModel& model, const Scene& scene, const std::string& why_solid, const std::string& why_plane) {
  const bool needs_solid = !why_solid.empty();
  const std::string& why = needs_solid ? why_solid : why_plane;
  constexpr const char* asked = "the scene asks for it (model)";
  switch (scene.fidelity) {
    case Fidelity::automatic:
      use(model, needs_solid ? fem::Fidelity::solid : fem::Fidelity::plane);
      model.reason = why;
      break;
    case Fidelity::closed_form:
      use(model, fem::Fidelity::closed_form);
      model.reason = asked;
      break;
    case Fidelity::plane:
      use(model, fem::Fidelity::plane);
      model.reason = asked;
      break;
    case Fidelity::solid:
      use(model, fem::Fidelity::solid);
      model.reason = needs_solid ? why_solid : asked;
      break;
    case Fidelity::resolved:
      use(model, needs_solid ? fem::Fidelity::resolved_solid : fem::Fidelity::resolved_plane);
      model.reason = std::string(asked) + "; " + why;
      break;
  }
}

/// Formulas do where their error, known beforehand, is within the accuracy.
void prefer_formulas(MeshModel& model, const Scene& scene) {
  if (scene.fidelity != Fidelity::automatic || model.settings.fidelity != fem::Fidelity::plane) return;
  if (scene.accuracy < fem::least_closed_form_error) return;
  const double error = fem::closed_form_error(*model.problem);
  if (error > scene.accuracy) return;
  use(model, fem::Fidelity::closed_form);
  model.reason += fmt::format("; formulas are within {:.2g} %", 100 * error);
  model.formula_error = error;
}

/// Why linear elements would be too stiff, by more than their error estimate tells: they lock where the volume hardly
/// changes, and where thin parts bend (a rim of two modules on a sleeve four times as long as thick: off by 10.2 %
/// where they say 9.3 %).
std::string unfit_for_linear(const fem::LoadedMeshProblem& problem) {
  constexpr double nearly_incompressible = 0.4, thin_rim = 2.5, slender_sleeve = 0.3;
  if (problem.material.poisson_ratio > nearly_incompressible)
    return fmt::format("linear ones are too stiff where Poisson's ratio exceeds {}", nearly_incompressible);
  const auto sleeve = problem.structure.body(problem.wheel_support_radius).sleeve;
  if (!sleeve) return "";
  const auto& gear = problem.pair.wheel();
  if (problem.wheel_support_radius - gear.root_radius() < thin_rim * gear.parameters().module ||
      sleeve->thickness < slender_sleeve * sleeve->length)
    return "linear ones are too stiff where a thin rim or a slender sleeve bends";
  return "";
}

/// Edges of single supports, sleeves and flanges that bend, and contacts slanted over the cells leave linear elements
/// more than 1 % at their first level.
bool hard_for_linear(const fem::LoadedMeshProblem& problem) {
  if (problem.pair.planet().helix_angle() != 0) return true;
  return problem.pair.internal() && !fem::held_outside(problem.structure);
}

/// What the wanted accuracy asks of a mesh whose problem is complete but for phases and loads.
void set_resolution(MeshModel& model, const Scene& scene, double mean_force) {
  model.settings.accuracy = scene.accuracy;
  model.settings.largest_deflection = 0.25;  // small displacements; what is known beforehand: small_displacements.h
  const auto& pair = model.problem->pair;
  const double uptake = load_uptake(mean_force, model.problem->face_width, pair.planet().parameters().module,
                                    model.problem->material.youngs_modulus);
  auto table = table_resolution(scene.accuracy, uptake, pair.overlap_ratio());
  model.problem->phases = table.phases;
  for (const double factor : table.load_factors) model.problem->loads.push_back(factor * mean_force);
  model.phases = std::move(table.phases_reason);
  model.loads = std::move(table.loads_reason);
  prefer_formulas(model, scene);
  const bool formulas = model.settings.fidelity == fem::Fidelity::closed_form;
  auto elements = element_choice(formulas ? fem::Fidelity::plane : model.settings.fidelity, scene.accuracy,
                                 hard_for_linear(*model.problem), unfit_for_linear(*model.problem));
  // Modes of the ring that take part need their frequencies: of linear elements they are 2 % too high where a mesh is
  // within 3 %.
  const bool modes_take_part = scene.dynamics && scene.dynamics->rim_coupling == RimCoupling::elastic;
  model.coupling_degree = modes_take_part ? 2 : elements.degree;
  if (formulas) return;
  model.settings.degree = elements.degree;
  model.elements = std::move(elements.reason);
}

/// Why a plane model suffices for a ring without a reason for a solid one; empty for others.
std::string plane_reason(const fem::RingStructure& structure) {
  const auto reason = structure.words().plane_reason;
  return reason.empty() ? "" : reason + ": nothing changes along the face width";
}

/// Why the mesh of a ring repeats after so many teeth.
std::string repeats_text(const fem::RingStructure& structure, int teeth, int positions) {
  if (!fem::on_single_supports(structure)) return "the support is the same behind every tooth: one mesh cycle suffices";
  const auto supports = structure.words().repetition;
  if (positions == teeth) return fmt::format("{} teeth on {}: no smaller rotation repeats the ring", teeth, supports);
  return fmt::format("{} teeth on {}: the ring repeats after {} teeth", teeth, supports, positions);
}

void add_reason(std::string& reasons, bool applies, const std::string& reason) {
  if (applies) reasons += (reasons.empty() ? "" : "; ") + reason;
}

bool lead_modified(const GearInput& gear) { return gear.lead_crowning != 0 || gear.lead_slope != 0; }

/// What both meshes have in common: the teeth themselves.
std::string tooth_reasons(const Scene& scene, const GearInput& planet, const std::string& planet_name,
                          const GearInput& wheel, const std::string& wheel_name, double misalignment) {
  constexpr const char* lead = "the lead of the {} is modified, so the load varies along the face width";
  std::string reasons;
  add_reason(reasons, scene.stage.helix_angle != 0,
             "helical teeth enter the contact progressively along the face width");
  add_reason(reasons, lead_modified(wheel), fmt::format(lead, wheel_name));
  add_reason(reasons, lead_modified(planet), fmt::format(lead, planet_name));
  add_reason(reasons, misalignment != 0, "the flanks are misaligned, so the load varies along the face width");
  return reasons;
}

void set_given(MeshModel& model, const std::string& shape) {
  model.fidelity = "given";
  model.reason = fmt::format("the scene gives the stiffness (mesh.{}: {})", model.mesh, shape);
  model.repeats = "as given";
}

std::string shape_text(StiffnessShape shape) {
  switch (shape) {
    case StiffnessShape::computed:
      return "computed";
    case StiffnessShape::constant:
      return "constant";
    case StiffnessShape::harmonic:
      return "harmonic";
    case StiffnessShape::rectangular:
      return "rectangular";
    case StiffnessShape::iso_6336:
      return "iso_6336";
    case StiffnessShape::closed_form:
      return "closed_form";
    case StiffnessShape::table:
      break;
  }
  return "table";
}

void add_gear(ContentId& id, const std::string& name, const geometry::Gear& gear) {
  const auto& p = gear.parameters();
  id.add(name + ".teeth", p.teeth).add(name + ".module", p.module).add(name + ".pressure_angle", p.pressure_angle);
  id.add(name + ".profile_shift", p.profile_shift).add(name + ".tip_radius", gear.tip_radius());
  id.add(name + ".root_radius", gear.root_radius()).add(name + ".root_fillet", p.root_fillet_factor);
  id.add(name + ".tip_relief", p.tip_relief).add(name + ".tip_relief_length", p.tip_relief_length);
  id.add(name + ".profile_crowning", p.profile_crowning).add(name + ".helix_angle", p.helix_angle);
  id.add(name + ".lead_crowning", p.lead_crowning).add(name + ".lead_slope", p.lead_slope);
}

void add_structure(ContentId& id, const fem::RingStructure& structure) {
  id.add("structure", structure.words().name);
  for (const auto& [name, value] : structure.parameters()) id.add(name, value);
}

Decision symmetry_decision(const fem::LoadedMeshProblem& problem, const fem::LoadedMeshSettings& settings) {
  if (fem::solved_face(problem, settings).half)
    return {"symmetry", "half of the face", "the mesh is its own mirror image about the middle of the face"};
  return {"symmetry", "whole face", settings.symmetry ? fem::asymmetry_of_face(problem) : "asked for"};
}

}  // namespace

const char* fidelity_name(fem::Fidelity fidelity) {
  switch (fidelity) {
    case fem::Fidelity::closed_form:
      return "closed_form";
    case fem::Fidelity::plane:
      return "plane";
    case fem::Fidelity::solid:
      return "solid";
    case fem::Fidelity::resolved_plane:
      return "resolved_plane";
    case fem::Fidelity::resolved_solid:
      break;
  }
  return "resolved_solid";
}

std::vector<Decision> decisions(const MeshModel& model) {
  std::vector<Decision> list = {{"model", model.fidelity, model.reason}};
  if (!model.computed()) return list;
  const auto& settings = model.settings;
  const auto& problem = *model.problem;
  const bool elements = settings.fidelity != fem::Fidelity::closed_form;
  const bool solid = fem::is_solid(settings.fidelity);
  list.push_back({"dimension", solid ? "3D" : "2D, plane strain",
                  solid ? "the face width is meshed" : "one section stands for the whole face width"});
  if (solid) list.push_back(symmetry_decision(problem, settings));
  if (elements) {
    constexpr const char* names[] = {"linear", "quadratic", "cubic"};
    list.push_back({"elements", names[settings.degree - 1], model.elements});
    list.push_back(
        settings.level
            ? Decision{"refinement", fmt::format("level {}", *settings.level), "asked for"}
            : Decision{"refinement", fmt::format("until {:g} %", 100 * settings.accuracy),
                       "cells 1.5 times smaller from level to level until two levels agree at every position"});
    list.push_back(
        {"sectors",
         fmt::format("1 of {} and 1 of {} teeth", problem.pair.planet().teeth(), problem.pair.wheel().teeth()),
         "equal teeth are condensed once and the gears composed of them"});
  }
  list.push_back({"ring positions", std::to_string(model.positions), model.repeats});
  list.push_back({"positions per mesh cycle", std::to_string(problem.phases), model.phases});
  std::string loads = to_text(problem.loads.front() / 1e3, 4) + " kN";
  if (problem.loads.size() > 1)
    loads = fmt::format("{}, {} to {} kN", problem.loads.size(), to_text(problem.loads.front() / 1e3, 4),
                        to_text(problem.loads.back() / 1e3, 4));
  list.push_back({"loads", loads, model.loads});
  return list;
}

std::string MeshModel::id() const {
  ContentId id;
  id.add("mesh", mesh).add("model", fidelity);
  if (problem) {
    add_gear(id, "planet", problem->pair.planet());
    add_gear(id, "wheel", problem->pair.wheel());
    id.add("centre_distance", problem->pair.centre_distance());
    id.add("E", problem->material.youngs_modulus).add("nu", problem->material.poisson_ratio);
    id.add("face_width", problem->face_width).add("planet_bore", problem->planet_bore_radius);
    id.add("wheel_support", problem->wheel_support_radius).add("phases", problem->phases);
    id.add("misalignment", problem->misalignment);
    for (const double load : problem->loads) id.add("load", load);
    if (problem->pair.internal()) add_structure(id, problem->structure);
    id.add("accuracy", settings.accuracy).add("degree", settings.degree).add("level", settings.level.value_or(0));
  }
  return id.id();
}

std::string MeshModel::label() const {
  if (mesh == pinion_wheel) return "mesh of pinion and wheel";
  if (mesh == arc_pins) return "mesh of arc teeth and pins";
  return ring.empty() ? "sun-planet mesh" : fmt::format("ring-planet mesh of '{}'", ring);
}

std::string solid_reason(const Scene& scene, const RingInput& ring) {
  std::string reasons;
  const std::string structure = ring_structure(ring).words().solid_reason;
  add_reason(reasons, !structure.empty(), structure);
  const std::string teeth =
      tooth_reasons(scene, scene.planet, "planet", ring, "ring", scene.errors.ring_planet_misalignment);
  add_reason(reasons, !teeth.empty(), teeth);
  return reasons;
}

std::string solid_reason(const Scene& scene) {
  return tooth_reasons(scene, scene.planet, "planet", scene.sun, "sun", scene.errors.sun_planet_misalignment);
}

std::string solid_reason(const Scene& scene, const ExternalMesh& mesh) {
  return tooth_reasons(scene, mesh.planet, mesh.planet_name, mesh.wheel, mesh.wheel_name, mesh.misalignment);
}

MeshModel external_mesh_model(const Scene& scene, const ExternalMesh& mesh) {
  MeshModel model{.mesh = mesh.mesh, .planet_body = mesh.planet_name, .wheel_body = mesh.wheel_name};
  if (mesh.input.stiffness != StiffnessShape::computed) {
    set_given(model, shape_text(mesh.input.stiffness));
    return model;
  }
  set_fidelity(
      model, scene, solid_reason(scene, mesh),
      "spur gears without lead modifications on hubs over the full width: nothing changes along the face width");
  model.repeats = "equal teeth on concentric hubs: one mesh cycle tells all";
  model.problem = problem_of(scene, model.mesh, mesh.pair, mesh.planet);
  model.problem->wheel_support_radius = mesh.wheel.bore_diameter.value_or(0) / 2;
  model.problem->misalignment = mesh.misalignment;
  set_resolution(model, scene, mesh.mean_force);
  return model;
}

MeshModel sun_mesh_model(const Scene& scene, const GearGeometry& geometry) {
  return external_mesh_model(scene, {.mesh = sun_planet,
                                     .pair = geometry.sun_mesh(),
                                     .input = scene.sun_planet,
                                     .planet = scene.planet,
                                     .wheel = scene.sun,
                                     .planet_name = "planet",
                                     .wheel_name = "sun",
                                     .misalignment = scene.errors.sun_planet_misalignment,
                                     .mean_force = geometry.operating_point.mean_mesh_force});
}

MeshModel ring_mesh_model(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  const auto& input = scene.rings.at(ring);
  const auto& ring_geometry = geometry.rings.at(ring);
  MeshModel model{.mesh = ring_planet, .ring = input.name};
  if (scene.ring_planet.stiffness != StiffnessShape::computed) {
    set_given(model, shape_text(scene.ring_planet.stiffness));
    return model;
  }
  const auto structure = ring_structure(input);
  set_fidelity(model, scene, solid_reason(scene, input), plane_reason(structure));
  model.positions = structure.repeating_teeth(input.teeth);
  model.repeats = repeats_text(structure, input.teeth, model.positions);
  model.problem = problem_of(scene, model.mesh, ring_geometry.set.ring_mesh(), scene.planet);
  model.problem->wheel_support_radius = ring_geometry.outside_radius;
  model.problem->structure = structure;
  model.problem->misalignment = scene.errors.ring_planet_misalignment;
  set_resolution(model, scene, geometry.operating_point.mean_mesh_force);
  return model;
}

}  // namespace annulus::app
