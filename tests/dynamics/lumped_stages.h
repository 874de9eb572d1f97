#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>
#include <vector>

#include "dynamics/statics/static_solver.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/systems/planetary/stage_statics.h"
#include "dynamics/systems/planetary/working_point.h"
#include "tests/dynamics/spatial_stages.h"

/// Lumped stages in space, and the mechanisms of the statics that they are compared with.
namespace annulus::dynamics::stages::lumped_in_space {

using Kind = StageBody::Kind;

/// All bodies give way in all directions; the same for all planets.
inline void add_all_bearings(SpatialStage& s) {
  for (int n = 0; n < s.planets(); ++n) {
    const StageBody planet{Kind::planet, n};
    s.bearings.push_back(stages::bearing("upwind row", planet, {Kind::carrier}, -0.06, 2e9, 1e9, 1e5));
    s.bearings.push_back(stages::bearing("downwind row", planet, {Kind::carrier}, 0.07, 2.5e9, 0, 0));
  }
  s.bearings.push_back(stages::bearing("upwind", {Kind::carrier}, {}, -0.35, 3e9, 1e9, 1e7));
  s.bearings.push_back(stages::bearing("downwind", {Kind::carrier}, {}, 0.3, 2e9, 0, 0));
  s.bearings.push_back(stages::bearing("spline", {Kind::sun}, {}, 0.7, 5e7, 3e8, 2e5));
  s.bearings.push_back(stages::bearing("trunnions", {Kind::ring}, {}, 0.05, 4e9, 2e9, 3e8));
}

inline constexpr double sun_stiffness = 3e9, ring_stiffness = 4e9, sun_width = 0.22, ring_width = 0.2275;

/// The lumped stage of a stage in space with even faces of constant stiffness.
inline PlanetaryStage lumped(SpatialStage s) {
  auto& p = s.plane;
  const double c2 = std::pow(std::cos(s.base_helix_angle), 2);
  p.sun_mesh = ConstantStiffness{sun_stiffness * c2};
  p.ring_mesh = ConstantStiffness{ring_stiffness * c2};
  p.sun.inertia = 1.5;
  p.planet.inertia = 2.5;
  p.ring.inertia = 120;
  p.carrier.inertia = 130;
  p.space = space_about_equilibrium(s, {2.1, 90, 110, 1.9});
  p.space->sun_face.width = sun_width;
  p.space->ring_face.width = ring_width;
  p.set_half_backlash(1e-3);  // back flanks far away: driving ones do not pull
  return p;
}

struct SolvedStatics {
  std::vector<double> force, tilt;  ///< per mesh, transverse; tilt: half a face width times the force's moment
};

inline SolvedStatics solved(const PlanetaryStage& stage, double t = 0) {
  const auto system = assemble(stage);
  StaticSolver solver(system);
  auto workspace = system.workspace();
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(system.dofs());
  system.detect_contact(t, start.data(), workspace);
  (void)solver.solve(t, workspace);
  const auto meshes = 2 * static_cast<std::ptrdiff_t>(stage.planets());
  return {{workspace.force.begin(), workspace.force.begin() + meshes},
          {workspace.force.begin() + meshes, workspace.force.begin() + 2 * meshes}};
}

inline StaticTurn statics(const SpatialStage& s, std::vector<double> cycles = {0.0}) {
  StaticSchedule schedule;
  schedule.cycles = std::move(cycles);
  return solve_turn(s, schedule, 1);
}

}  // namespace annulus::dynamics::stages::lumped_in_space
