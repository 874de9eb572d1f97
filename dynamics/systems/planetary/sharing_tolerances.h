#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/statistics/statistics.h"
#include "dynamics/systems/planetary/planetary_stage.h"

/// Load sharing of stages that are made within tolerances.
namespace annulus::dynamics {

/// How deviations are distributed in their zones.
enum class WithinZone {
  normal,  ///< every coordinate normal, its standard deviation a third of the radius, cut at the zone
  uniform  ///< every point of the zone as likely as any other
};

/// Each deviation is a vector that lies in a circle, the zone of its tolerance: its radius in m. 0: no deviation.
struct StageTolerances {
  double planet_pin_position = 0;  ///< of every planet for itself
  double sun_eccentricity = 0, planet_eccentricity = 0, ring_eccentricity = 0;
  WithinZone within = WithinZone::normal;
};

/// The stage with deviations drawn for one of many assemblies; they replace those of the same kind. A draw depends on
/// seed, assembly and deviation alone: a zone changed leaves the directions, and the places in all other zones.
[[nodiscard]] PlanetaryStage drawn_assembly(const PlanetaryStage& stage, const StageTolerances& tolerances,
                                            std::uint64_t seed, int assembly);

/// K_γ in quasi-static equilibrium: N |F_n| / Σ|F|, its maximum over planets and mesh cycles, the forces averaged over
/// the mesh cycle first, at several shares of the torque. (Without inertia, the sun and the ring mesh of a planet carry
/// the same force.)
///
/// Which mesh cycle of the error period is the worst for each planet follows from the linear response of the forces to
/// the errors. Only these cycles are solved, with backlash and load dependence. Throws what StaticSolver throws.
struct ErrorPeriodSharing {
  std::vector<double> factors;  ///< K_γ by share of the torque
  double largest_force = 0;     ///< N, of any planet, averaged over its mesh cycle
};
[[nodiscard]] ErrorPeriodSharing error_period_sharing(const PlanetaryStage& stage,
                                                      const std::vector<double>& torque_shares);

struct AssemblyOptions {
  int assemblies = 1000;
  std::uint64_t seed = 1;
  std::vector<double> torque_shares = {1};  ///< of the stage's torque, positive
  int threads = 1;
};

/// Distribution of K_γ over assemblies: quantiles with their intervals for the finite number of draws.
struct SharingQuantiles {
  Interval p50, p95, p99;
};

struct AssemblySharing {
  std::vector<double> torque_shares;         ///< rising; 1 is among them
  std::vector<std::vector<double>> factors;  ///< [torque share][assembly]
  std::vector<SharingQuantiles> quantiles;   ///< by torque share
  /// At the torque of the stage, by the tolerances that are not zero: all others zero, and this one zero.
  struct Contribution {
    std::string tolerance;  ///< name of the member of StageTolerances
    double radius = 0;      ///< m
    SharingQuantiles alone, without;
  };
  std::vector<Contribution> contributions;
  double largest_force = 0;  ///< N, of all assemblies and torques, averaged over a mesh cycle

  [[nodiscard]] std::size_t nominal() const;  ///< index of the torque share 1
};
/// K_γ of many assemblies. The result does not depend on the number of threads. Throws InputError without a tolerance,
/// with fewer than two assemblies or a share that is not positive, SolverError naming the assembly.
[[nodiscard]] AssemblySharing assembly_sharing(const PlanetaryStage& stage, const StageTolerances& tolerances,
                                               const AssemblyOptions& options);

}  // namespace annulus::dynamics
