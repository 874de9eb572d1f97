#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/systems/planetary/spatial_stage.h"

namespace annulus::dynamics {

/// A gear mesh in one position of a stage in equilibrium.
struct StaticMesh {
  double force = 0;                 ///< N, in the transverse section, of driving less back flanks
  double mean_line_load = 0;        ///< N/m, normal to the driving flanks
  double place = 0;                 ///< m, z of the resultant from the middle of the common face
  std::vector<double> line_load{};  ///< N/m, normal to the flanks, at the stations of the face
  bool back_flanks = false;         ///< do they carry?
  /// Largest force per face width over the mean one; 0 without contact.
  [[nodiscard]] double line_load_ratio() const;
};

/// What a bearing bears, in its frame.
struct StaticBearing {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N, on what it supports: it acts against its displacement
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();  ///< N m, about x and y
  double largest_element = 0;                        ///< N, of its rolling elements; 0 without
};

/// Displacement of a body in its own axes: planets radial, tangential; places of a housing that gives way those of the
/// housing; others those of the carrier.
struct StaticBody {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero(), rotation = Eigen::Vector3d::Zero();  ///< m, rad
};

struct StaticPosition {
  double time = 0;  ///< s
  double mesh_cycles = 0;
  double carrier_angle = 0;                             ///< rad, in the housing, from time 0
  std::vector<StaticMesh> sun_meshes{}, ring_meshes{};  ///< one per planet
  std::vector<StaticBearing> bearings{};
  std::vector<StaticBody> bodies{};            ///< sun, ring, carrier, planets, their pins, places of the housing
  double carrier_torque = 0, ring_torque = 0;  ///< N m, on the stage from without; the ring's from the housing
  double residual_relative = 0;
  Eigen::VectorXd motion{};  ///< m, rad: of the mechanism's bodies, 6 each (Mechanism)
};

/// A place of the carrier, with a whole number of mesh cycles before it, and phases of the mesh cycle that follows.
struct StaticSchedule {
  std::vector<double> cycles{0.0};  ///< whole mesh cycles
  int phases = 1;                   ///< of each
  [[nodiscard]] std::size_t positions() const { return cycles.size() * static_cast<std::size_t>(phases); }
};
/// Mesh cycles after which the forces of a stage repeat, but for their change within a cycle: errors, tables, and the
/// housing where it matters. PlanetaryStage::never_repeats where they do not.
[[nodiscard]] int period_of(const SpatialStage& stage);
/// `places` over so many mesh cycles, no more than one in each, and so many phases.
[[nodiscard]] StaticSchedule places_over(int cycles, int places, int phases);

struct StaticTurn {
  StaticSchedule schedule;
  std::vector<StaticPosition> positions;     ///< [place][phase]
  std::vector<std::string> bearing_names{};  ///< of StaticPosition::bearings
  std::vector<std::string> body_names{};
  std::vector<double> sun_stations{}, ring_stations{};  ///< m, of the line loads, from the middle of the common face
};
/// The stage in equilibrium in every position, without inertia; the same on any number of threads. `near`: the turn of
/// a stage that is nearly the same, with the same schedule, which the search starts from.
[[nodiscard]] StaticTurn solve_turn(const SpatialStage& stage, const StaticSchedule& schedule, int threads,
                                    const StaticTurn* near = nullptr);

/// Results of a turn that engineers decide by.
struct StaticFigures {
  /// Of the mean force of all planets: meshes that carry less touch at an end of the face, which says nothing.
  static constexpr double light_mesh = 0.05;
  struct Mesh {
    double sharing = 0;                ///< K_gamma: largest mean over a mesh cycle of a planet over that of all
    double sharing_instantaneous = 0;  ///< largest force of a planet over the mean of all, in any position
    double line_load_ratio = 0;        ///< K_Hbeta: largest of all planets but light meshes, of loads over a mesh cycle
    double line_load_ratio_instantaneous = 0;  ///< in any position
  };
  Mesh sun, ring;
};
[[nodiscard]] StaticFigures figures_of(const StaticTurn& turn);

}  // namespace annulus::dynamics
