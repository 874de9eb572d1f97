// A thin planet on rollers against CalculiX: sun, planet and ring in contact in one model, the rollers as one-sided
// springs around the bore. CalculiX turns sun and planet a little and states their torques. Compared
// are the loads of the rollers and the rotation of the sun in equilibrium, and how the meshes act on each other through
// the planet: a torque on the planet changes the force of one mesh alone. Exit status 77: CalculiX
// is not installed.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "app/model/mesh_solve.h"
#include "app/plan/gear_geometry.h"
#include "app/plan/mesh_model.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/planetary_model.h"
#include "benchmarks/calculix/contact_job.h"
#include "benchmarks/calculix/stage_job.h"
#include "benchmarks/calculix/stage_places.h"
#include "core/errors.h"
#include "core/radial_bearing.h"

namespace {

using namespace annulus;
using benchmarks::StageJob;

/// Of the largest load of the rollers; of the sun's rotation; of the coupling.
constexpr double roller_accuracy = 0.02, rotation_accuracy = 0.02, coupling_accuracy = 0.05;

/// One planet is compared; three make the stage. The ring is held all around.
std::string scene_text(double bore_mm, double clearance_um) {
  return fmt::format(R"(title = "Peer of a thin planet"
accuracy = 0.003
model = "plane"
[stage]
kind = "planetary"
planets = 3
module_mm = 4
pressure_angle_deg = 20
face_width_mm = 40
centre_distance_mm = 78
sun_torque_Nm = 1000
sun_speed_rpm = 100
[material]
youngs_modulus_GPa = 206
[sun]
teeth = 20
profile_shift = -0.03
bore_diameter_mm = 40
[planet]
teeth = 19
profile_shift = 0
bore_diameter_mm = {}
bore = "rollers"
[supports]
planet_N_per_m = 1e9
planet_clearance_um = {}
[[ring]]
name = "held"
structure = "traditional"
teeth = 58
profile_shift = 0.03
tip_diameter_mm = 226
rim_thickness_mm = 10
)",
                     bore_mm, clearance_um);
}

struct Options {
  double bore_mm = 52, clearance_um = 30;
  std::vector<double> positions{0.25, 0.625};  ///< mesh cycles of the sun mesh
  double contact_stiffness = 2e16;
  double reach = 0.5e-3;  ///< m
  int threads = 2;
  bool keep = false;
};

/// The planet as annulus has it, at one position of the sun mesh.
struct Planet {
  std::vector<double> rollers;                     ///< N
  double first_roller = 0;                         ///< rad, from tooth 0
  double angle = 0;                                ///< rad, of tooth 0 from the direction to the planet
  double sun_deflection = 0, ring_deflection = 0;  ///< m, with the motion of the planet in its bearing
  double coupling = 0;  ///< m/N, deflection of the sun mesh by the force of the ring mesh, with that motion
};

class Stage {
 public:
  Stage(const app::Scene& scene, const Options& options)
      : geometry_(app::make_geometry(scene)),
        set_(geometry_.rings.front().set),
        sun_(app::sun_mesh_model(scene, geometry_)),
        bearing_(scene.supports.planet, scene.supports.planet_clearance / 2) {
    app::RunOptions run;
    run.threads = options.threads;
    sun_result_ = std::make_unique<fem::LoadedMeshResult>(app::solve_contact(sun_, run));
    auto ring = app::ring_mesh_model(scene, geometry_, 0);
    const auto solved = app::solve_contact(ring, run);
    nominal_ = sun_.nominal_load();
    std::vector<double> deflections;
    for (const auto& p : solved.positions)
      if (p.load == force() && p.mesh_phase < 1) deflections.push_back(p.entry.lte);
    ring_ = PeriodicCurve(deflections, static_cast<int>(deflections.size()));
  }

  [[nodiscard]] const geometry::PlanetarySet& set() const { return set_; }
  [[nodiscard]] const app::RingGeometry& ring() const { return geometry_.rings.front(); }
  [[nodiscard]] double force() const { return sun_.problem->loads[nominal_]; }

