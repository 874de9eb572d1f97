#include "app/model/stiff_supports.h"

#include <algorithm>

namespace annulus::app {

namespace {

constexpr double unseen = 1e-3;  // of the accuracy

}  // namespace

double rigid_if_stiff(double support, double neighbours, double accuracy) {
  return neighbours <= unseen * accuracy * support ? rigid : support;
}

double as_stiff_as_matters(double stiffness, double neighbours, double accuracy) {
  return std::min(stiffness, neighbours / (unseen * accuracy));
}

SupportInput effective_supports(const Scene& scene, double sun_mesh, double ring_mesh) {
  SupportInput s = scene.supports;
  const double n = scene.stage.planets, both = sun_mesh + ring_mesh, accuracy = scene.accuracy;
  s.sun = rigid_if_stiff(s.sun, n * sun_mesh, accuracy);
  s.ring = rigid_if_stiff(s.ring, n * ring_mesh, accuracy);
  s.ring_torsional = rigid_if_stiff(s.ring_torsional, n * ring_mesh, accuracy);
  s.carrier = rigid_if_stiff(s.carrier, n * both, accuracy);
  s.planet = rigid_if_stiff(s.planet, both, accuracy);
  return s;
}

}  // namespace annulus::app
