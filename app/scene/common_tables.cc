#include "app/scene/common_tables.h"

#include <tuple>

#include "app/scene/scene_declare.h"
#include "app/scene/scene_kind.h"

namespace annulus::app {

namespace {

Table top_level_table() {
  Declarations<Scene> top("", "The whole scene.");
  top.key("title", &Scene::title, "Title of the report.").fallback("Planetary stage", "");
  top.key("accuracy", &Scene::accuracy, "Wanted relative accuracy of the mesh stiffness.")
      .fallback(0.01, "well below the spread of unknown inputs such as support stiffnesses")
      .from(1e-5, 0.2);
  top.choice("model", &Scene::fidelity,
             {{"automatic", Fidelity::automatic},
              {"closed_form", Fidelity::closed_form},
              {"plane", Fidelity::plane},
              {"solid", Fidelity::solid},
              {"resolved", Fidelity::resolved}},
             "Model of the elastic bodies. closed_form: tooth and curved-beam formulas, computed in seconds; the error "
             "is not controlled. plane or solid: finite elements with tooth superelements. resolved: the contact patch "
             "itself is meshed, plane or solid as the scene requires.")
      .fallback("automatic", "the cheapest model with a controlled error that the scene permits")
      .formerly("rung");
  top.key("reference", &Scene::reference, "File of published values to compare with, relative to the scene.")
      .absent("no comparison");
  return top.done();
}

Table report_table() {
  Declarations<Scene> report("report", "Names in the head of the report.");
  report.optional();
  report.key("project", &Scene::project, "Project or customer.").fallback("", "none is named");
  report.key("author", &Scene::author, "Who made it.").fallback("", "none is named");
  return report.done();
}

Table stage_table() {
  Declarations stage("stage", "The gear set and its operating point.", &Scene::stage);
  std::vector<Choice<std::string>> kinds;
  for (const auto& kind : scene_kinds()) kinds.push_back({kind.name, kind.name});
  stage.choice("kind", &StageInput::kind, kinds, "Kind of stage.").required();
  stage.key("module_mm", &StageInput::module, "Module.").required().from(0.05, 100);
  stage.key("pressure_angle_deg", &StageInput::pressure_angle, "Pressure angle of the basic rack.")
      .required()
      .from(10, 35);
  stage
      .key("helix_angle_deg", &StageInput::helix_angle,
           "Helix angle at the reference circle. Positive: planets, ring and pinion are right-handed, sun and wheel "
           "left-handed. Module, pressure angle and profile shifts are then those of the normal section. Forces and "
           "transmission errors of a planetary stage are those of the transverse section.")
      .fallback(0.0, "spur gears")
      .from(-45, 45);
  stage.key("face_width_mm", &StageInput::face_width, "Face width of all gears that have none of their own.")
      .required()
      .above(0, 5000);
  return stage.done();
}

Table material_table() {
  Declarations material("material", "Material of all gears; a gear may have its own.", &Scene::material);
  material.key("youngs_modulus_GPa", &MaterialInput::youngs_modulus, "Young's modulus.").required().from(1e-6, 2000);
  material.key("poisson_ratio", &MaterialInput::poisson_ratio, "Poisson's ratio.")
      .fallback(0.3, "steel")
      .from(0, 0.4999);
  material
      .key("density_kg_per_m3", &MaterialInput::density, "Density: for the modes of a ring; masses are checked by it.")
      .fallback(7850.0, "steel")
      .from(100, 30000);
  return material.done();
}

void declare_integration(Declarations<DynamicsInput>& lumped) {
  lumped
      .choice("integrator", &DynamicsInput::integrator,
              {{"automatic", dynamics::Integrator::automatic},
               {"explicit", dynamics::Integrator::arkode_explicit},
               {"adams", dynamics::Integrator::cvode_adams},
               {"bdf", dynamics::Integrator::cvode_bdf},
               {"implicit", dynamics::Integrator::arkode_implicit},
               {"runge_kutta_4", dynamics::Integrator::runge_kutta_4}},
              "Method of time integration. explicit: Runge-Kutta of order 5 with adaptive steps (ARKODE). adams, bdf: "
              "CVODE. implicit: L-stable Runge-Kutta of order 5 (ARKODE), for low speeds at which vibrations decay "
              "within a mesh cycle. runge_kutta_4: the classical method with fixed steps, as in the papers. automatic: "
              "explicit, bdf or implicit, chosen by stiffness ratio and damping.")
      .fallback("automatic", "the fastest accurate method");
  lumped.key("steps_per_cycle", &DynamicsInput::steps_per_cycle, "Steps per mesh cycle.")
      .from(10, 1e6)
      .needed_if(is("integrator", {"runge_kutta_4"}), "its steps are fixed; the other methods choose their steps");
  lumped.key("mesh_cycles", &DynamicsInput::mesh_cycles, "Mesh cycles to integrate.")
      .from(1, 1e6)
      .absent("until the periodic steady state is reached, then one error period");
  lumped.key("relative_tolerance", &DynamicsInput::relative_tolerance, "Relative tolerance of the time integration.")
      .from(1e-12, 1e-2)
      .absent("planetary stages: a ten-thousandth of the wanted accuracy, 1e-8 to 1e-5; else 1e-6");
}

Table dynamics_table() {
  Declarations lumped("dynamics", "The lumped model; absent: meshes and stiffness only.", &Scene::dynamics);
  lumped.optional();
  lumped
      .key("half_backlash_um", &DynamicsInput::half_backlash,
           "Half the backlash of every mesh along the line of action.")
      .required()
      .often_assumed()
      .from(0, 1e4);
  lumped.key("mesh_damping_ratio", &DynamicsInput::mesh_damping_ratio, "Damping ratio ζ of every mesh: c = 2ζ√(k m_e).")
      .required()
      .often_assumed()
      .from(0, 2);
  lumped.key("support_damping_ratio", &DynamicsInput::support_damping_ratio, "Damping ratio of every bearing.")
      .required()
      .often_assumed()
      .from(0, 2);
  for (const auto& [name, member, high, meaning] :
       {std::tuple{"modal_damping_ratio", &DynamicsInput::modal_damping_ratio, 2.0,
                   "Damping ratio of every mode of the whole system at the mean mesh stiffness, beside meshes and "
                   "bearings."},
        {"rayleigh_mass_per_s", &DynamicsInput::rayleigh_mass, 1e6,
         "Rayleigh damping, beside meshes and bearings: this times the mass."},
        {"rayleigh_stiffness_s", &DynamicsInput::rayleigh_stiffness, 1.0,
         "Rayleigh damping: this times the stiffness, of meshes while they touch."}})
    lumped.key(name, member, meaning).fallback(0.0, "none").from(0, high);
  lumped
      .choice("mesh_damping", &DynamicsInput::mesh_damping,
              {{"in_contact", MeshDamping::in_contact}, {"always", MeshDamping::always}},
              "Contact state in which mesh damping acts. `always` is the literal form of the papers; separated flanks "
              "can then pull.")
      .fallback("in_contact", "separated flanks exert no force");
  lumped
      .choice("load_dependence", &DynamicsInput::load_dependence,
              {{"table", dynamics::LoadDependence::table}, {"nominal", dynamics::LoadDependence::nominal}},
              "Force of a mesh with a stiffness table. table: force as a function of deflection through all tabulated "
              "loads; nominal: linear, with the secant stiffness at the mean mesh force.")
      .fallback("table", "correct at every load of the mesh");
  declare_integration(lumped);
  lumped
      .key("starts", &DynamicsInput::starts,
           "Initial conditions from which other motions are looked for where backlash is within reach of the "
           "vibration: several motions may exist there. 0: none are tried.")
      .fallback(64, "a motion to which 5 % of them lead is missed once in 27 times")
      .from(0, 10000);
  return lumped.done();
}

}  // namespace

std::vector<Table> first_common_tables() {
  return {top_level_table(), report_table(), stage_table(), material_table()};
}

std::vector<Table> last_common_tables() {
  auto tables = study_tables();
  tables.insert(tables.begin(), dynamics_table());
  return tables;
}

}  // namespace annulus::app