  [[nodiscard]] Planet at(double cycles) const {
    const double phase = cycles - std::floor(cycles);
    const auto& all = sun_result_->positions;
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& p) {
      return p.load == force() && std::abs(p.mesh_phase - phase) < 1e-9;
    });
    require(found != all.end(), fmt::format("no position at the phase {}", phase));
    Planet planet;
    planet.rollers = found->rollers;
    planet.angle = found->planet_angle;
    const double spacing = 2 * std::numbers::pi / static_cast<double>(planet.rollers.size());
    planet.first_roller = (spacing - set_.planet().pitch_angle()) / 2;
    const double as = set_.sun_mesh().working_pressure_angle(), ar = set_.ring_mesh().working_pressure_angle();
    const Eigen::Vector2d of_sun(std::sin(as), std::cos(as)), of_ring(-std::sin(ar), std::cos(ar));
    const Eigen::Vector2d sum = of_sun + of_ring, along = sum.normalized();
    const double distance = bearing_.distance(force() * sum.norm());
    planet.sun_deflection = found->entry.lte + of_sun.dot(along) * distance;
    planet.ring_deflection = ring_(cycles - set_.ring_phase_lag(0)) + of_ring.dot(along) * distance;
    const auto [carried, slope] = bearing_(distance);
    const double along_both = of_sun.dot(along) * of_ring.dot(along), across_both = of_sun.dot(of_ring) - along_both;
    planet.coupling = found->partner_compliance + along_both / slope + across_both * distance / carried;
    return planet;
  }

 private:
  app::GearGeometry geometry_;
  const geometry::PlanetarySet& set_;
  app::MeshModel sun_;
  RadialBearing bearing_;
  std::unique_ptr<fem::LoadedMeshResult> sun_result_;
  PeriodicCurve ring_;
  std::size_t nominal_ = 0;
};

