#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "fem/contact/contact_body.h"
#include "fem/contact/flank_contact.h"
#include "fem/contact/pin_row.h"
#include "fem/loaded_mesh.h"
#include "fem/resolution.h"

namespace annulus::fem {

/// The two condensed bodies of a loaded mesh at one level of resolution, ready for contact.
struct MeshBodies {
  std::unique_ptr<ContactBody> planet, wheel;
  std::optional<PinRow> pins;
  std::vector<double> slice_edges;
  geometry::Mesh planet_sector, wheel_sector;
  long unknowns = 0;
  double mesh_seconds = 0, condense_seconds = 0;
};

[[nodiscard]] MeshBodies build_bodies(const LoadedMeshProblem& problem, const FlankContact& flanks,
                                      const LoadedMeshSettings& settings, int level);

/// Stiffness of one pin between two conforming half-grooves, N/m: a solid cylinder of diameter D squeezed over its
/// full width behaves like a prism of its mean width pi D / 4 and height D, k = pi E L / (4 (1 - nu^2)). An estimate:
/// it leaves out the local compliance of a real housing.
[[nodiscard]] double derived_pin_stiffness(const Material& material, double length);

}  // namespace annulus::fem
