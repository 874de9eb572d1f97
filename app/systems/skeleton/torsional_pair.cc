#include "app/systems/skeleton/torsional_pair.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/model/mesh_figures.h"
#include "app/plan/gear_geometry.h"
#include "app/plan/plan.h"
#include "app/results/cached_value.h"
#include "app/run/pipeline.h"
#include "app/scene/gear_tables.h"
#include "app/scene/key_checks.h"
#include "dynamics/figures/common_figures.h"

namespace annulus::app {

namespace {

constexpr const char* mesh_name = "pinion_wheel";

// 1. Scene: what the user gives. Inputs that not every kind has are a struct of this file (Scene::own).

struct TorsionalInput {
  HubGearInput pinion, wheel;
  MeshInput mesh;
  double torque = 0;  ///< N m, of the pinion
  double drive = 0;   ///< kg m^2, of the machine on its shaft
};

Table gear_table(const char* path, const char* meaning, HubGearInput TorsionalInput::*member) {
  Declarations gear(path, meaning, member);
  declare_teeth(gear, Flanks::external);
  declare_inertia(gear).required();
  declare_flanks(gear, Flanks::external);
  declare_bore(gear, is("mesh.pinion_wheel.stiffness", {"computed"}));
  return gear.done();
}

std::vector<Table> tables() {
  Declarations stage("stage", "", &Scene::stage);
  declare_centre_distance(stage).required();
  Declarations<TorsionalInput> load("stage", "");
  load.key("pinion_torque_Nm", &TorsionalInput::torque, "Torque that drives the pinion.").above(0, 1e9).required();
  stage.add(load.done());
  Declarations<TorsionalInput> drive("drive", "The machine on the shaft of the pinion.");
  drive.optional();
  drive.key("inertia_kg_m2", &TorsionalInput::drive, "Its moment of inertia.").fallback(0.0, "none").from(0, 1e6);
  auto mesh =
      declare_mesh({"mesh.pinion_wheel", "Stiffness of the mesh along the line of action.", &TorsionalInput::mesh});
  return {stage.done(), gear_table("pinion", "The driving gear.", &TorsionalInput::pinion),
          gear_table("wheel", "The driven gear.", &TorsionalInput::wheel), drive.done(), mesh.done()};
}

class Checker : KeyChecks {
 public:
  using KeyChecks::KeyChecks;
  void run() { wave(scene_.own<TorsionalInput>().mesh, "mesh.pinion_wheel"); }
};

constexpr const char* example = R"(title = "Torsional pair"
accuracy = 0.05
[stage]
kind = "torsional_pair"
module_mm = 4
pressure_angle_deg = 20
face_width_mm = 30
centre_distance_mm = 120
pinion_torque_Nm = 300
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
density_kg_per_m3 = 7850
[pinion]
teeth = 24
profile_shift = 0
inertia_kg_m2 = 0.002
bore_diameter_mm = 40
[wheel]
teeth = 36
profile_shift = 0
inertia_kg_m2 = 0.01
bore_diameter_mm = 60
[drive]
inertia_kg_m2 = 0.001
[dynamics]
half_backlash_um = 50
mesh_damping_ratio = 0.07
support_damping_ratio = 0.02
)";

// 2. Results: each declared once.

const std::vector<FigureSpec>& model_figures() {
  static const std::vector<FigureSpec> specs = {
      {.key = "natural_frequency_Hz",
       .title = "Natural frequency",
       .symbol = "f",
       .unit = "Hz",
       .definition = "1/(2π) √(k (1/m_1 + 1/m_2)) with the mean mesh stiffness k and m = J/r² at the base circles",
       .guarantee = Guarantee::always,
       .digits = 5,
       .headline = true,
       .compared = true,
       .cost_study = true,
       .plotted = true,
       .spread = true},
      {.key = "static_deflection_m",
       .title = "Deflection of the mesh",
       .unit = "µm",
       .scale = 1e6,
       .definition = "mesh force over the mean mesh stiffness",
       .better = Better::smaller,
       .compared = true,
       .spread = true},
      dynamics::steady_figure()};
  return specs;
}

const std::vector<FigureSpec>& all_figures() {
  static const auto specs =
      joined_figures({mesh_figure_specs(mesh_name, "mesh", "mesh_stiffness", {"pinion", "wheel"}), model_figures()});
  return specs;
}

// 3. Lumped model: the equations, from the scene and the stiffness of its mesh.

/// Stiffness N/m, force N, masses at the base circles kg.
StudyPoint torsional_answer(double stiffness, double force, double pinion_mass, double wheel_mass) {
  FigureRow row(model_figures());
  row.set("natural_frequency_Hz", std::sqrt(stiffness * (1 / pinion_mass + 1 / wheel_mass)) / (2 * std::numbers::pi));
  row.set("static_deflection_m", force / stiffness);
  row.set("steady", 1);
  return {.figures = row};
}

// 4. System: geometry, meshes and the plan. Run, studies and report are those of every kind.

class TorsionalPair final : public GearSystem {
 public:
  using GearSystem::GearSystem;

