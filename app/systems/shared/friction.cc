#include "app/systems/shared/friction.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "app/scene/scene_declare.h"
#include "dynamics/friction/squeeze_film.h"
#include "geometry/gear_pair.h"

namespace annulus::app {

namespace {

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

/// Those of the mesh; where it has none, those of stiff teeth.
PairShares known_shares(const RollingMesh& rolling, const PairShares& shares) {
  return shares.phases > 0 ? shares : dynamics::even_shares(*rolling.pair);
}

Table squeeze_film_table() {
  Declarations<SqueezeInput> film(
      "squeeze_film",
      "Oil that flanks squeeze out where they approach each other within the backlash, beside the dampers of contact.");
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
      "friction", "Friction on the flanks, by Coulomb's law: losses, efficiency, and what it does to the dynamics.");
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
      .needed_if(by_oil, "the coefficient is proportional to it");
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

dynamics::MeshLosses mesh_losses(const Scene& scene, const std::string& mesh, const RollingMesh& rolling,
                                 const PairShares& shares, int number) {
  const auto known = known_shares(rolling, shares);
  return dynamics::mesh_losses({mesh, rolling.pair, rolling.frequency, rolling.force, number},
                               flank_friction(scene, rolling, known, MeshForces::transverse).value(), known);
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
