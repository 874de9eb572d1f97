#include "app/systems/shared/friction.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/scene/scene_declare.h"
#include "dynamics/friction/squeeze_film.h"
#include "geometry/gear_pair.h"

namespace annulus::app {

namespace {

PairShares known_shares(const RollingMesh& rolling, const PairShares& shares) {
  return shares.phases > 0 ? shares : dynamics::even_shares(*rolling.pair);
}

double to_normal(const RollingMesh& rolling) { return 1 / std::cos(rolling.pair->pinion().base_helix_angle()); }

double coefficient_of(const Scene& scene, const RollingMesh& rolling) {
  const auto input = scene.own<FrictionInput>();
  if (input.coefficient) return *input.coefficient;
  const auto& pair = *rolling.pair;
  const double velocity = rolling.frequency * pair.pinion().base_pitch() / std::cos(pair.working_pressure_angle());
  return dynamics::mean_coefficient_of_friction(pair, {.line_load = rolling.force / pair.common_face().width,
                                                       .pitch_velocity = velocity,
                                                       .viscosity = *input.viscosity,
                                                       .roughness = *input.roughness,
                                                       .lubricant_factor = input.lubricant_factor});
}

/// With every other phase.
PairShares coarser(const PairShares& shares) {
  PairShares coarse{.phases = shares.phases / 2, .first = shares.first};
  for (std::size_t i = 0; i < shares.share.size(); i += 2) coarse.share.push_back(shares.share[i]);
  return coarse;
}

}  // namespace

namespace {

Table squeeze_film_table() {
  Declarations<SqueezeInput> film(
      "squeeze_film",
      "Oil that resists to flanks which approach each other within the backlash, beside the dampers of contact.",
      [](Scene& s, std::size_t) -> SqueezeInput& { return s.own<SqueezeInput>(); });
  film.on_request().only_if(given("[dynamics]"), "it acts in motions alone");
  film.key("viscosity_mPas", &SqueezeInput::viscosity, "Dynamic viscosity of the oil at its temperature.")
      .required()
      .above(0, 1e5);
  film.key("least_gap_um", &SqueezeInput::least_gap,
           "Gap below which the oil resists no more than at it: roughness, or thickness of the film in contact.")
      .required()
      .from(1e-3, 1000);
  return film.done();
}

Table friction_table() {
  Declarations<FrictionInput> friction(
      "friction", "Friction on the flanks, by Coulomb's law: losses, efficiency, and what it does to the dynamics.",
      [](Scene& s, std::size_t) -> FrictionInput& { return s.own<FrictionInput>(); });
  friction.on_request();
  friction
      .key("coefficient", &FrictionInput::coefficient, "Coefficient of friction of all meshes, over the mesh cycle.")
      .from(0, 1)
      .one_of({"oil_viscosity_mPas"})
      .absent("mean coefficient of ISO/TR 14179-2, from the oil and the roughness");
  friction.key("oil_viscosity_mPas", &FrictionInput::viscosity, "Dynamic viscosity of the oil at its temperature.")
      .above(0, 1e5)
      .absent("the coefficient is given");
  const auto by_oil = given("oil_viscosity_mPas");
  friction.key("roughness_um", &FrictionInput::roughness, "Roughness Ra of the flanks, mean of both gears.")
      .above(0, 100)
      .needed_if(by_oil, "the coefficient then follows from oil and roughness");
  friction
      .key("lubricant_factor", &FrictionInput::lubricant_factor,
           "Factor X_L of the base oil: 1 for mineral oils, below 1 for most synthetic ones.")
      .from(0.1, 3)
      .only_if(by_oil, "it is part of the formula for the coefficient")
      .fallback(1.0, "mineral oil");
  return friction.done();
}

}  // namespace

std::vector<Table> friction_tables() { return {friction_table(), squeeze_film_table()}; }

bool has_friction(const Scene& scene) {
  const auto input = scene.own<FrictionInput>();
  return input.coefficient || input.viscosity;
}

std::optional<dynamics::FlankFriction> flank_friction(const Scene& scene, const RollingMesh& rolling,
                                                      const PairShares& shares, MeshForces forces) {
  if (!has_friction(scene)) return std::nullopt;
  const double along = forces == MeshForces::transverse ? to_normal(rolling) : 1;
  return dynamics::FlankFriction{along * coefficient_of(scene, rolling),
                                 dynamics::sliding_of(*rolling.pair, known_shares(rolling, shares))};
}

std::optional<dynamics::SqueezeFilm> squeeze_film(const Scene& scene, const geometry::GearPair& pair,
                                                  MeshForces forces) {
  const auto input = scene.own<SqueezeInput>();
  if (input.viscosity == 0) return std::nullopt;
  const bool normal = forces == MeshForces::normal;
  return dynamics::SqueezeFilm{normal ? dynamics::squeeze_coefficient(pair, input.viscosity)
                                      : dynamics::transverse_squeeze_coefficient(pair, input.viscosity),
                               normal ? input.least_gap : input.least_gap / std::cos(pair.pinion().base_helix_angle())};
}

MeshLosses mesh_losses(const Scene& scene, const RollingMesh& rolling, const PairShares& given_shares, int number) {
  const auto& pair = *rolling.pair;
  const double mu = coefficient_of(scene, rolling), friction = mu * to_normal(rolling) * rolling.force;
  const double teeth = 1.0 / pair.pinion().teeth() + (pair.internal() ? -1.0 : 1.0) / pair.wheel().teeth();
  const auto power_of = [&](const PairShares& shares) {
    return number * friction * dynamics::sliding_of(pair, shares).distance.mean() * 2 * std::numbers::pi *
           rolling.frequency * teeth;
  };
  const auto shares = known_shares(rolling, given_shares);
  const auto sliding = dynamics::sliding_of(pair, shares);
  const double power = power_of(shares);
  // Torque of the friction over that of the mesh force, on the smaller of both gears.
  const double of_force = mu * to_normal(rolling) *
                          (std::abs(sliding.side.mean()) * std::tan(pair.working_pressure_angle()) +
                           sliding.distance.mean() / std::min(pair.pinion().base_radius(), pair.wheel().base_radius()));
  const double of_phases = shares.phases % 2 == 0 ? std::abs(power_of(coarser(shares)) - power) : power;
  return {{}, mu, {power, of_phases + of_force * power}};
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

void warn_of_shares(std::vector<Warning>& list, const Scene& scene, const std::vector<std::string>& prescribed) {
  if (!has_friction(scene) || prescribed.empty()) return;
  list.push_back(
      {"assumed_load_shares", Severity::warning,
       fmt::format("{}: a prescribed stiffness has no load shares of tooth pairs. Friction takes those of "
                   "stiff teeth, by the length of their contact lines; a computed stiffness gives the shares "
                   "of the gears",
                   fmt::join(prescribed, ", "))});
}

}  // namespace annulus::app
