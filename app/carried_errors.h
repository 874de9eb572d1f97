#pragma once

#include <functional>
#include <vector>

#include "app/mesh_result.h"
#include "dynamics/response.h"

namespace annulus::app {

/// What the error of a dynamic figure is made of; all absolute, NaN where not known.
struct FigureErrors {
  double solution = 0;       ///< of the solution in time (dynamics::Figure as simulated)
  double stiffness = 0;      ///< what the error estimates of the stiffness tables do to the figure
  double interpolation = 0;  ///< what the tables' finite number of phases does
  /// The causes are independent and may add up. NaN when a part is not known.
  [[nodiscard]] double total() const { return solution + stiffness + interpolation; }
};

struct MeshKindErrors {
  FigureErrors instantaneous, averaged, quasi_static;  ///< load sharing
  std::vector<FigureErrors> dynamic_factor_max;        ///< one per planet
};

struct ResponseErrors {
  MeshKindErrors sun_planet, ring_planet;
};

/// The stage on these mesh stiffnesses, all else being the same.
using StageMaker = std::function<dynamics::PlanetaryStage(const MeshResult& sun_mesh, const MeshResult& ring_mesh)>;

/// The stiffnesses of a stage, and how it is made from them.
struct StageTables {
  StageMaker make;
  const MeshResult &sun_mesh, &ring_mesh;
};

/// The parts of the error of every figure of `nominal`, which was simulated with `options` on `tables`. The stage is
/// solved again on changed tables (core/table_variants.h), without time integration where the nominal response agreed
/// with the harmonic balance (marched for 330 mesh cycles where it has no periodic steady state within the longest
/// window), and compared with the unchanged tables solved the very same way:
/// - stiffness: largest |difference| with the stiffness or its ripple raised by its error estimate, sun mesh plus ring
///   mesh;
/// - interpolation: |difference| with every second phase only, both meshes, / 3: the curves between the phases are of
///   second order. Not known for an odd number of phases.
/// Stiffness given as a wave is exact. A part is not known where a changed stage has no steady state but the nominal
/// one has, or cannot be solved.
[[nodiscard]] ResponseErrors carried_errors(const dynamics::DynamicResponse& nominal,
                                            const dynamics::SimulationOptions& options, const StageTables& tables);

/// Makes Figure::error the total of the parts.
void set_errors(const ResponseErrors& errors, dynamics::DynamicResponse& response);

}  // namespace annulus::app