  [[nodiscard]] std::string describe() const override {
    return fmt::format("torsional pair, {} and {} teeth", input().pinion.teeth, input().wheel.teeth);
  }

  void check() const override { (void)gears(); }

  [[nodiscard]] std::vector<MeshModel> meshes() const override {
    const auto pair = gears();
    return {mesh_model(scene(), {.mesh = mesh_name,
                                 .title = "mesh of pinion and wheel",
                                 .pair = pair,
                                 .input = input().mesh,
                                 .pinion = input().pinion,
                                 .wheel = input().wheel,
                                 .pinion_name = "pinion",
                                 .wheel_name = "wheel",
                                 .wheel_support_diameter = input().wheel.bore_diameter,
                                 .mean_force = mean_mesh_force()})};
  }

  [[nodiscard]] double mean_mesh_force() const override { return input().torque / gears().pinion().base_radius(); }

  [[nodiscard]] MeshResult stiffness(const MeshModel& mesh, const RunOptions& options) const override {
    if (mesh.computed()) return computed_stiffness(mesh, mesh.variant, options);
    return prescribed_stiffness(mesh, input().mesh, scene(), gears().contact_ratio(), mean_mesh_force());
  }

  [[nodiscard]] std::unique_ptr<LumpedModel> model(std::size_t /*variant*/,
                                                   const std::vector<const MeshResult*>& tables) const override {
    const auto pair = gears();
    const auto mass = [](double inertia, const geometry::Gear& gear) {
      return inertia / std::pow(gear.base_radius(), 2);
    };
    const double pinion = mass(input().pinion.inertia.value() + input().drive, pair.pinion()),
                 wheel = mass(input().wheel.inertia.value(), pair.wheel()), force = mean_mesh_force();
    // What is prescribed is read from the scene.
    const auto& given = input().mesh.mean;
    const double stiffness = given ? *given : tables.front()->mean_stiffness().value;
    return std::make_unique<LumpedModel>(identity_of(stiffness, force, pinion, wheel), [=](Answer /*wanted*/) {
      return torsional_answer(stiffness, force, pinion, wheel);
    });
  }

 protected:
  void describe(Plan& plan) const override {
    plan.inputs = scene().inputs;
    plan.quantities = {{"mesh_force_N", mean_mesh_force(), "N", "mesh force along the line of action"}};
    plan.dofs = {{"pinion u", true, "turns"}, {"wheel u", true, "turns"}};
  }

 private:
  [[nodiscard]] const TorsionalInput& input() const { return scene().own<TorsionalInput>(); }
  [[nodiscard]] geometry::GearPair gears() const {
    return {make_gear(scene(), input().pinion, geometry::GearKind::external),
            make_gear(scene(), input().wheel, geometry::GearKind::external, -1), scene().stage.centre_distance,
            geometry::GearRole::pinion};
  }
};

}  // namespace

SystemKind torsional_pair_kind() {
  return {
      {"torsional_pair", tables, [](Scene& scene, std::vector<Problem>& problems) { Checker(scene, problems).run(); },
       [] { return figure_keys(model_figures()); }, example},
      all_figures,
      model_figures,
      [](const Scene& scene) -> std::unique_ptr<GearSystem> { return std::make_unique<TorsionalPair>(scene); }};
}

}  // namespace annulus::app
