#pragma once

namespace annulus::fem {

/// Which model of a mesh is wanted. `automatic`: the cheapest one that the mesh and the accuracy permit; `resolved`:
/// teeth meshed anew for every contact, in the plane where nothing changes along the face width.
enum class WantedModel { automatic, closed_form, plane, solid, resolved };

}  // namespace annulus::fem
