#include "app/model/stiff_supports.h"

#include <algorithm>

namespace annulus::app {

namespace {

constexpr double unseen = 1e-3;  // of the accuracy

}  // namespace

double rough_stiffness(const Scene& scene, const MeshInput& mesh, double face_width) {
  constexpr double per_width = 18e9;  // N/m^2, mean of one and two pairs of steel teeth
  constexpr double steel = 206e9;
  return mesh.mean.value_or(per_width * face_width * scene.material.youngs_modulus / steel);
}

MeshInput rough_mesh(const Scene& scene, const MeshInput& mesh, double face_width, RoughCourse course) {
  if (mesh.stiffness == StiffnessShape::rectangular || mesh.stiffness == StiffnessShape::harmonic) return mesh;
  MeshInput rough;
  rough.stiffness = StiffnessShape::constant;
  rough.mean = rough_stiffness(scene, mesh, face_width);
  if (course == RoughCourse::constant) return rough;
  // Half the range over the mean of solved tables: 0.17 to 0.24 of spur sun meshes, 0.01 to 0.24 of spur ring meshes
  // (data/scenes/ring_types.toml, arc_tooth_2kv.toml), 0.01 and 0.02 of a helical stage.
  constexpr double of_spur = 0.2, of_helical = 0.02;
  rough.stiffness = StiffnessShape::harmonic;
  rough.ripple = scene.stage.helix_angle == 0 ? of_spur : of_helical;
  return rough;
}

MeshResult unread_table(const std::string& mesh) {
  return {.model = {}, .table = StiffnessTable(mesh, 4, {0.0}, {1.0}, std::vector<StiffnessEntry>(4, {0, 1, 1, 1, 0}))};
}

double rigid_if_stiff(double support, double neighbours, double accuracy) {
  return neighbours <= unseen * accuracy * support ? rigid : support;
}

double as_stiff_as_matters(double stiffness, double neighbours, double accuracy) {
  return std::min(stiffness, neighbours / (unseen * accuracy));
}

}  // namespace annulus::app
