#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/plan/accuracy_choice.h"
#include "app/plan/gear_geometry.h"
#include "app/plan/ring_structures.h"
#include "app/scene/scene.h"
#include "fem/loaded_mesh.h"

namespace annulus::app {

inline constexpr const char* sun_planet = "sun_planet";
inline constexpr const char* ring_planet = "ring_planet";
inline constexpr const char* pinion_wheel = "pinion_wheel";
inline constexpr const char* arc_pins = "arc_pins";

/// Something decided before computing, and why.
struct Decision {
  std::string what;    ///< "elements"
  std::string choice;  ///< "quadratic"
  std::string reason;
};
/// All that is decided about a mesh.
struct MeshModel;
[[nodiscard]] std::vector<Decision> decisions(const MeshModel& model);

/// "plane", "resolved_solid" ...
[[nodiscard]] const char* fidelity_name(fem::Fidelity fidelity);

/// How the stiffness of one mesh is found, and why so: the decision of the planner, carried out by the pipeline.
struct MeshModel {
  std::string mesh{};  ///< "sun_planet", "ring_planet", "pinion_wheel" or "arc_pins"
  std::string ring{};  ///< empty for the sun mesh, which all rings share
  std::string planet_body = "planet", wheel_body = "ring";  ///< names of its bodies: "pinion"; "sun", "wheel"
  std::string
      fidelity{};  ///< "closed_form", "plane", "solid", "resolved_plane", "resolved_solid", or "given" by the scene
  std::string reason{};                             ///< why this model
  int positions = 1;                                ///< ring positions after which the mesh repeats
  std::string repeats{};                            ///< why so many
  std::string elements{};                           ///< why elements of this degree
  int coupling_degree = 2;                          ///< of the elements that tell how ring meshes act on each other
  std::string phases{};                             ///< why so many positions per mesh cycle
  std::string loads{};                              ///< why so many loads
  std::optional<fem::LoadedMeshProblem> problem{};  ///< absent when the stiffness is given
  fem::LoadedMeshSettings settings{};
  /// Of formulas, as far as it is known beforehand: relative, of the stiffness, what accuracy cannot reduce left out.
  std::optional<double> formula_error{};

  [[nodiscard]] bool computed() const { return problem.has_value(); }
  /// Index of the nominal load among those of a computed mesh: the middle one, at which the accuracy is met.
  [[nodiscard]] std::size_t nominal_load() const { return problem->loads.size() / 2; }
  /// Identity of all inputs this mesh's results depend on.
  [[nodiscard]] std::string id() const;
  [[nodiscard]] const std::string& body_name(bool planet) const { return planet ? planet_body : wheel_body; }
  /// For messages: "sun-planet mesh", "planet mesh of ring 'pinned'".
  [[nodiscard]] std::string label() const;
};

/// Why a mesh needs a solid model: what changes along its face width. Empty when nothing does.
[[nodiscard]] std::string solid_reason(const Scene& scene, const RingInput& ring);  ///< ring-planet mesh
[[nodiscard]] std::string solid_reason(const Scene& scene);                         ///< sun-planet mesh

/// Two external gears on rigid hubs.
struct ExternalMesh {
  std::string mesh;  ///< name of files and tables
  const geometry::GearPair& pair;
  const MeshInput& input;
  const HubGearInput &planet, &wheel;   ///< in the roles they have in the pair
  std::string planet_name, wheel_name;  ///< for people
  double misalignment = 0;              ///< m
  double mean_force = 0;                ///< N, of one mesh
};
[[nodiscard]] MeshModel external_mesh_model(const Scene& scene, const ExternalMesh& mesh);
/// Why it needs a solid model: what changes along its face width. Empty when nothing does.
[[nodiscard]] std::string solid_reason(const Scene& scene, const ExternalMesh& mesh);

[[nodiscard]] MeshModel sun_mesh_model(const Scene& scene, const GearGeometry& geometry);
[[nodiscard]] MeshModel ring_mesh_model(const Scene& scene, const GearGeometry& geometry, std::size_t ring);

}  // namespace annulus::app
