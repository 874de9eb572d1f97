#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/calculix/quadratic_body.h"
#include "fem/problem/material.h"
#include "fem/problem/support_sites.h"

namespace annulus::benchmarks {

/// A gear on a rigid hub: its bore moves as a rigid body, by small displacements and a small rotation.
struct HubGear {
  QuadraticBody body;  ///< in position
  Eigen::Vector2d axis = Eigen::Vector2d::Zero();
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
  /// rad, of the hubs of the sun and the planets; absent: the planets turn freely and the sun is under its torque.
  std::vector<double> rotations{};
  std::vector<Eigen::Vector2d> pin_errors{};  ///< m, displacements of the planets' pins; absent: none
};

/// A plane-strain stage of spur gears, all bodies and all meshes in one model, per metre of width: a sun whose axis
/// stands still under a torque, planets on elastic bearings, a ring on two-sided springs (SupportSites). Small
/// displacements; contact surface to surface without friction. The first step should prescribe rotations near the
/// equilibrium: free planets without contact would be singular.
struct StageJob {
  HubGear sun;
  std::vector<HubGear> planets;
  QuadraticBody ring;
  double ring_outside = 0;  ///< m
  fem::SupportSites ring_supports;
  double face_width = 0;        ///< m, over which the stiffnesses of supports and the torque are spread
  double planet_stiffness = 0;  ///< N/m, of a planet's bearing, in all directions
  double sun_torque = 0;        ///< N m
  std::vector<FlankPair> pairs;
  fem::Material material{};
  double contact_stiffness = 0;  ///< Pa/m
  std::vector<StageStep> steps;
  int threads = 1;
};

struct StageJobState {
  std::vector<Eigen::Vector2d> pin_forces;  ///< N, on the planets
  double sun_rotation = 0;                  ///< rad
  std::vector<double> planet_rotations;     ///< rad
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
