#include "app/systems/planetary/roller_loads.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/systems/planetary/planetary_input.h"
#include "core/radial_bearing.h"
#include "core/units.h"

namespace annulus::app {

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
  const RadialBearing round(stiffness, play);
  // The rim leans on the rollers opposite to the forces of its meshes.
  const double middle = std::atan2(-across, -outwards);
  for (const double at : result.angle) result.rigid.push_back(round.roller_load(force, at - middle));
  result.largest_rigid = round.roller_load(force, 0);
  result.rigid_load_zone = round.load_zone(force);
  return result;
}

std::vector<FigureSpec> roller_figure_specs(const std::string& mesh, const std::string& title) {
  constexpr double per_degree = units::deg, degrees = 1 / units::deg;
  return {{.key = mesh + "_roller_load_N_per_rad",
           .title = "Largest load of the planet's rollers under the " + title,
           .unit = "N/°",
           .scale = per_degree,
           .definition = "largest over the angle and all positions at the nominal load, with the flexible rim of the "
                         "planet; absent without rollers",
           .better = Better::smaller,
           .effort = FigureEffort::tables},
          {.key = mesh + "_roller_load_zone_rad",
           .title = "Load zone of the planet's rollers under the " + title,
           .unit = "°",
           .scale = degrees,
           .definition = "all angles at which rollers carry where they carry most; absent without rollers",
           .better = Better::larger,
           .effort = FigureEffort::tables}};
}

FigureSet figures(const RollerLoads& loads, const std::string& mesh) {
  FigureSet set;
  set.set(mesh + "_roller_load_N_per_rad", loads.largest);
  set.set(mesh + "_roller_load_zone_rad", loads.load_zone);
  return set;
}

}  // namespace annulus::app
