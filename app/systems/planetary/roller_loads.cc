#include "app/systems/planetary/roller_loads.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/systems/planetary/planetary_input.h"
#include "core/radial_bearing.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// Load of a rim that stays round, N/rad, at an angle from the middle of its load zone.
class RoundRim {
 public:
  RoundRim(const RadialBearing& bearing, double stiffness, double play, double force)
      : density_(2 * stiffness / std::numbers::pi),
        play_(play),
        distance_(bearing.distance(force)),
        load_zone_(bearing.load_zone(force)) {}

  [[nodiscard]] double at(double angle) const { return density_ * std::max(0.0, distance_ * std::cos(angle) - play_); }
  [[nodiscard]] double load_zone() const { return load_zone_; }

 private:
  double density_, play_, distance_, load_zone_;
};

}  // namespace

std::optional<RollerLoads> roller_loads(const Scene& scene, const geometry::PlanetarySet& set, const MeshResult& mesh) {
  const auto& csv = mesh.rollers;
  if (csv.rows.empty()) return std::nullopt;
  const auto phase = csv.column("mesh_phase"), angle = csv.column("angle_deg"), load = csv.column("load_N_per_deg");
  const auto top = std::max_element(csv.rows.begin(), csv.rows.end(),
                                    [&](const auto& a, const auto& b) { return a[load] < b[load]; });
  RollerLoads result;
  result.mesh_phase = (*top)[phase];
  result.largest = (*top)[load] / units::deg;
  std::vector<std::pair<double, double>> around;
  for (const auto& row : csv.rows) {
    if (row[phase] != result.mesh_phase || row[csv.column("ring_tooth")] != (*top)[csv.column("ring_tooth")]) continue;
    around.emplace_back((row[angle] > 90 ? row[angle] - 360 : row[angle]) * units::deg, row[load] / units::deg);
  }
  std::sort(around.begin(), around.end());
  const double spacing = 2 * std::numbers::pi / static_cast<double>(around.size());
  for (const auto& [at, carried] : around) {
    if (carried > 0) result.load_zone += spacing;
    result.angle.push_back(at);
    result.load.push_back(carried);
  }
  const double as = set.sun_mesh().working_pressure_angle(), ar = set.ring_mesh().working_pressure_angle();
  const double outwards = std::sin(as) - std::sin(ar), across = std::cos(as) + std::cos(ar);
  const double force = mesh.table.loads()[mesh.nominal] * std::hypot(outwards, across);
  const double stiffness = planetary(scene).supports.planet, play = planetary(scene).supports.planet_clearance / 2;
  const RoundRim round({stiffness, play}, stiffness, play, force);
  // The rim leans on the rollers opposite to the forces of its meshes.
  const double middle = std::atan2(-across, -outwards);
  for (const double at : result.angle) result.rigid.push_back(round.at(at - middle));
  result.largest_rigid = round.at(0);
  result.rigid_load_zone = round.load_zone();
  return result;
}

}  // namespace annulus::app
