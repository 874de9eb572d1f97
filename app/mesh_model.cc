#include "app/mesh_model.h"

#include <fmt/format.h>

#include "app/content_id.h"

namespace annulus::app {

namespace {

fem::RingStructure structure_of(const RingInput& ring) {
  switch (ring.structure) {
    case Structure::traditional:
      return fem::OutsideHeld{};
    case Structure::thin_walled:
      return fem::EndFaceHeld{*ring.free_length, *ring.sleeve_thickness};
    case Structure::pinned:
    case Structure::bolted:
      break;
  }
  return fem::PinHeld{.angles = fem::equal_angles(*ring.pins, ring.first_pin_angle.value_or(0)),
                      .pin_diameter = *ring.pin_diameter,
                      .clearance = ring.pin_clearance.value_or(0),
                      .radial_stiffness = ring.pin_radial_stiffness,
                      .unilateral = ring.structure == Structure::pinned};
}

fem::LoadedMeshProblem problem_of(const Scene& scene, const GearGeometry& geometry, const geometry::GearPair& pair) {
  std::vector<double> loads;
  for (const double factor : table_load_factors) loads.push_back(factor * geometry.operating_point.mean_mesh_force);
  return {.pair = pair,
          .material = {scene.material.youngs_modulus, scene.material.poisson_ratio, scene.material.density},
          .face_width = scene.stage.face_width,
          .planet_bore_radius = scene.planet.bore_diameter.value_or(0) / 2,
          .loads = std::move(loads),
          .phases = table_phases};
}

void set_rung(MeshModel& model, const Scene& scene, bool needs_solid, const char* plane_reason,
              const char* solid_reason) {
  const bool solid = needs_solid || scene.rung == Rung::solid;
  model.rung = solid ? "solid" : "plane";
  model.settings.rung = solid ? fem::Rung::solid : fem::Rung::plane;
  model.settings.accuracy = scene.accuracy;
  model.reason = needs_solid                     ? solid_reason
                 : scene.rung == Rung::automatic ? plane_reason
                                                 : "the scene asks for it (rung)";
}

void set_given(MeshModel& model, const std::string& shape) {
  model.rung = "given";
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
  id.add(name + ".profile_crowning", p.profile_crowning);
}

void add_structure(ContentId& id, const fem::RingStructure& structure) {
  id.add("structure", static_cast<double>(structure.index()));
  if (const auto* sleeve = std::get_if<fem::EndFaceHeld>(&structure)) {
    id.add("free_length", sleeve->free_length).add("sleeve_thickness", sleeve->sleeve_thickness);
  } else if (const auto* pins = std::get_if<fem::PinHeld>(&structure)) {
    for (const double angle : pins->angles) id.add("pin", angle);
    id.add("pin_diameter", pins->pin_diameter).add("clearance", pins->clearance);
    id.add("pin_stiffness", pins->radial_stiffness.value_or(-1));
    id.add("unilateral", pins->unilateral ? 1 : 0);
  }
}

}  // namespace

std::string MeshModel::id() const {
  ContentId id;
  id.add("mesh", mesh).add("rung", rung);
  if (problem) {
    add_gear(id, "planet", problem->pair.planet());
    add_gear(id, "wheel", problem->pair.wheel());
    id.add("centre_distance", problem->pair.centre_distance());
    id.add("E", problem->material.youngs_modulus).add("nu", problem->material.poisson_ratio);
    id.add("face_width", problem->face_width).add("planet_bore", problem->planet_bore_radius);
    id.add("wheel_support", problem->wheel_support_radius).add("phases", problem->phases);
    for (const double load : problem->loads) id.add("load", load);
    if (problem->pair.internal()) add_structure(id, problem->structure);
    id.add("accuracy", settings.accuracy).add("degree", settings.degree).add("level", settings.level.value_or(0));
  }
  return id.id();
}

std::string MeshModel::label() const {
  return ring.empty() ? "sun-planet mesh" : fmt::format("ring-planet mesh of '{}'", ring);
}

MeshModel sun_mesh_model(const Scene& scene, const GearGeometry& geometry) {
  MeshModel model{.mesh = sun_planet};
  if (scene.sun_planet.stiffness != StiffnessShape::computed) {
    set_given(model, shape_text(scene.sun_planet.stiffness));
    return model;
  }
  set_rung(model, scene, false,
           "spur gears without lead modifications on hubs over the full width: nothing changes along the face width",
           "");
  model.repeats = "equal teeth on concentric hubs: one mesh cycle tells all";
  model.problem = problem_of(scene, geometry, geometry.sun_mesh());
  model.problem->wheel_support_radius = scene.sun.bore_diameter.value_or(0) / 2;
  return model;
}

MeshModel ring_mesh_model(const Scene& scene, const GearGeometry& geometry, std::size_t ring) {
  const auto& input = scene.rings.at(ring);
  const auto& ring_geometry = geometry.rings.at(ring);
  MeshModel model{.mesh = ring_planet, .ring = input.name};
  if (scene.ring_planet.stiffness != StiffnessShape::computed) {
    set_given(model, shape_text(scene.ring_planet.stiffness));
    return model;
  }
  const char* plane_reason = input.structure == Structure::traditional
                                 ? "the outer surface is held over the full width: nothing changes along the face width"
                             : input.structure == Structure::pinned
                                 ? "the pins carry over the full width: nothing changes along the face width"
                                 : "the bolts hold over the full width: nothing changes along the face width";
  set_rung(model, scene, input.structure == Structure::thin_walled, plane_reason,
           "the ring hangs on one end face, so the deflection grows toward its free end");
  if (input.structure == Structure::pinned || input.structure == Structure::bolted) {
    model.positions = fem::repeating_teeth(structure_of(input), input.teeth);
    model.repeats = fmt::format("{} teeth on {} equal supports: the ring repeats after {} teeth", input.teeth,
                                *input.pins, model.positions);
  } else {
    model.repeats = "the support is the same behind every tooth: one mesh cycle tells all";
  }
  model.problem = problem_of(scene, geometry, ring_geometry.set.ring_mesh());
  model.problem->wheel_support_radius = ring_geometry.outside_radius;
  model.problem->structure = structure_of(input);
  return model;
}

}  // namespace annulus::app
