#include "app/model/stiff_supports.h"

#include <algorithm>

namespace annulus::app {

namespace {

constexpr double unseen = 1e-3;  // of the accuracy

}  // namespace

double rough_stiffness(const Scene& scene, const MeshInput& mesh) {
  constexpr double per_width = 18e9;  // N/m^2, mean of one and two pairs of steel teeth
  constexpr double steel = 206e9;
  return mesh.mean.value_or(per_width * scene.stage.face_width * scene.material.youngs_modulus / steel);
}

Scene with_rough_stiffness(const Scene& scene, std::initializer_list<MeshInput Scene::*> meshes) {
  Scene rough = scene;
  for (const auto mesh : meshes) {
    if ((scene.*mesh).stiffness == StiffnessShape::rectangular) continue;
    rough.*mesh = {};
    (rough.*mesh).stiffness = StiffnessShape::constant;
    (rough.*mesh).mean = rough_stiffness(scene, scene.*mesh);
  }
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

double torsional_support(const Scene& scene, geometry::StageMember member) {
  using geometry::StageMember;
  const auto& s = scene.supports;
  const auto& given = member == StageMember::sun    ? s.sun_torsional
                      : member == StageMember::ring ? s.ring_torsional
                                                    : s.carrier_torsional;
  return given.value_or(scene.stage.held == member ? rigid : 0);
}

SupportInput effective_supports(const Scene& scene, double sun_mesh, double ring_mesh) {
  SupportInput s = scene.supports;
  const double n = scene.stage.planets, both = sun_mesh + ring_mesh, accuracy = scene.accuracy;
  s.sun = rigid_if_stiff(s.sun, n * sun_mesh, accuracy);
  s.ring = rigid_if_stiff(s.ring, n * ring_mesh, accuracy);
  using geometry::StageMember;
  const auto torsional = [&](StageMember member, double meshes) {
    const double given = torsional_support(scene, member);
    return scene.stage.held == member ? rigid_if_stiff(given, n * meshes, accuracy) : given;
  };
  s.sun_torsional = torsional(StageMember::sun, sun_mesh);
  s.ring_torsional = torsional(StageMember::ring, ring_mesh);
  s.carrier_torsional = torsional(StageMember::carrier, both);
  s.carrier = rigid_if_stiff(s.carrier, n * both, accuracy);
  s.planet = rigid_if_stiff(s.planet, both, accuracy);
  return s;
}

}  // namespace annulus::app
