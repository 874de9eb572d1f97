#pragma once

#include "app/model/mesh_result.h"
#include "app/scene/scene.h"

/// Stiffness as far as it matters: before a mesh is solved, and beside neighbours.
namespace annulus::app {

/// Rough stiffness of a mesh before it is solved, N/m: the prescribed mean, else that of steel teeth on a face of
/// `face_width` (m).
[[nodiscard]] double rough_stiffness(const Scene& scene, const MeshInput& mesh, double face_width);
/// What is assumed of a stiffness over the mesh cycle.
enum class RoughCourse {
  constant,  ///< periods, steps and DOFs do not depend on it
  rippling   ///< it excites vibrations as one and two pairs of teeth in turn do, of helical gears less
};
/// The mesh with its rough stiffness, before anything is solved. Prescribed waves stay.
[[nodiscard]] MeshInput rough_mesh(const Scene& scene, const MeshInput& mesh, double face_width,
                                   RoughCourse course = RoughCourse::constant);
/// For a mesh whose stiffness is prescribed: a table that nobody reads.
[[nodiscard]] MeshResult unread_table(const std::string& mesh);

/// A support that gives way by less than a thousandth of the wanted accuracy of what acts on it (`neighbours`, N/m)
/// counts as rigid: its DOF would cost steps of its own pace and change nothing.
[[nodiscard]] double rigid_if_stiff(double support, double neighbours, double accuracy);

/// A stiffness between two bodies, bounded by the same rule: more of it changes nothing but the pace.
[[nodiscard]] double as_stiff_as_matters(double stiffness, double neighbours, double accuracy);

}  // namespace annulus::app
