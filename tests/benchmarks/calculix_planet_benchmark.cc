// A thin planet on rollers against CalculiX, on the same mesh: the planet whole, its rollers as one-sided springs,
// under the contact forces that annulus found in one mesh and those of the other one where theory puts them. Compared
// are the loads of the rollers, the stress of the bore, and how far the force of the other mesh deflects this one. Exit
// status 77: CalculiX is not installed.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "app/model/mesh_solve.h"
#include "app/plan/mesh_model.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/systems/planetary/stage_geometry.h"
#include "benchmarks/calculix/contact_job.h"
#include "benchmarks/calculix/planet_job.h"
#include "core/errors.h"
#include "core/radial_bearing.h"

namespace {

using namespace annulus;
using benchmarks::NodeForces;
using benchmarks::QuadraticBody;
using geometry::Boundary;

/// Of the largest load of a roller, of the largest stress, and of the deflection of the mesh by both forces.
constexpr double roller_accuracy = 0.01, stress_accuracy = 0.03, coupling_accuracy = 0.02;

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
  double bore_mm = 54, clearance_um = 30;
  std::vector<double> phases{0.25, 0.75};
  int threads = 2;
  bool keep = false;
};

/// Where a force stands on a flank and how it is directed.
struct FlankForce {
  Eigen::Vector2d place, along;  ///< m; unit vector
  double force = 0;              ///< N
  int tooth = 0;
};

/// The two meshes of the planet, seen in the frame of its tooth 0 at one position: this one turns it clockwise, the
/// other one back.
class PlanetForces {
 public:
  PlanetForces(const fem::LoadedMeshProblem& problem, const fem::LoadedPosition& position)
      : problem_(problem), position_(position), planet_(problem.pair.pinion()) {
    half_ = planet_.tooth_half_angle(planet_.base_radius());
  }

  /// Contact forces that were found.
  [[nodiscard]] std::vector<FlankForce> own() const {
    const double base = planet_.base_radius();
    std::vector<FlankForce> forces;
    for (const auto& patch : position_.pressure) {
      const double theory = position_.pair_roll.at(static_cast<std::size_t>(patch.pair));
      const double foot = angle_of(foot_of(own_direction(), -1)) + theory / base - half_;
      const auto tooth = static_cast<int>(std::lround(foot / planet_.pitch_angle()));
      const double roll = (patch.roll_low + patch.roll_high) / 2,
                   at = tooth * planet_.pitch_angle() + half_ - roll / base;
      const Eigen::Vector2d foot_point(base * std::cos(at), base * std::sin(at)), along(std::sin(at), -std::cos(at));
      const double arc = roll / base * (patch.roll_high - patch.roll_low);
      forces.push_back(
          {foot_point - roll * along, along, patch.pressure * arc * (patch.z_high - patch.z_low), counted(tooth)});
    }
    // Pressures are means over pieces of the flank: their sum misses the load by some 1e-4.
    const double total = std::accumulate(forces.begin(), forces.end(), 0.0,
                                         [](double sum, const FlankForce& f) { return sum + f.force; });
    require(std::abs(total / position_.load - 1) < 1e-3,
            fmt::format("contact pressures add up to {:.6g} N, the load is {:.6g} N", total, position_.load));
    for (auto& force : forces) force.force *= position_.load / total;
    return forces;
  }
  /// Forces of the other mesh, as large, shared by its pairs by a parabola over its path of contact.
  [[nodiscard]] std::vector<FlankForce> other() const {
    const auto& pair = problem_.planet_rollers->partner;
    const Eigen::Vector2d along = other_direction(), foot = foot_of(along, 1);
    std::vector<FlankForce> forces;
    double sum = 0;
    for (int tooth = 0; tooth < planet_.teeth(); ++tooth) {
      const double roll = planet_.base_radius() *
                          std::remainder(angle_of(foot) - tooth * planet_.pitch_angle() + half_, 2 * std::numbers::pi);
      if (roll <= pair.roll_length_low() || roll >= pair.roll_length_high()) continue;
      const double share = (roll - pair.roll_length_low()) * (pair.roll_length_high() - roll);
      forces.push_back({foot - roll * along, along, share * position_.load, tooth});
      sum += share;
    }
    for (auto& force : forces) force.force /= sum;
    return forces;
  }
  [[nodiscard]] Eigen::Vector2d own_direction() const {
    const double angle = problem_.pair.working_pressure_angle();
    return turned(internal() ? Eigen::Vector2d(-std::sin(angle), -std::cos(angle))
                             : Eigen::Vector2d(std::sin(angle), std::cos(angle)));
  }
  [[nodiscard]] Eigen::Vector2d other_direction() const {
    const double angle = problem_.planet_rollers->partner.working_pressure_angle();
    return turned(internal() ? Eigen::Vector2d(std::sin(angle), -std::cos(angle))
                             : Eigen::Vector2d(-std::sin(angle), std::cos(angle)));
  }

