// A whole planetary stage in equilibrium against CalculiX: sun, planets and a flexible ring on bolts in one model, all
// meshes in contact; with and without a planet pin beside its place. Exit status 77: CalculiX is not installed.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/planetary/statics.h"
#include "app/systems/shared/sun_planet_input.h"
#include "benchmarks/calculix/contact_job.h"
#include "benchmarks/calculix/stage_job.h"
#include "benchmarks/stopwatch.h"
#include "core/errors.h"
#include "fem/body/resolution.h"
#include "fem/problem/structures/pin_held.h"
#include "geometry/sector_mesh.h"

namespace {

using namespace annulus;
using benchmarks::FlankPair;
using benchmarks::HubGear;
using benchmarks::make_gear;
using benchmarks::QuadraticBody;
using benchmarks::StageJob;
using geometry::Boundary;
using geometry::PlanetarySet;

/// Largest difference of a planet's share of the load, relative to the mean force, and of the sun's rotation.
constexpr double share_accuracy = 0.01, rotation_accuracy = 0.02;

/// Three planets out of phase on a ring that three soft bolts hold: its meshes act on each other. Planet 1 stands
/// `error` micrometres ahead of its place.
std::string scene_text(double error) {
  return fmt::format(R"(title = "Peer of a whole stage"
accuracy = 0.005
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
mass_kg = 1.2
inertia_kg_m2 = 0.001
bore_diameter_mm = 40
[planet]
teeth = 19
profile_shift = 0
mass_kg = 1.2
inertia_kg_m2 = 0.001
bore_diameter_mm = 36
[carrier]
mass_kg = 18
inertia_kg_m2 = 0.15
[[ring]]
name = "bolted"
structure = "bolted"
teeth = 58
profile_shift = 0.03
tip_diameter_mm = 226
rim_thickness_mm = 10
pins = 3
pin_diameter_mm = 12
pin_radial_stiffness_N_per_m = 1e9
mass_kg = 5
inertia_kg_m2 = 0.07
[errors]
planet_pin_position_error_um = [{}, 0, 0]
planet_pin_position_error_phase_deg = [90, 0, 0]
[supports]
sun_N_per_m = "rigid"
planet_N_per_m = 1e9
ring_N_per_m = "rigid"
carrier_N_per_m = "rigid"
[dynamics]
half_backlash_um = 30
mesh_damping_ratio = 0.07
support_damping_ratio = 0.03
rim_coupling = "static"
[statics]
carrier_positions = 58
mesh_phases = 8
)",
                     error);
}
constexpr double pin_error = 30e-6, bearing_stiffness = 1e9, bolt_stiffness = 1e9, bolt_diameter = 12e-3;  // scene_text
constexpr int bolts = 3;

struct Options {
  std::vector<double> positions{7.25, 9.5};  ///< mesh cycles
  bool same_mesh = false, rigid_phase = false;
  double contact_stiffness = 2e16;
  double reach = 0.35e-3;  ///< m
  int threads = 2;
  bool keep = false;
};

