#pragma once

#include <optional>
#include <string>

#include "fem/choice/wanted_model.h"
#include "fem/problem/loaded_mesh_problem.h"

/// How the stiffness of a mesh is computed: model, elements, positions and loads, with the reasons.
namespace annulus::fem {

/// What can change along the face width of a gear mesh.
struct FaceFeatures {
  double helix_angle = 0;  ///< rad
  std::string pinion_name, wheel_name;
  bool pinion_lead_modified = false, wheel_lead_modified = false;
  double misalignment = 0;     ///< m
  bool beside = false;         ///< the middles of the faces are apart
  bool gauges_across = false;  ///< strain gauges stand beside the middle of the face, or measure along the axis
};
/// Why a mesh needs a solid model: what changes along its face width. Empty when nothing does.
[[nodiscard]] std::string solid_reason(const RingStructure& structure, const FaceFeatures& features);

struct MeshWish {
  WantedModel model = WantedModel::automatic;
  double accuracy = 0.01;         ///< relative, of the stiffness
  double mean_force = 0;          ///< N, of the mesh at its operating point
  bool ring_modes_count = false;  ///< elastic modes of the ring take part in the dynamics
};

struct MeshChoice {
  LoadedMeshSettings settings{};
  std::string reason{};     ///< why this model
  int positions = 1;        ///< ring positions after which the mesh repeats
  std::string repeats{};    ///< why so many
  std::string elements{};   ///< why elements of this degree; empty for formulas
  int coupling_degree = 2;  ///< of the elements that give the coupling of ring meshes through the ring
  std::string phases{};     ///< why so many positions per mesh cycle
  std::string loads{};      ///< why so many loads
  /// Relative error of the stiffness by formulas, as far as it is known beforehand, without plane strain.
  std::optional<double> formula_error{};
};
/// `problem` is complete but for its phases and loads, which are set. `why_solid`: solid_reason() of the mesh.
[[nodiscard]] MeshChoice choose_mesh(LoadedMeshProblem& problem, const std::string& why_solid, const MeshWish& wish);

}  // namespace annulus::fem
