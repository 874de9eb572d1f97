#include "dynamics/friction/friction_losses.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/not_known.h"
#include "geometry/gear_pair.h"

namespace annulus::dynamics {

namespace {

/// With every other phase.
PairShares coarser(const PairShares& shares) {
  PairShares coarse{.phases = shares.phases / 2, .first = shares.first};
  for (std::size_t i = 0; i < shares.share.size(); i += 2) coarse.share.push_back(shares.share[i]);
  return coarse;
}

}  // namespace

MeshLosses mesh_losses(const LossyMesh& mesh, const FlankFriction& friction, const PairShares& shares) {
  const auto& pair = *mesh.pair;
  const double teeth = 1.0 / pair.pinion().teeth() + (pair.internal() ? -1.0 : 1.0) / pair.wheel().teeth();
  const double over_distance =
      mesh.number * friction.coefficient * mesh.force * 2 * std::numbers::pi * mesh.frequency * teeth;
  const double distance = friction.sliding.distance.mean(), power = over_distance * distance;
  const double of_phases = shares.phases % 2 == 0
                               ? over_distance * std::abs(sliding_of(pair, coarser(shares)).distance.mean() - distance)
                               : not_known;
  // Torque of the friction over that of the mesh force, on the smaller of both gears.
  const double of_force =
      friction.coefficient * (std::abs(friction.sliding.side.mean()) * std::tan(pair.working_pressure_angle()) +
                              distance / std::min(pair.pinion().base_radius(), pair.wheel().base_radius()));
  return {mesh.name,
          friction.coefficient * std::cos(pair.pinion().base_helix_angle()),
          {power, of_phases + of_force * power}};
}

const FigureSpec& efficiency_figure() {
  static const FigureSpec spec{
      .key = "efficiency",
      .title = "Efficiency of the meshes",
      .symbol = "η",
      .unit = "%",
      .scale = 100,
      .definition =
          "1 less the power that all meshes lose in friction over the power of the bodies that drive, at the "
          "mean mesh forces; bearings, seals and oil lose more",
      .better = Better::larger,
      .effort = FigureEffort::tables,
      .headline = true,
      .compared = true};
  return spec;
}

std::vector<FigureSpec> friction_figure_specs(const std::vector<std::pair<std::string, std::string>>& meshes) {
  std::vector<FigureSpec> specs = {efficiency_figure()};
  for (const auto& [mesh, title] : meshes) {
    specs.push_back({.key = mesh + "_friction_loss_W",
                     .title = "Power lost in friction of the " + title,
                     .unit = "W",
                     .definition =
                         "coefficient of friction times normal force and speed of sliding of all tooth pairs, "
                         "mean over the mesh cycle; of all these meshes",
                     .better = Better::smaller,
                     .effort = FigureEffort::tables});
    specs.push_back({.key = mesh + "_friction_coefficient",
                     .title = "Coefficient of friction of the " + title,
                     .symbol = "μ",
                     .definition = "as given, or the mean one of ISO/TR 14179-2",
                     .better = Better::neither,
                     .effort = FigureEffort::tables,
                     .digits = 3});
  }
  return specs;
}

FigureSet efficiency_alone(const FigureSet& losses) {
  FigureSet figures;
  if (const auto* entry = losses.find(efficiency_figure().key)) figures.set(entry->key, entry->figure, entry->parts);
  return figures;
}

void add_losses(FigureSet& figures, const std::vector<MeshLosses>& losses, double power) {
  Figure lost{0, 0};
  for (const auto& mesh : losses) {
    figures.set(mesh.mesh + "_friction_loss_W", mesh.power);
    figures.set(mesh.mesh + "_friction_coefficient", {mesh.coefficient, 0});
    lost.value += mesh.power.value;
    lost.error += mesh.power.error;
  }
  figures.set(efficiency_figure().key, {1 - lost.value / power, lost.error / power});
}

}  // namespace annulus::dynamics