/// How sun, planets and ring stand in the frame of the ring at `cycles` mesh cycles, and which teeth are near contact
/// (PlanetarySet::sun_phase_lag and the following).
struct Place {
  std::vector<double> planet_direction, planet_angle;  ///< rad, of the planets' axes and of their teeth 0
  double sun_angle = 0;
  std::vector<FlankPair> pairs;
};
Place place_at(const PlanetarySet& set, double cycles) {
  const auto &sun = set.sun(), &planet = set.planet(), &ring = set.ring();
  const auto &sun_mesh = set.sun_mesh(), &ring_mesh = set.ring_mesh();
  const double pitch = planet.base_pitch();
  const auto half = [](const geometry::Gear& gear, double working_angle) {
    return gear.tooth_half_angle(gear.base_radius() / std::cos(working_angle));
  };
  const double sun_angle = sun_mesh.working_pressure_angle(), ring_angle = ring_mesh.working_pressure_angle();
  const auto phase_of = [](double value) { return value - std::floor(value + 1e-12); };
  const auto tooth = [](double value, int teeth) {
    const double whole = std::round(value);
    require(std::abs(value - whole) < 1e-6, "teeth are counted by whole numbers");
    return ((static_cast<int>(whole) % teeth) + teeth) % teeth;
  };
  // Pairs so far beyond their path of contact do not touch: their gap is wider than the deflection of these meshes.
  const double beyond_path = 0.13 * pitch;
  const geometry::ToothProfile planet_profile(planet);
  Place place;
  for (int n = 0; n < set.planets(); ++n) {
    const double ring_position = cycles - set.ring_phase_lag(n) + set.ring_tooth_offset(n);
    const double direction = ring.pitch_angle() * ring_position + half(ring, ring_angle);
    const double turned = cycles - set.sun_phase_lag(n);
    if (n == 0) place.sun_angle = direction - half(sun, sun_angle) + sun.pitch_angle() * cycles;
    const double angle = direction + std::numbers::pi - half(planet, sun_angle) - planet.pitch_angle() * turned;
    place.planet_direction.push_back(direction);
    place.planet_angle.push_back(angle);
    const Eigen::Vector2d axis = Eigen::Rotation2Dd(direction) * Eigen::Vector2d(set.centre_distance(), 0);
    for (const bool with_ring : {false, true}) {
      const auto& mesh = with_ring ? ring_mesh : sun_mesh;
      const double phase = phase_of(with_ring ? cycles - set.ring_phase_lag(n) : turned);
      for (int k = -4; k <= 4; ++k) {
        const double passed = phase + k;  // mesh cycles since the pitch point
        // The planet is driven from its tip to its root by the sun, and drives the ring the other way.
        const double roll = mesh.roll_length_pitch() + (with_ring ? passed : -passed) * pitch;
        const double beyond = std::max(mesh.roll_length_low() - roll, roll - mesh.roll_length_high());
        if (beyond > beyond_path) continue;
        FlankPair pair;
        pair.planet = n;
        pair.with_ring = with_ring;
        pair.planet_tooth = tooth(turned - passed - (with_ring ? set.cycles_from_sun_to_ring() : 0), planet.teeth());
        pair.wheel_tooth =
            with_ring
                ? tooth(ring_position - passed, ring.teeth())
                : tooth(passed - cycles + sun.teeth() * set.planet_angle(n) / (2 * std::numbers::pi), sun.teeth());
        Eigen::Vector2d point =
            planet_profile.flank_point(std::clamp(roll, mesh.roll_length_low(), mesh.roll_length_high()));
        if (with_ring) point.y() = -point.y();
        pair.place = axis + Eigen::Rotation2Dd(angle + pair.planet_tooth * planet.pitch_angle()) * point;
        pair.reach = beyond > 0 ? 2 : 1;  // times Options::reach
        place.pairs.push_back(pair);
      }
    }
  }
  return place;
}

/// One sector of the contact teeth. The peer's own: cells along the flank as long as half the width of the contact.
geometry::Mesh sector(const geometry::Gear& gear, double support_radius, bool same_mesh) {
  geometry::SectorResolution own;
  own.flank_cells = 44, own.fillet_cells = 6, own.root_cells = 1, own.thickness_cells = 10, own.rim_cells = 8;
  own.flank_layer = 0.15;
  constexpr int level = 1;
  return geometry::make_sector_mesh(gear, {support_radius, {}},
                                    same_mesh ? fem::plane_resolution(gear, level).section : own);
}

QuadraticBody gear_body(const geometry::Gear& gear, double support_radius, bool same_mesh,
                        const std::set<int>& contact_teeth) {
  return make_gear(geometry::ToothProfile(gear), sector(gear, support_radius, same_mesh), support_radius,
                   contact_teeth);
}

