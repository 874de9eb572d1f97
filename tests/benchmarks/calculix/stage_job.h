#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/calculix/quadratic_body.h"
#include "fem/problem/material.h"
#include "fem/problem/support_sites.h"

namespace annulus::benchmarks {

/// Patches around a bore that press it outwards, one-sided, from a rigid pin that stands still. They are uniform along
/// their arcs.
struct RollerBed {
  int patches = 0;         ///< equal, the first after the angle of the gear less half a pitch
  double first_angle = 0;  ///< rad, of the first patch
  double stiffness = 0;    ///< N/m, of each
  double play = 0;         ///< m
};

/// A gear on a rigid hub: its bore moves as a rigid body, by small displacements and a small rotation. Or on rollers.
struct HubGear {
  QuadraticBody body;  ///< in position
  Eigen::Vector2d axis = Eigen::Vector2d::Zero();
  std::optional<RollerBed> rollers{};
};

/// Two flanks that may touch. Only the sides nearer than `reach` to the place of the contact become surfaces.
struct FlankPair {
  int planet = 0;
  bool with_ring = false;  ///< else with the sun
  int planet_tooth = 0, wheel_tooth = 0;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< m, of the theoretical contact, or of the end of its path
  double reach = 0;                                 ///< m
};

/// One state of a stage: what is prescribed in a step of CalculiX.
struct StageStep {
  /// rad, of the hubs of the sun and the planets; absent: the planets turn freely and the sun is under its torque. The
  /// rotation of a planet on rollers is the mean one of its bore, its torque an even traction there.
  std::vector<double> rotations{};
  std::vector<Eigen::Vector2d> pin_errors{};  ///< m, displacements of the planets' pins; absent: none
};

/// A plane-strain stage of spur gears, all bodies and all meshes in one model, per metre of width: a sun whose axis
/// stands still under a torque, planets on elastic bearings, a ring on two-sided springs (SupportSites) or, without
/// any, held at its outside. Small displacements; contact surface to surface without friction. The first step should
/// prescribe rotations near the equilibrium: free planets without contact would be singular.
struct StageJob {
  HubGear sun;
  std::vector<HubGear> planets;
  QuadraticBody ring;
  fem::SupportSites ring_supports;
  double face_width = 0;        ///< m, over which the stiffnesses of supports and the torque are spread
  double planet_stiffness = 0;  ///< N/m, of the bearing of a planet on a hub, in all directions
  double sun_torque = 0;        ///< N m
  std::vector<FlankPair> pairs;
  fem::Material material{};
  double contact_stiffness = 0;  ///< Pa/m
  std::vector<StageStep> steps;
  int threads = 1;
};

struct StageJobState {
  std::vector<Eigen::Vector2d> pin_forces;   ///< N, on the planets on hubs
  std::vector<std::vector<double>> rollers;  ///< N, forces of the patches of every planet; empty on hubs
  double sun_rotation = 0;                   ///< rad
  std::vector<double> planet_rotations;      ///< rad
  std::vector<double> torques;               ///< N m, that hold prescribed rotations: on the sun, then on the planets
};

struct StageJobResult {
  std::vector<StageJobState> states;  ///< at the end of every step
  double wall_seconds = 0, cpu_seconds = 0;
  int iterations = 0;
  std::size_t nodes = 0;
  std::string failure{};
};

/// Runs the job in `folder`, which is created.
[[nodiscard]] StageJobResult run_calculix(const StageJob& job, const std::filesystem::path& folder);

}  // namespace annulus::benchmarks
