#pragma once

#include "app/scene/scene.h"

namespace annulus::app {

/// A support that gives way by less than a thousandth of the wanted accuracy of what acts on it (`neighbours`, N/m)
/// counts as rigid: its DOF would cost steps of its own pace and change nothing.
[[nodiscard]] double rigid_if_stiff(double support, double neighbours, double accuracy);

/// A stiffness between two bodies, bounded by the same rule: more of it changes nothing but the pace.
[[nodiscard]] double as_stiff_as_matters(double stiffness, double neighbours, double accuracy);

/// The supports of a planetary stage by that rule. `sun_mesh`, `ring_mesh`: mean stiffness of one mesh, N/m.
[[nodiscard]] SupportInput effective_supports(const Scene& scene, double sun_mesh, double ring_mesh);

}  // namespace annulus::app