StageJob stage_job(const app::Scene& scene, const app::RingGeometry& ring, double cycles, const Options& options) {
  const auto& set = ring.set;
  auto place = place_at(set, cycles);
  std::set<int> sun_teeth, ring_teeth;
  std::vector<std::set<int>> planet_teeth(set.planets());
  for (auto& pair : place.pairs) {
    pair.reach *= options.reach;
    planet_teeth[pair.planet].insert(pair.planet_tooth);
    (pair.with_ring ? ring_teeth : sun_teeth).insert(pair.wheel_tooth);
  }
  StageJob job;
  const double sun_bore = sun_and_planets(scene).sun.bore_diameter.value() / 2,
               planet_bore = sun_and_planets(scene).planet.bore_diameter.value() / 2;
  job.sun.body = gear_body(set.sun(), sun_bore, options.same_mesh, sun_teeth);
  job.sun.body.place(place.sun_angle, Eigen::Vector2d::Zero());
  for (int n = 0; n < set.planets(); ++n) {
    HubGear planet{gear_body(set.planet(), planet_bore, options.same_mesh, planet_teeth[n]),
                   Eigen::Rotation2Dd(place.planet_direction[n]) * Eigen::Vector2d(set.centre_distance(), 0)};
    planet.body.place(place.planet_angle[n], planet.axis);
    job.planets.push_back(std::move(planet));
  }
  job.ring = gear_body(set.ring(), ring.outside_radius, options.same_mesh, ring_teeth);
  job.ring_outside = ring.outside_radius;
  fem::PinHeld held;
  held.unilateral = false;
  held.angles = fem::equal_angles(bolts, 0);
  held.pin_diameter = bolt_diameter;
  held.radial_stiffness = held.tangential_stiffness = bolt_stiffness;
  job.material = app::material_of(scene, sun_and_planets(scene).sun);
  job.face_width = app::face_width_of(scene, sun_and_planets(scene).sun);
  job.ring_supports = held.supports({set.ring().teeth(), ring.outside_radius, job.face_width, job.material});
  // Sites are those of the mirror image in which ring meshes are solved.
  for (auto& site : job.ring_supports.sites) site.angle = -site.angle;
  job.planet_stiffness = bearing_stiffness;
  job.sun_torque = 1000;
  job.pairs = std::move(place.pairs);
  job.contact_stiffness = options.contact_stiffness;
  job.threads = options.threads;
  return job;
}

const dynamics::StaticPosition& position_at(const app::StageStatics& statics, double cycles) {
  const auto& all = statics.rings.front().turn.positions;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& p) { return std::abs(p.mesh_cycles - cycles) < 1e-9; });
  require(found != all.end(), "a position that annulus statics does not solve");
  return *found;
}

/// Rotations about the axis: sun, then planets.
std::vector<double> rotations(const dynamics::StaticPosition& position) {
  std::vector<double> result{position.bodies.front().rotation.z()};
  for (std::size_t body = 3; body < position.bodies.size(); ++body)
    result.push_back(position.bodies[body].rotation.z());
  return result;
}

/// By how many mesh cycles loaded teeth are ahead of the rigid gears: a mean of sun and planets.
double ahead(const PlanetarySet& set, const std::vector<double>& rotation) {
  const double planets = -std::accumulate(rotation.begin() + 1, rotation.end(), 0.0) / set.planets();
  return (set.sun().base_radius() * rotation.front() + set.planet().base_radius() * planets) / 2 /
         set.planet().base_pitch();
}

/// Shares of the load, 1 in the mean.
std::vector<double> shares(std::vector<double> forces) {
  const double mean = std::accumulate(forces.begin(), forces.end(), 0.0) / static_cast<double>(forces.size());
  for (double& force : forces) force /= mean;
  return forces;
}

