#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/scene/scene.h"
#include "app/systems/helical_pair/pair_input.h"
#include "app/systems/shared/friction.h"
#include "core/face_shape.h"
#include "dynamics/steady_state/steady_response.h"
#include "dynamics/systems/helical_pair/helical_pair.h"
#include "geometry/gear_pair.h"

/// A helical pair as geometry and as lumped masses.
namespace annulus::app {

/// What follows from the scene without computing an elastic body.
struct PairGeometry {
  geometry::GearPair gears;
  double base_helix_angle = 0;  ///< rad, without its sign
  double transverse_force = 0;  ///< N, magnitude, along the transverse line of action: torque / base radius

  [[nodiscard]] const geometry::Gear& pinion() const { return gears.pinion(); }
  [[nodiscard]] const geometry::Gear& wheel() const { return gears.wheel(); }
  /// N/m along the normal of the flanks = this x N/m along the transverse line of action: the normal force is larger by
  /// 1/cos b, the normal deflection smaller by cos b.
  [[nodiscard]] double to_normal() const;
};

/// What is known of the flanks besides the stiffness.
struct PairFlanks {
  std::shared_ptr<const FaceShape> face{};  ///< of solid gears in space, or null
  PairShares shares{};
};
[[nodiscard]] RollingMesh rolling_mesh(const Scene& scene, const PairGeometry& geometry);

/// Throws GeometryError, naming the gear, when the gears cannot exist or mesh.
[[nodiscard]] PairGeometry make_pair_geometry(const Scene& scene);

/// m: the given centre distance, else the one without backlash at these profile shifts.
[[nodiscard]] double pair_centre_distance(const Scene& scene);
/// kg m^2: the given inertia, else that of a solid disc of the reference radius; nothing without a mass.
[[nodiscard]] std::optional<double> pair_inertia(const Scene& scene, const PairGearInput& gear);

/// The lumped model. `mesh_error`: amplitude at mesh frequency, m. Throws
/// InternalError without [dynamics].
[[nodiscard]] dynamics::HelicalPair make_pair(const Scene& scene, const PairGeometry& geometry,
                                              const dynamics::MeshExcitation& mesh, double mesh_error,
                                              const PairFlanks& flanks = {});
[[nodiscard]] dynamics::SimulationOptions pair_simulation(const Scene& scene);

}  // namespace annulus::app
