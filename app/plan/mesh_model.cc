#include "app/plan/mesh_model.h"

#include <fmt/format.h>

#include <map>
#include <mutex>

#include "app/results/content_id.h"
#include "fem/loaded_mesh.h"
#include "fem/problem/solved_face.h"
#include "fem/solid_face.h"

namespace annulus::app {

namespace {

/// The kind of gear does not matter to its lead.
bool lead_modified(const Scene& scene, const GearInput& gear) {
  return geometry::modified_along_face(gear_parameters(scene, gear, geometry::GearKind::external));
}

void set_prescribed(MeshModel& model, StiffnessShape shape) {
  constexpr const char* names[] = {"computed", "constant", "harmonic",   "rectangular",
                                   "table",    "iso_6336", "closed_form"};
  model.fidelity = "prescribed";
  model.reason = fmt::format("the scene prescribes the stiffness (mesh.{}: {})", model.mesh,
                             names[static_cast<std::size_t>(shape)]);
  model.repeats = "as prescribed";
}

void add_topography(ContentId& id, const std::string& name, const geometry::FlankTopography& flank) {
  for (const double radius : flank.radii()) id.add(name + ".radius", radius);
  for (const double position : flank.positions()) id.add(name + ".position", position);
  for (const double removed : flank.removed().reshaped()) id.add(name + ".removed", removed);
}

void add_gear(ContentId& id, const std::string& name, const geometry::Gear& gear) {
  const auto& p = gear.parameters();
  id.add(name + ".teeth", p.teeth).add(name + ".module", p.module).add(name + ".pressure_angle", p.pressure_angle);
  id.add(name + ".profile_shift", p.profile_shift).add(name + ".tip_radius", gear.tip_form_radius());
  id.add(name + ".root_radius", gear.root_radius()).add(name + ".root_fillet", p.root_fillet_factor);
  id.add(name + ".tip_relief", p.tip_relief).add(name + ".tip_relief_length", p.tip_relief_length);
  id.add(name + ".profile_crowning", p.profile_crowning).add(name + ".helix_angle", p.helix_angle);
  id.add(name + ".lead_crowning", p.lead_crowning).add(name + ".lead_slope", p.lead_slope);
  if (p.protuberance != 0) id.add(name + ".protuberance", p.protuberance).add(name + ".ramp", p.protuberance_angle);
  if (p.tip_chamfer != 0) id.add(name + ".tip_chamfer", p.tip_chamfer);
  if (p.profile_slope != 0) id.add(name + ".profile_slope", p.profile_slope);
  if (p.leading_topography) add_topography(id, name + ".leading", *p.leading_topography);
  if (p.trailing_topography) add_topography(id, name + ".trailing", *p.trailing_topography);
}

void add_structure(ContentId& id, const fem::RingStructure& structure) {
  id.add("structure", structure.words().name);
  for (const auto& [name, value] : structure.parameters()) id.add(name, value);
}

Decision symmetry_decision(const fem::LoadedMeshProblem& problem, const fem::LoadedMeshSettings& settings) {
  if (fem::solved_face(problem, settings).half)
    return {"symmetry", "half of the face", "the mesh is symmetric about the middle of the face"};
  return {"symmetry", "whole face", settings.symmetry ? fem::asymmetry_of_face(problem) : "asked for"};
}

/// fem::choose_mesh() for the problem of a model. A choice may solve the mesh by formulas, and the checks and the plan
/// of a study ask for the same one again for each of its cases: those of this process are remembered.
fem::MeshChoice remembered_choice(MeshModel& model, const std::string& why_solid, const fem::MeshWish& wish) {
  struct Chosen {
    int phases;
    std::vector<double> loads;
    fem::MeshChoice choice;
  };
  constexpr std::size_t most = 4096;
  static std::mutex lock;
  static std::map<std::string, Chosen> all;
  auto& problem = *model.problem;
  ContentId id;
  id.add("problem", model.id()).add("why_solid", why_solid).add("model", static_cast<double>(wish.model));
  id.add("accuracy", wish.accuracy).add("mean_force", wish.mean_force).add("modes", wish.ring_modes_count ? 1 : 0);
  {
    const std::lock_guard guard(lock);
    if (const auto found = all.find(id.text()); found != all.end()) {
      problem.phases = found->second.phases;
      problem.loads = found->second.loads;
      return found->second.choice;
    }
  }
  auto choice = fem::choose_mesh(problem, why_solid, wish);
  const std::lock_guard guard(lock);
  if (all.size() >= most) all.clear();
  all.emplace(id.text(), Chosen{problem.phases, problem.loads, choice});
  return choice;
}

}  // namespace

std::vector<Decision> decisions(const MeshModel& model) {
  std::vector<Decision> list = {{"model", model.fidelity, model.reason}};
  if (!model.computed()) return list;
  const auto& settings = model.settings;
  const auto& problem = *model.problem;
  const bool solid = fem::is_solid(settings.fidelity);
  list.push_back({"dimension", solid ? "3D" : "2D, plane strain",
                  solid ? "the face width is meshed" : "one section stands for the whole face width"});
  if (solid) list.push_back(symmetry_decision(problem, settings));
  if (model.has_elements()) {
    constexpr const char* names[] = {"linear", "quadratic", "cubic"};
    list.push_back({"elements", names[settings.degree - 1], model.elements});
    list.push_back(
        settings.level
            ? Decision{"refinement", fmt::format("level {}", *settings.level), "asked for"}
            : Decision{"refinement", fmt::format("until {:g} %", 100 * settings.accuracy),
                       "cells 1.5 times smaller from level to level until two levels agree at every position"});
    list.push_back(
        {"sectors",
         fmt::format("1 of {} and 1 of {} teeth", problem.pair.pinion().teeth(), problem.pair.wheel().teeth()),
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
    add_gear(id, "pinion", problem->pair.pinion());
    add_gear(id, "wheel", problem->pair.wheel());
    id.add("centre_distance", problem->pair.centre_distance());
    id.add("pinion_drives", problem->pair.driver() == geometry::GearRole::pinion ? 1.0 : 0.0);
    for (const auto* material : {&problem->materials.pinion, &problem->materials.wheel})
      id.add("E", material->youngs_modulus).add("nu", material->poisson_ratio);
    id.add("face_width", problem->face_width).add("pinion_bore", problem->pinion_bore_radius);
    id.add("wheel_support", problem->wheel_support_radius).add("phases", problem->phases);
    id.add("misalignment", problem->misalignment);
    for (const auto* overhang : {&problem->pinion_overhang, &problem->wheel_overhang})
      id.add("below", overhang->below).add("above", overhang->above);
    for (const double load : problem->loads) id.add("load", load);
    if (problem->pair.internal()) add_structure(id, problem->structure);
    if (const auto& rollers = problem->planet_rollers) {
      id.add("bearing", rollers->stiffness).add("play", rollers->play);
      add_gear(id, "partner", rollers->partner.wheel());
      id.add("partner_distance", rollers->partner.centre_distance());
    }
    for (const auto& gauge : problem->gauges) {
      id.add("gauge", gauge.name).add("place", static_cast<double>(gauge.place));
      id.add("direction", static_cast<double>(gauge.direction)).add("angle", gauge.angle);
      id.add("offset", gauge.offset).add("length", gauge.length).add("z", gauge.z);
    }
    id.add("accuracy", settings.accuracy).add("degree", settings.degree).add("level", settings.level.value_or(0));
  }
  return id.id();
}

std::string MeshModel::label() const { return variant.empty() ? title : fmt::format("{} of '{}'", title, variant); }

fem::FaceFeatures face_features(const Scene& scene, const GearInput& pinion, const std::string& pinion_name,
                                const GearInput& wheel, const std::string& wheel_name, double misalignment,
                                bool gauges_across) {
  // Less changes the stiffness by less than the plane section's own error.
  constexpr double seen = 0.05;
  const double apart = std::abs(pinion.axial_offset - wheel.axial_offset);
  const bool beside = apart > seen * narrower_face(scene, pinion, wheel);
  return {scene.stage.helix_angle,     pinion_name,  wheel_name, lead_modified(scene, pinion),
          lead_modified(scene, wheel), misalignment, beside,     gauges_across};
}

std::string solid_reason(const Scene& scene, const GearMesh& mesh) {
  return fem::solid_reason(mesh.structure, face_features(scene, mesh.pinion, mesh.pinion_name, mesh.wheel,
                                                         mesh.wheel_name, mesh.misalignment, mesh.gauges_across));
}

std::optional<fem::LoadedMeshProblem> mesh_problem(const Scene& scene, const GearMesh& mesh) {
  if (mesh.input.stiffness != StiffnessShape::computed) return std::nullopt;
  const auto face = mesh.pair.common_face();
  return fem::LoadedMeshProblem{.pair = mesh.pair,
                                .materials = {material_of(scene, mesh.pinion), material_of(scene, mesh.wheel)},
                                .face_width = face.width,
                                .pinion_bore_radius = mesh.pinion.bore_diameter.value_or(0) / 2,
                                .wheel_support_radius = mesh.wheel_support_diameter.value_or(0) / 2,
                                .structure = mesh.structure,
                                .misalignment = mesh.misalignment,
                                .pinion_overhang = face.pinion,
                                .wheel_overhang = face.wheel,
                                .name = mesh.mesh,
                                .gauges = mesh.gauges,
                                .planet_rollers = mesh.planet_rollers};
}

MeshModel mesh_model(const Scene& scene, const GearMesh& mesh) {
  MeshModel model;
  model.mesh = mesh.mesh;
  model.title = mesh.title;
  model.variant = mesh.variant;
  model.pinion_body = mesh.pinion_name;
  model.wheel_body = mesh.wheel_name;
  model.problem = mesh_problem(scene, mesh);
  if (!model.problem) {
    set_prescribed(model, mesh.input.stiffness);
    return model;
  }
  const fem::MeshWish wish{.model = scene.fidelity,
                           .accuracy = scene.accuracy,
                           .mean_force = mesh.mean_force,
                           .ring_modes_count = mesh.ring_modes_count};
  auto why_solid = solid_reason(scene, mesh);
  if (why_solid.empty() && scene.fidelity == Fidelity::automatic &&
      fem::why_no_solid_face(*model.problem, fem::Fidelity::solid).empty())
    why_solid = mesh.why_it_tilts;
  static_cast<fem::MeshChoice&>(model) = remembered_choice(model, why_solid, wish);
  model.fidelity = fidelity_name(model.settings.fidelity);
  return model;
}

}  // namespace annulus::app