bool compare(const app::Scene& scene, const app::RingGeometry& ring, const app::StageStatics& straight,
             const app::StageStatics& displaced, double cycles, const Options& options) {
  const auto &free = position_at(straight, cycles), &loaded = position_at(displaced, cycles);
  const auto guess = rotations(free);
  // annulus counts the mesh cycle by the rigid gears, CalculiX sees the teeth where the load has moved them.
  const double moved = (ahead(ring.set, guess) + ahead(ring.set, rotations(loaded))) / 2;
  fmt::print("position {:.4f}: the load has moved the contacts by {:.4f} mesh cycles\n", cycles, moved);
  const double shift = options.rigid_phase ? 0 : moved;
  auto job = stage_job(scene, ring, cycles - shift, options);
  std::vector<Eigen::Vector2d> errors(job.planets.size(), Eigen::Vector2d::Zero());
  errors.front() = Eigen::Rotation2Dd(std::numbers::pi / 2) * job.planets.front().axis.normalized() * pin_error;
  job.steps = {{guess, {}}, {{}, {}}, {{}, errors}};
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("annulus_calculix_stage_{}", getpid()) /
                      fmt::format("position{:.4f}", cycles);
  const auto peer = run_calculix(job, folder);
  if (!peer.failure.empty()) {
    fmt::print("position {:.4f}: {}\n", cycles, peer.failure);
    return false;
  }
  if (!options.keep) std::filesystem::remove_all(folder.parent_path());
  bool agree = true;
  for (const bool with_error : {false, true}) {
    const auto& ours = with_error ? loaded : free;
    const auto& theirs = peer.states.at(with_error ? 2 : 1);
    std::vector<double> our_forces, their_forces;
    for (std::size_t n = 0; n < job.planets.size(); ++n) {
      our_forces.push_back(ours.sun_meshes[n].force);
      // The forces of both meshes of a planet are equal and equally inclined.
      their_forces.push_back(theirs.pin_forces[n].norm() / 2 / std::cos(ring.set.sun_mesh().working_pressure_angle()));
    }
    const auto our_shares = shares(our_forces), their_shares = shares(their_forces);
    const double our_rotation = ours.bodies.front().rotation.z(), rotation = our_rotation / theirs.sun_rotation - 1;
    double worst = 0;
    for (std::size_t n = 0; n < our_shares.size(); ++n)
      worst = std::max(worst, std::abs(our_shares[n] - their_shares[n]));
    fmt::print("{:>9.4f} {:>6} {:>23} {:>23} {:>9.4f} {:>9.1f} {:>9.1f} {:>9.2e} {:>7} {:>6} {:>8.1f} {:>8.1f}\n",
               cycles, with_error ? "30 um" : "none", fmt::format("{:.4f}", fmt::join(our_shares, " ")),
               fmt::format("{:.4f}", fmt::join(their_shares, " ")), worst, our_rotation * 1e6,
               theirs.sun_rotation * 1e6, rotation, peer.nodes, peer.iterations, peer.wall_seconds, peer.cpu_seconds);
    agree = agree && worst < share_accuracy && std::abs(rotation) < rotation_accuracy;
  }
  std::fflush(stdout);
  return agree;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App cli{"annulus statics against CalculiX: a whole stage in one model"};
  cli.add_option("--positions", options.positions, "mesh cycles, multiples of an eighth")->capture_default_str();
  cli.add_flag("--same-mesh", options.same_mesh, "teeth in contact have the mesh of annulus (three times the nodes)");
  cli.add_flag("--rigid-phase", options.rigid_phase,
               "CalculiX stands where the rigid gears do: the shares then differ");
  cli.add_option("--contact-stiffness", options.contact_stiffness, "penalty of CalculiX, Pa/m")->capture_default_str();
  cli.add_option("--threads", options.threads, "for both programs")->capture_default_str();
  cli.add_flag("--keep", options.keep, "keep CalculiX's files");
  CLI11_PARSE(cli, argc, argv);
  if (!benchmarks::calculix_is_installed()) {
    fmt::print("CalculiX (ccx) is not installed: nothing to compare with\n");
    return 77;
  }
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("annulus_stage_{}", getpid());
  app::RunOptions run;
  run.out = folder;
  run.threads = options.threads;
  const benchmarks::Stopwatch watch;
  const auto straight_scene = app::parse_scene(scene_text(0), "calculix_stage.toml");
  const auto displaced_scene = app::parse_scene(scene_text(pin_error * 1e6), "calculix_stage.toml");
  const auto geometry = app::make_geometry(straight_scene);
  const auto straight = app::solve_statics(straight_scene, geometry, run);
  const auto displaced = app::solve_statics(displaced_scene, app::make_geometry(displaced_scene), run);
  fmt::print("annulus solves {} positions twice in {:.1f} s ({:.1f} s of processor time)\n",
             straight.rings.front().turn.positions.size(), watch.wall(), watch.cpu());
  fmt::print("{:>9} {:>6} {:>23} {:>23} {:>9} {:>9} {:>9} {:>9} {:>7} {:>6} {:>8} {:>8}\n", "position", "error",
             "shares, annulus", "shares, ccx", "differ.", "sun urad", "ccx urad", "relative", "nodes", "iter.",
             "wall s", "cpu s");
  bool agree = true;
  for (const double position : options.positions)
    agree = compare(straight_scene, geometry.rings.front(), straight, displaced, position, options) && agree;
  std::filesystem::remove_all(folder);
  return agree ? EXIT_SUCCESS : EXIT_FAILURE;
}