bool compare(const app::Scene& scene, const Stage& stage, double cycles, const Options& options) {
  const auto ours = stage.at(cycles);
  const auto& set = stage.set();
  const double sun_radius = set.sun().base_radius(), planet_radius = set.planet().base_radius();
  const double planet_rotation = -ours.ring_deflection / planet_radius,
               sun_rotation = (ours.sun_deflection + ours.ring_deflection) / sun_radius;
  // annulus counts the mesh cycle by the rigid gears, CalculiX sees the teeth where the load has moved them.
  const double ahead = (sun_radius * sun_rotation - planet_radius * planet_rotation) / 2 / set.planet().base_pitch();
  const auto places = benchmarks::places_at(set, cycles - ahead, 1);
  StageJob job;
  add_bodies(job, set,
             {scene.sun.bore_diameter.value() / 2, scene.planet.bore_diameter.value() / 2, stage.ring().outside_radius},
             places, options.reach, benchmarks::PeerMesh::own);
  const auto patches = static_cast<int>(ours.rollers.size());
  // Which tooth of the job is tooth 0 of the solution.
  const double pitch = set.planet().pitch_angle(), tooth = places.planet_angle.front();
  const double first = tooth + pitch * std::round((places.planet_direction.front() + ours.angle - tooth) / pitch);
  job.planets.front().rollers = benchmarks::RollerBed{
      patches, first + ours.first_roller, 4 * scene.supports.planet / patches, scene.supports.planet_clearance / 2};
  job.material = app::material_of(scene, scene.sun);
  job.face_width = app::face_width_of(scene, scene.sun);
  job.sun_torque = stage.force() * sun_radius;
  job.contact_stiffness = options.contact_stiffness;
  job.threads = options.threads;
  const Eigen::Vector2d rotations(sun_rotation, planet_rotation);
  constexpr double turned = 0.02;
  job.steps.push_back({{rotations[0], rotations[1]}, {}});
  for (const int body : {0, 1}) {
    auto more = rotations;
    more[body] *= 1 + turned;
    job.steps.push_back({{more[0], more[1]}, {}});
  }
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("annulus_calculix_planet_{}", getpid()) /
                      fmt::format("position{:.4f}", cycles);
  const auto peer = run_calculix(job, folder);
  if (!peer.failure.empty()) {
    fmt::print("position {:.4f}: {}\n", cycles, peer.failure);
    return false;
  }
  if (!options.keep) std::filesystem::remove_all(folder.parent_path());
  // Torques and loads of the rollers are all but linear in such small rotations.
  const auto torques = [&](int state) {
    return Eigen::Vector2d(peer.states.at(state).torques[0], peer.states.at(state).torques[1]);
  };
  const auto rollers_of = [&](int state) {
    const auto& list = peer.states.at(state).rollers.front();
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size())));
  };
  Eigen::Matrix2d stiffness;
  Eigen::MatrixXd rollers_change(patches, 2);
  for (const int body : {0, 1}) {
    stiffness.col(body) = (torques(body + 1) - torques(0)) / (turned * rotations[body]);
    rollers_change.col(body) = (rollers_of(body + 1) - rollers_of(0)) / (turned * rotations[body]);
  }
  const Eigen::Vector2d left = stiffness.inverse() * (Eigen::Vector2d(job.sun_torque, 0) - torques(0));
  const Eigen::VectorXd their_rollers = rollers_of(0) + rollers_change * left;
  const double their_rotation = rotations[0] + left[0];
  // A torque on the planet takes that over its base radius off the force of the ring mesh.
  const Eigen::Vector2d by_torque = stiffness.inverse() * Eigen::Vector2d(0, -planet_radius);
  const double coupling = sun_radius * by_torque[0] + planet_radius * by_torque[1];
  const double largest = *std::max_element(ours.rollers.begin(), ours.rollers.end());
  double rollers = 0;
  for (std::size_t i = 0; i < ours.rollers.size(); ++i)
    rollers = std::max(rollers, std::abs(ours.rollers[i] - their_rollers[static_cast<Eigen::Index>(i)]) / largest);
  const double rotation = sun_rotation / their_rotation - 1, through = ours.coupling / coupling - 1;
  fmt::print(
      "{:>9.4f} {:>9.1f} {:>10.4f} {:>9.1f} {:>9.1f} {:>9.4f} {:>10.3e} {:>10.3e} {:>8.3f} {:>8} {:>6} {:>7.1f}\n",
      cycles, largest, rollers, sun_rotation * 1e6, their_rotation * 1e6, rotation, ours.coupling, coupling, through,
      peer.nodes, peer.iterations, peer.cpu_seconds);
  std::fflush(stdout);
  return rollers < roller_accuracy && std::abs(rotation) < rotation_accuracy && std::abs(through) < coupling_accuracy;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App cli{"a thin planet on rollers between sun and ring, against CalculiX"};
  cli.add_option("--bore", options.bore_mm, "of the planet, mm; the root circle has 66")->capture_default_str();
  cli.add_option("--clearance", options.clearance_um, "of the rollers, um")->capture_default_str();
  cli.add_option("--positions", options.positions, "mesh cycles of the sun mesh")->capture_default_str();
  cli.add_option("--contact-stiffness", options.contact_stiffness, "penalty of CalculiX, Pa/m")->capture_default_str();
  cli.add_option("--threads", options.threads, "for both programs")->capture_default_str();
  cli.add_flag("--keep", options.keep, "keep CalculiX's files");
  CLI11_PARSE(cli, argc, argv);
  if (!benchmarks::calculix_is_installed()) {
    fmt::print("CalculiX (ccx) is not installed: nothing to compare with\n");
    return 77;
  }
  const auto scene = app::parse_scene(scene_text(options.bore_mm, options.clearance_um), "calculix_planet.toml");
  const Stage stage(scene, options);
  fmt::print("{:>9} {:>9} {:>10} {:>9} {:>9} {:>9} {:>10} {:>10} {:>8} {:>8} {:>6} {:>7}\n", "position", "roller N",
             "difference", "sun urad", "ccx urad", "relative", "coupling", "ccx m/N", "relative", "nodes", "iter.",
             "cpu s");
  bool agree = true;
  for (const double position : options.positions) agree = compare(scene, stage, position, options) && agree;
  return agree ? EXIT_SUCCESS : EXIT_FAILURE;
}
