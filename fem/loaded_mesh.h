#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/stiffness_table.h"
#include "fem/material.h"
#include "fem/ring_structure.h"
#include "geometry/gear_pair.h"
#include "geometry/mesh.h"

namespace annulus::fem {

/// A gear mesh to be solved: sun-planet or planet-ring, with the bodies' supports.
struct LoadedMeshProblem {
  geometry::GearPair pair;
  Material material;
  double face_width = 0;                    ///< m, common
  double planet_bore_radius = 0;            ///< m, rigid hub
  double wheel_support_radius = 0;          ///< m: bore of the sun (rigid hub) or outside radius of the ring
  RingStructure structure = OutsideHeld{};  ///< ring mesh only
  std::vector<double> loads;                ///< N, total normal forces, strictly increasing
  int phases = 16;                          ///< positions per mesh cycle
};

enum class Rung { plane, solid };

struct LoadedMeshSettings {
  Rung rung = Rung::plane;
  /// Wanted relative accuracy of the stiffness at the middle load of the table: the mesh is refined until the estimate
  /// of every position meets it. Entries at other loads carry their own estimate.
  double accuracy = 0.01;
  int degree = 2;  ///< polynomial degree of the elements
  /// Forces one level of resolution (1, 2, ...; its error estimated from the level before) instead of refining.
  std::optional<int> level{};
  int threads = 1;                                  ///< changes the time, never the result
  std::function<void(double fraction)> progress{};  ///< called now and then with the finished fraction
};

/// State of one pin at one position.
struct PinState {
  bool touching = false;
  double radial_force = 0;      ///< N, positive presses the pin outwards
  double tangential_force = 0;  ///< N, counter-clockwise on the pin
};

/// One position of the mesh under one load.
struct LoadedPosition {
  double mesh_phase = 0;  ///< [0, 1], 1 included once as the closure check
  int ring_tooth = 0;     ///< whole mesh cycles before this one
  double ring_angle = 0;  ///< rad, of the pitch point in the wheel's own frame
  double load = 0;        ///< N
  StiffnessEntry entry;
  std::vector<double> pair_share;  ///< load share of the tooth pairs, in order of rising planet roll length
  std::vector<double> pair_roll;   ///< m, planet roll length of each pair's theoretical contact point
  double max_pressure = 0;         ///< Pa
  bool tip_edge_contact = false;   ///< the peak pressure stands at a tip edge: singular, not to be compared
  std::vector<PinState> pins;
  double force_balance_relative = 0;   ///< |sum of force x lever arm - torque| / torque
  double energy_balance_relative = 0;  ///< |work of the load - 2 x strain energy - work against the gaps| / work
  double reciprocity_relative = 0;     ///< asymmetry of the compliance between tooth pairs, formed both ways
  double max_penetration = 0;          ///< m
};

struct LoadedMeshResult {
  StiffnessTable table;
  std::vector<LoadedPosition> positions;       ///< at every load, [ring tooth][phase][load], then the closure positions
  double closure_relative = 0;                 ///< |LTE(phase 1) - LTE(phase 0)| / LTE over all loads
  double reciprocity_relative = 0;             ///< largest over the positions
  geometry::Mesh planet_sector, wheel_sector;  ///< as solved
  int level = 1;                               ///< level of resolution reached
  double worst_error_relative = 0;             ///< largest estimated error at the middle load
  long unknowns = 0;                           ///< freedoms of the two sectors
  double pin_stiffness = 0;                    ///< N/m per pin as used; 0 without pins
  double mesh_seconds = 0, condense_seconds = 0, contact_seconds = 0;
};

/// Solves every position. Throws SolverError naming position, load and residual when one does not converge, and when
/// the finest level does not reach the accuracy.
[[nodiscard]] LoadedMeshResult solve_loaded_mesh(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings);

}  // namespace annulus::fem
