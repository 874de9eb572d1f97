#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/body/body_plan.h"
#include "fem/condensation/cyclic_flexibility.h"
#include "fem/elasticity/arc_load.h"
#include "fem/elasticity/inertia_loads.h"
#include "fem/problem/superelement_cache.h"

namespace annulus::fem {

/// A ring reduced to what its meshes feel of each other: a smooth unit force on every tooth, the inertia of every
/// sector, and the loads of its supports. All in the frame of the solve, the mirror image of the real ring.
///
/// Loads of a sector, in this order: 0 the mesh force, along the line of action into the flank, its centre where the
/// teeth touch at the pitch point, even over a part of the flank and over the face width (the far field is meant: what
/// it does to its own tooth is not that of a contact); then the inertia of the motions (inertia_loads); then arcs.
struct RingFlexibility {
  int teeth = 0;
  double pitch_angle = 0;
  double base_radius = 0;
  int motions = 0, arcs = 0;
  CyclicFlexibility compliance;  ///< m/N; of inertia loads in kg^1/2 instead of N
  /// Resultants (x, y, moment about the axis) of unit loads in the sector's frame: 3 x loads. Those of inertia loads
  /// are at the same time their work on unit rigid motions (x, y, rotation).
  Eigen::Matrix3Xd resultants;
  long unknowns = 0;
  bool reused = false;  ///< the sector was read from the store

  [[nodiscard]] int first_motion() const { return 1; }
  [[nodiscard]] int first_arc() const { return 1 + motions; }
  /// Resultants of loads first ... first + count - 1 of sector `sector` in the frame of sector 0.
  [[nodiscard]] Eigen::Matrix3Xd resultants_of(int sector, int first, int count) const;
};

struct RingFlexibilityOptions {
  double roll = 0;  ///< m, of the ring at the pitch point
  double face_width = 0;
  double overhang = 0;  ///< m, of the teeth beyond that face: a plane body is as wide as both
  bool solid = false;   ///< whether sectors are solid
  MotionOrder motions;
  std::vector<ArcLoad> arcs;
  int threads = 1;
  const ResultStore* store = nullptr;  ///< where tooth superelements are cached; may be null
};

[[nodiscard]] RingFlexibility make_ring_flexibility(const BodyPlan& plan, const BodyResolution& resolution,
                                                    const Material& material, const RingFlexibilityOptions& options);

/// A sector condensed for the loads of a flexibility.
struct FlexibleSector {
  CondensedSector sector;
  Eigen::Matrix3Xd resultants;  ///< of its acting loads
  long unknowns = 0;
};

/// Its steps: the loads of a sector that has its nodal mass (and its outside, for arcs), and their compliance in
/// the ring.
[[nodiscard]] SectorLoads ring_loads(const SectorModel& model, const geometry::ToothProfile& profile,
                                     geometry::Boundary flank, const RingFlexibilityOptions& options);
[[nodiscard]] RingFlexibility compose_flexibility(const SectorModel& model, const SectorLoads& loads,
                                                  const geometry::Gear& gear, SectorSupport support,
                                                  const RingFlexibilityOptions& options);
[[nodiscard]] RingFlexibility compose_flexibility(const FlexibleSector& sector, const geometry::Gear& gear,
                                                  SectorSupport support, const RingFlexibilityOptions& options);

}  // namespace annulus::fem
