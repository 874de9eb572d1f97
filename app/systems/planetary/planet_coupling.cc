#include "app/systems/planetary/planet_coupling.h"

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/planetary_input.h"
#include "app/systems/shared/sun_planet_input.h"

namespace annulus::app {

std::optional<PlanetCoupling> planet_coupling(const dynamics::PlanetaryStage& stage, const MeshResult& sun_mesh,
                                              const MeshResult& ring_mesh) {
  const auto &of_sun = sun_mesh.partner_compliance, &of_ring = ring_mesh.partner_compliance;
  if (of_sun.empty() || of_ring.empty()) return std::nullopt;
  const auto curve = [](const std::vector<double>& values) {
    return PeriodicCurve(values, static_cast<int>(values.size()));
  };
  const auto sun = curve(of_sun), ring = curve(of_ring);
  // The phase of the sun mesh while the ring mesh of the same planet is at its phase 0.
  const double later = stage.ring_phase_lag.at(0) - stage.ring_tooth_offset.at(0) - stage.sun_phase_lag.at(0);
  const std::size_t phases = std::max(of_sun.size(), of_ring.size());
  PlanetCoupling result;
  for (std::size_t i = 0; i < phases; ++i) {
    const double phase = static_cast<double>(i) / static_cast<double>(phases);
    const double by_ring = ring(phase), by_sun = sun(phase + later);
    result.compliance.push_back((by_ring + by_sun) / 2);
    result.deviation = std::max(result.deviation, std::abs(by_ring - by_sun) / 2);
  }
  return result;
}

std::optional<dynamics::PlanetaryStage> with_deviating_coupling(const dynamics::PlanetaryStage& stage,
                                                                const MeshResult& sun_mesh,
                                                                const MeshResult& ring_mesh) {
  if (stage.planet_coupling.empty()) return std::nullopt;
  const auto coupling = planet_coupling(stage, sun_mesh, ring_mesh);
  auto changed = stage;
  for (double& compliance : changed.planet_coupling) compliance += coupling->deviation;
  return changed;
}

void warn_of_coupling_left_out(std::vector<Warning>& list, const Scene& scene) {
  if (!scene.dynamics || sun_and_planets(scene).planet.bore != BoreOn::rollers) return;
  const bool sun = sun_and_planets(scene).sun_planet.stiffness == StiffnessShape::computed,
             ring = planetary(scene).ring_planet.stiffness == StiffnessShape::computed;
  if (sun && ring) return;
  list.push_back({"planet_coupling_left_out", Severity::warning,
                  "in motion the two meshes of a planet do not act on each other through its rim, because the "
                  "stiffness of one is prescribed. The natural frequencies of modes in which the planets turn are then "
                  "wrong. Let both meshes be computed"});
}

}  // namespace annulus::app
