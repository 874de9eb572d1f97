#pragma once

#include <memory>
#include <vector>

#include "fem/body/body_source.h"
#include "fem/body/resolution.h"
#include "fem/contact/contact_body.h"
#include "fem/contact/flank_contact.h"
#include "fem/contact/planet_on_rollers.h"
#include "fem/contact/support_row.h"
#include "fem/problem/loaded_mesh_problem.h"
#include "fem/problem/loaded_mesh_result.h"
#include "fem/problem/solved_face.h"
#include "fem/recovery/gauge_recovery.h"
#include "fem/recovery/stress_recovery.h"

namespace annulus::fem {

/// The two condensed bodies of a loaded mesh at one level of resolution, ready for contact, and what they took.
struct MeshBodies : SolveCost {
  std::unique_ptr<CondensedBody> pinion, wheel;
  std::unique_ptr<SupportRow> supports;      ///< of a floating ring
  std::unique_ptr<PlanetOnRollers> rollers;  ///< of a planet on rollers
  std::unique_ptr<StressRecovery> pinion_stress, wheel_stress;
  std::vector<GaugeRecovery> gauges;  ///< on the wheel, as in the problem
  NotchFactors pinion_notch, wheel_notch;
  BodySource pinion_source, wheel_source;
  SolvedFace face;
  std::vector<double> slice_edges;             ///< m, of the solved part of the face
  geometry::Mesh pinion_sector, wheel_sector;  ///< over the whole face
  long unknowns = 0;
};

[[nodiscard]] MeshBodies build_bodies(const LoadedMeshProblem& problem, const FlankContact& flanks,
                                      const LoadedMeshSettings& settings, int level);

}  // namespace annulus::fem
