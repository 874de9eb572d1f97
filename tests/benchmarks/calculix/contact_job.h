#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/calculix/quadratic_body.h"
#include "fem/problem/material.h"

namespace annulus::benchmarks {

/// Plane-strain contact of two bodies for CalculiX: the wheel's support held, the hub of the planet turned rigidly
/// about its axis by given angles, one static step each. Small displacements; contact surface to surface.
struct ContactJob {
  const QuadraticBody* planet = nullptr;  ///< in position
  const QuadraticBody* wheel = nullptr;
  Eigen::Vector2d planet_axis = Eigen::Vector2d::Zero();  ///< m
  geometry::Boundary planet_flank = geometry::Boundary::leading_flank;
  geometry::Boundary wheel_flank = geometry::Boundary::trailing_flank;
  std::vector<std::pair<int, int>> pairs{};  ///< teeth that may touch, planet and wheel
  fem::Material material{};
  double contact_stiffness = 0;         ///< Pa/m, slope of pressure over overclosure
  std::vector<double> hub_rotations{};  ///< rad, one per step
  int threads = 1;
};

struct ContactJobResult {
  std::vector<double> torque{};  ///< N m per m of width about the planet's axis, on the hub, one per step
  double wall_seconds = 0, cpu_seconds = 0;
  int iterations = 0;     ///< equilibrium iterations of all steps
  std::string failure{};  ///< empty when the run was completed
};

[[nodiscard]] bool calculix_is_installed();
/// Runs the job in `folder`, which is created.
[[nodiscard]] ContactJobResult run_calculix(const ContactJob& job, const std::filesystem::path& folder);

}  // namespace annulus::benchmarks
