#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/plan/gear_geometry.h"
#include "app/scene/scene.h"
#include "fem/choice/mesh_choice.h"
#include "fem/choice/table_choice.h"
#include "fem/loaded_mesh.h"

namespace annulus::app {

/// Something decided before computing, and why.
struct Decision {
  std::string subject;  ///< "elements"
  std::string choice;   ///< "quadratic"
  std::string reason;
};
/// All that is decided about a mesh.
struct MeshModel;
[[nodiscard]] std::vector<Decision> decisions(const MeshModel& model);

/// How the stiffness of one mesh is found, and why so: the decision of the planner, carried out by the pipeline.
struct MeshModel : fem::MeshChoice {
  std::string mesh{};                                      ///< its name in files, keys and tables: "sun_planet"
  std::string title{};                                     ///< for people: "sun-planet mesh"
  std::string variant{};                                   ///< that it belongs to; empty: to all of them
  std::string pinion_body{"pinion"}, wheel_body{"wheel"};  ///< names of its bodies: "planet"; "sun", "wheel"
  std::string fidelity{};                                  ///< fem::fidelity_name(), or "prescribed" by the scene
  std::optional<fem::LoadedMeshProblem> problem{};         ///< absent when the stiffness is prescribed

  [[nodiscard]] bool computed() const { return problem.has_value(); }
  /// Computed with finite elements, and not by formulas alone.
  [[nodiscard]] bool has_elements() const { return computed() && settings.fidelity != fem::Fidelity::closed_form; }
  /// Index of the nominal load among those of a computed mesh: the middle one, at which the accuracy is met.
  [[nodiscard]] std::size_t nominal_load() const { return problem->loads.size() / 2; }
  /// Identity of all inputs this mesh's results depend on.
  [[nodiscard]] std::string id() const;
  [[nodiscard]] const std::string& body_name(geometry::GearRole gear) const {
    return gear == geometry::GearRole::pinion ? pinion_body : wheel_body;
  }
  /// For messages: "sun-planet mesh", "ring-planet mesh of 'pinned'".
  [[nodiscard]] std::string label() const;
};

/// A mesh of two gears of a scene.
struct GearMesh {
  std::string mesh;       ///< name of files and tables
  std::string title;      ///< for people
  std::string variant{};  ///< that it belongs to; empty: to all of them
  const geometry::GearPair& pair;
  const MeshInput& input;
  const HubGearInput& pinion;  ///< in the roles they have in the pair
  const GearInput& wheel;
  std::string pinion_name, wheel_name;             ///< for people
  std::optional<double> wheel_support_diameter{};  ///< m, bore of a wheel on a hub, outside of a ring
  fem::RingStructure structure{};                  ///< of a ring
  std::vector<fem::StrainGauge> gauges{};          ///< on a ring
  bool gauges_across = false;  ///< they stand beside the middle of the face, or measure along the axis
  std::optional<fem::PlanetRollers> planet_rollers{};
  double misalignment = 0;        ///< m
  double mean_force = 0;          ///< N, of one mesh
  bool ring_modes_count = false;  ///< elastic modes of the ring take part in the dynamics
  std::string why_it_tilts{};     ///< its bodies do, which solid gears answer where the model is left open; empty: not
};
/// Its elastic problem, before the model, its positions and loads are chosen; nothing for a prescribed stiffness.
[[nodiscard]] std::optional<fem::LoadedMeshProblem> mesh_problem(const Scene& scene, const GearMesh& mesh);
[[nodiscard]] MeshModel mesh_model(const Scene& scene, const GearMesh& mesh);
/// Why it needs a solid model: what changes along its face width. Empty when nothing does.
[[nodiscard]] std::string solid_reason(const Scene& scene, const GearMesh& mesh);
/// The same before there are gears: fem::solid_reason() of these.
[[nodiscard]] fem::FaceFeatures face_features(const Scene& scene, const GearInput& pinion,
                                              const std::string& pinion_name, const GearInput& wheel,
                                              const std::string& wheel_name, double misalignment,
                                              bool gauges_across = false);

}  // namespace annulus::app
