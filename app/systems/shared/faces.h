#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/model/run_options.h"
#include "app/plan/warning.h"
#include "app/scene/scene.h"
#include "dynamics/spatial/linear_supports.h"
#include "fem/solid_face.h"
#include "geometry/gear_pair.h"

/// Meshes along their faces, for bodies that tilt.
namespace annulus::app {

inline constexpr double place_rounding = 1e-9;  ///< of widths and offsets in millimetres

/// m, z of the middle of the common face.
[[nodiscard]] double place_of_face(const geometry::GearPair& pair);
/// Lead modifications and misalignment, m, normal to the flanks, at places on the common face from its middle.
[[nodiscard]] std::vector<double> gaps_along(const geometry::GearPair& pair, double misalignment,
                                             const std::vector<double>& stations);
/// A computed table has its modifications and misalignment in its stiffness.
[[nodiscard]] bool gaps_in_table(const MeshInput& input);

/// Stretches of a face that is no solid one, between whose ends the load is found.
inline constexpr int face_stretches = 24;
/// Their ends, m from the middle, and what the flanks are apart there.
struct EvenStations {
  std::vector<double> at, gap;
};
[[nodiscard]] EvenStations even_stations(const geometry::GearPair& pair, const MeshInput& input, double misalignment,
                                         int stretches = face_stretches);

/// N/m along the normal, where any stiffness of the usual size will do: 20 N/(mm um), as [ISO6336-1] takes it for
/// c_gamma of steel gears.
[[nodiscard]] double nominal_mesh_stiffness(const geometry::GearPair& pair);

/// The face of a mesh in the dynamics, with what its flanks are apart along it.
enum class GapsAlong { normal, transverse_section };
[[nodiscard]] dynamics::SpreadFace motion_face(const geometry::GearPair& pair, const MeshInput& input,
                                               const std::shared_ptr<const FaceShape>& shape, double misalignment,
                                               GapsAlong gaps);

/// A computed mesh as solid gears along their face, at the level of its table less `coarser`; null where there is none.
[[nodiscard]] std::shared_ptr<const fem::SolidFace> solid_face(const MeshResult& mesh, const RunOptions& options,
                                                               int coarser = 0);
/// A solved mesh as solid gears along their face; null where it has no solid gears. `mesh_force`: N, in the transverse
/// section.
[[nodiscard]] std::shared_ptr<const FaceShape> face_in_motion(const MeshResult& mesh, double mesh_force,
                                                              const RunOptions& options);

[[nodiscard]] Warning even_faces_warning(const std::string& ring);
/// What is not known of the faces of meshes in motion. `meshes`: each with its name, "sun mesh".
[[nodiscard]] std::vector<Warning> face_warnings(const std::vector<std::pair<std::string, const MeshResult*>>& meshes,
                                                 const std::string& ring);

}  // namespace annulus::app