 private:
  [[nodiscard]] bool internal() const { return problem_.pair.internal(); }
  [[nodiscard]] Eigen::Vector2d turned(const Eigen::Vector2d& v) const {
    return Eigen::Rotation2Dd(-position_.pinion_angle) * v;
  }
  /// From 0 on.
  [[nodiscard]] int counted(int tooth) const { return (tooth % planet_.teeth() + planet_.teeth()) % planet_.teeth(); }
  static double angle_of(const Eigen::Vector2d& v) { return std::atan2(v.y(), v.x()); }
  /// Where a line of action touches the base circle; `turn`: 1 if its force turns the planet counter-clockwise.
  [[nodiscard]] Eigen::Vector2d foot_of(const Eigen::Vector2d& along, int turn) const {
    return turn * planet_.base_radius() * Eigen::Vector2d(along.y(), -along.x());
  }

  const fem::LoadedMeshProblem& problem_;
  const fem::LoadedPosition& position_;
  const geometry::Gear& planet_;
  double half_;
};

/// Puts forces on the flanks of a body, by the shape functions of the sides they stand on.
NodeForces on_nodes(const QuadraticBody& body, const std::vector<FlankForce>& forces) {
  NodeForces nodes;
  for (const auto& f : forces) {
    double nearest = std::numeric_limits<double>::infinity(), at = 0;
    std::array<int, 3> side_nodes{};
    for (const auto& side : body.sides) {
      if (side.boundary != Boundary::leading_flank && side.boundary != Boundary::trailing_flank) continue;
      const auto& cell = body.cells[side.cell];
      const std::array<int, 3> n{cell[side.number], cell[4 + side.number], cell[(side.number + 1) % 4]};
      const Eigen::Vector2d chord = body.nodes[n[2]] - body.nodes[n[0]];
      const double t = std::clamp(chord.dot(f.place - body.nodes[n[0]]) / chord.squaredNorm(), 0.0, 1.0);
      const double distance = (body.nodes[n[0]] + t * chord - f.place).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      at = 2 * t - 1;
      side_nodes = n;
    }
    constexpr double on_the_flank = 50e-6;  // m: sides are chords here
    require(nearest < on_the_flank, fmt::format("a force stands {:.3g} m beside the flanks", nearest));
    const std::array<double, 3> shares{at * (at - 1) / 2, 1 - at * at, at * (at + 1) / 2};
    for (std::size_t i = 0; i < shares.size(); ++i)
      nodes.emplace(side_nodes[i], Eigen::Vector2d::Zero()).first->second += shares[i] * f.force * f.along;
  }
  return nodes;
}

/// Of a round rim on its bed: m/N, deflection along `own` by a force along `other`, at the place of a `load` along
/// both.
double round_rim(const benchmarks::RollerBed& bed, double stiffness, const Eigen::Vector2d& own,
                 const Eigen::Vector2d& other, double load) {
  const Eigen::Vector2d force = load * (own + other);
  const Eigen::Vector2d moved = RadialBearing(stiffness, bed.play).distance(force.norm()) * force.normalized();
  Eigen::Matrix2d tangent = Eigen::Matrix2d::Zero();
  for (int i = 0; i < bed.patches; ++i) {
    const double angle = bed.first_angle + i * 2 * std::numbers::pi / bed.patches;
    const Eigen::Vector2d outwards(std::cos(angle), std::sin(angle));
    if (-outwards.dot(moved) > bed.play) tangent += bed.stiffness * outwards * outwards.transpose();
  }
  return own.dot(tangent.inverse() * other);
}

