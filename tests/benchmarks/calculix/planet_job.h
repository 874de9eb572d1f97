#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/calculix/quadratic_body.h"
#include "fem/problem/material.h"

namespace annulus::benchmarks {

/// Equal arcs around a bore, each on a spring that only presses.
struct RollerBed {
  int patches = 0;
  double first_angle = 0;  ///< rad, middle of the first one
  double stiffness = 0;    ///< N/m, of one
  double play = 0;         ///< m
  /// N, outwards on the bore, at the mean displacement u of a patch outwards.
  [[nodiscard]] double force(double u) const { return -u > play ? stiffness * (-u - play) : 0; }
};

/// Forces on nodes of a body, N of the whole width.
using NodeForces = std::map<int, Eigen::Vector2d>;

/// One gear in plane strain whose bore lies on rollers, under given forces without a torque about its axis; and how
/// more forces displace it from there, whose torque an even traction around the bore takes.
struct PlanetJob {
  QuadraticBody body;  ///< around the origin
  RollerBed bed;
  NodeForces load, more;
  double face_width = 0;  ///< m
  fem::Material material{};
  int threads = 1;
};

struct PlanetJobResult {
  std::vector<double> rollers;        ///< N, of every patch under `load`
  std::map<int, double> bore_stress;  ///< Pa, along the bore, of its nodes under `load`
  /// m, by `more`, of the nodes that are loaded, less the mean rotation of the bore.
  std::map<int, Eigen::Vector2d> displacements;
  double cpu_seconds = 0;
  int solves = 0;  ///< until the patches that press agree with their displacements
  std::string failure{};
};

/// Runs the job in `folder`, which is created. CalculiX solves it with the springs of the patches that press, linear,
/// until these are the right ones: its own one-sided springs, none of which presses at the start, let the gear fly.
[[nodiscard]] PlanetJobResult run_calculix(const PlanetJob& job, const std::filesystem::path& folder);

}  // namespace annulus::benchmarks
