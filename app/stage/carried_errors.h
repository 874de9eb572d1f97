#pragma once

#include <functional>
#include <vector>

#include "app/stage/mesh_result.h"
#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// Absolute errors of the figures of one kind of mesh, NaN where not known.
struct MeshKindErrors {
  ErrorParts instantaneous, averaged, quasi_static;  ///< load sharing
  std::vector<ErrorParts> dynamic_factor_max;        ///< one per planet
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
/// with the harmonic balance, otherwise marched from the nominal motion (for 330 mesh cycles where it has no periodic
/// steady state within the longest window), and compared with the unchanged tables solved the very same way:
/// - discretisation, contact, condensation, model: largest |difference| with the stiffness or its ripple raised by its
///   error estimate, divided in the proportions of the stiffness' own parts (all discretisation where a table does not
///   tell them), sun mesh plus ring mesh;
/// - interpolation: |difference| with every second phase only, both meshes, / 2: the curves between the phases are of
///   an order between one (where slopes jump) and two. Not known for an odd number of phases;
/// - integration: as simulated.
/// Stiffness given as a wave is exact. A part is not known where a changed stage has no steady state but the nominal
/// one has, or cannot be solved.
[[nodiscard]] ResponseErrors carried_errors(const dynamics::DynamicResponse& nominal,
                                            const dynamics::SimulationOptions& options, const StageTables& tables);

/// Makes Figure::error the total of the parts.
void set_errors(const ResponseErrors& errors, dynamics::DynamicResponse& response);

}  // namespace annulus::app