bool compare(const app::MeshModel& model, const fem::LoadedMeshResult& solved, double phase, const Options& options) {
  const auto& problem = *model.problem;
  const double load = problem.loads[model.nominal_load()];
  const auto found = std::find_if(solved.positions.begin(), solved.positions.end(), [&](const auto& p) {
    return p.load == load && std::abs(p.mesh_phase - phase) < 1e-9;
  });
  require(found != solved.positions.end(), fmt::format("no position at the phase {}", phase));
  const auto& position = *found;
  require(position.pinion_stress.has_value(), "no stress");
  const auto& gear = problem.pair.pinion();
  const PlanetForces planet(problem, position);
  const auto own_forces = planet.own(), other_forces = planet.other();
  std::set<int> loaded;
  for (const auto* forces : {&own_forces, &other_forces})
    for (const auto& force : *forces) loaded.insert(force.tooth);

  benchmarks::PlanetJob job;
  job.body =
      benchmarks::make_gear(geometry::ToothProfile(gear), solved.pinion_sector, problem.pinion_bore_radius, loaded);
  const auto patches = static_cast<int>(position.rollers.size());
  const double spacing = 2 * std::numbers::pi / patches, stiffness = problem.planet_rollers->stiffness;
  job.bed = {patches, (spacing - gear.pitch_angle()) / 2, 4 * stiffness / patches, problem.planet_rollers->play};
  job.material = problem.materials.pinion;
  job.face_width = problem.face_width;
  job.threads = options.threads;
  const auto own = on_nodes(job.body, own_forces), other = on_nodes(job.body, other_forces);
  job.load = own;
  for (const auto& [node, force] : other) job.load.emplace(node, Eigen::Vector2d::Zero()).first->second += force;
  job.more = other;

  const auto folder = std::filesystem::temp_directory_path() / fmt::format("annulus_calculix_planet_{}", getpid());
  const auto peer = run_calculix(job, folder);
  if (!peer.failure.empty()) {
    fmt::print("{} mesh, phase {:.4f}: {}\n", model.mesh, phase, peer.failure);
    return false;
  }
  if (!options.keep) std::filesystem::remove_all(folder);
  const double largest = *std::max_element(position.rollers.begin(), position.rollers.end());
  double rollers = 0;
  for (std::size_t i = 0; i < position.rollers.size(); ++i)
    rollers = std::max(rollers, std::abs(position.rollers[i] - peer.rollers[i]) / largest);
  const auto [low, high] = std::minmax_element(peer.bore_stress.begin(), peer.bore_stress.end(),
                                               [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto& stress = *position.pinion_stress;
  const double tension = stress.rim_tension / high->second - 1, compression = stress.rim_compression / low->second - 1;
  double deflection = 0;
  for (const auto& [node, force] : own) deflection += force.dot(peer.displacements.at(node)) / load / load;
  const double coupling =
      deflection - round_rim(job.bed, stiffness, planet.own_direction(), planet.other_direction(), load);
  const double through = (position.partner_compliance - coupling) * position.entry.stiffness_tangent;
  fmt::print(
      "{:>10} {:>6.3f} {:>9.1f} {:>8.4f} {:>8.2f} {:>8.2f} {:>8.4f} {:>8.2f} {:>8.2f} {:>8.4f} {:>10.3e} "
      "{:>10.3e} {:>8.4f} {:>7} {:>6} {:>6.1f}\n",
      model.mesh, phase, largest, rollers, stress.rim_tension / 1e6, high->second / 1e6, tension,
      stress.rim_compression / 1e6, low->second / 1e6, compression, position.partner_compliance, coupling, through,
      job.body.nodes.size(), peer.solves, peer.cpu_seconds);
  std::fflush(stdout);
  return rollers < roller_accuracy && std::abs(tension) < stress_accuracy && std::abs(compression) < stress_accuracy &&
         std::abs(through) < coupling_accuracy;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App cli{"a thin planet on rollers under both its meshes, against CalculiX"};
  cli.add_option("--bore", options.bore_mm, "of the planet, mm; the root circle has 66")->capture_default_str();
  cli.add_option("--clearance", options.clearance_um, "of the rollers, um")->capture_default_str();
  cli.add_option("--phases", options.phases, "of each mesh, in sixteenths of a cycle")->capture_default_str();
  cli.add_option("--threads", options.threads, "for both programs")->capture_default_str();
  cli.add_flag("--keep", options.keep, "keep CalculiX's files");
  CLI11_PARSE(cli, argc, argv);
  if (!benchmarks::calculix_is_installed()) {
    fmt::print("CalculiX (ccx) is not installed: nothing to compare with\n");
    return 77;
  }
  const auto scene = app::parse_scene(scene_text(options.bore_mm, options.clearance_um), "calculix_planet.toml");
  const auto geometry = app::make_geometry(scene);
  app::RunOptions run;
  run.threads = options.threads;
  fmt::print("{:>10} {:>6} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10} {:>10} {:>8} {:>7} {:>6} {:>6}\n",
             "mesh", "phase", "roller N", "differs", "tension", "ccx MPa", "relative", "compr.", "ccx MPa", "relative",
             "other m/N", "ccx m/N", "differs", "nodes", "solves", "cpu s");
  bool agree = true;
  for (const auto& model : {app::sun_mesh_model(scene, geometry), app::ring_mesh_model(scene, geometry, 0)}) {
    const auto solved = app::solve_contact(model, run);
    for (const double phase : options.phases) agree = compare(model, solved, phase, options) && agree;
  }
  return agree ? EXIT_SUCCESS : EXIT_FAILURE;
}
