#include <Eigen/LU>
#include <array>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/errors.h"
#include "dynamics/modes/modal_energy.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/systems/planetary/planetary_modes.h"
#include "dynamics/systems/planetary/response.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

/// The two meshes of a planet act on each other through its rim.
BOOST_AUTO_TEST_SUITE(planet_coupling)

using namespace annulus;
using namespace annulus::dynamics;

namespace {

constexpr double tau = 2 * std::numbers::pi;

/// Compliance of a rim between the places of its two meshes, and of each contact by itself, m/N.
struct Rim {
  double sun = 0.8e-9, ring = 0.6e-9, between = 0.35e-9;
  double sun_contact = 0.9e-9, ring_contact = 0.7e-9;
};

PlanetaryStage plain_stage() {
  auto stage = stages::ring_paper();
  stage.rotating_frame = false;
  return stage;
}

/// The stage with the stiffness of its meshes under equal forces, and with the coupling.
PlanetaryStage coupled_stage(const Rim& rim) {
  auto stage = plain_stage();
  stage.sun_mesh = ConstantStiffness{1 / (rim.sun_contact + rim.sun + rim.between)};
  stage.ring_mesh = ConstantStiffness{1 / (rim.ring_contact + rim.ring + rim.between)};
  stage.planet_coupling = {rim.between};
  return stage;
}

/// The same with the places of the meshes on the rim as bodies of their own, which weigh next to nothing: springs
/// between them and the planet have the compliance of the rim.
LumpedSystem with_rims(const Rim& rim) {
  auto stage = plain_stage();
  stage.sun_mesh = ConstantStiffness{1 / rim.sun_contact};
  stage.ring_mesh = ConstantStiffness{1 / rim.ring_contact};
  const auto rigid_planets = assemble(stage);
  LumpedSystemBuilder builder;
  std::vector<LinearForm> dofs;
  for (const auto& name : rigid_planets.names()) dofs.push_back(builder.add_dof(name));
  const auto& mass = rigid_planets.mass();
  for (Eigen::Index i = 0; i < mass.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      if (mass(i, j) != 0 && i != j)
        builder.add_mass_coupling(dofs[static_cast<std::size_t>(i)], dofs[static_cast<std::size_t>(j)], mass(i, j));
      else if (i == j)
        builder.add_mass(dofs[static_cast<std::size_t>(i)], mass(i, i));
  for (const auto& spring : rigid_planets.springs()) builder.add_spring(spring.a, spring.stiffness, 0, spring.name);
  const Eigen::Matrix2d stiffness =
      (Eigen::Matrix2d() << rim.sun, rim.between, rim.between, rim.ring).finished().inverse();
  constexpr double next_to_nothing = 1e-7;  // kg: 1e-8 of a planet
  for (int n = 0; n < stage.planets(); ++n) {
    std::array<LinearForm, 2> places;
    for (const int side : {0, 1}) {
      const int m = n + side * stage.planets();
      auto mesh = rigid_planets.meshes()[static_cast<std::size_t>(m)];
      auto& place = places.at(static_cast<std::size_t>(side));
      place = builder.add_dof(mesh.name + "_rim");
      builder.add_mass(place, next_to_nothing);
      builder.add_spring(place, stiffness(side, side) + stiffness(0, 1), 0, "rim" + mesh.name);
      mesh.b = mesh.b + (-1.0) * place;
      builder.add_mesh(mesh);
    }
    builder.add_spring(places[0] + (-1.0) * places[1], -stiffness(0, 1), 0, "rim" + std::to_string(n));
  }
  return builder.build();
}

}  // namespace

// The places on the rim have some 1e-7 kg against 1e9 N/m: natural frequencies of 1e7 Hz, beside which 2 kHz are 1e-8.
BOOST_AUTO_TEST_CASE(a_rim_made_of_springs) {
  annulus::test::Verification record("Natural frequencies of a stage with thin planets",
                                     "places of the meshes on the rim as bodies, springs between them");
  const Rim rim;
  const auto coupled = assemble(coupled_stage(rim));
  const auto found = modes(coupled);
  const auto expected = modes(with_rims(rim));
  BOOST_TEST_REQUIRE(expected.modes.size() == found.modes.size() + 10);
  double worst = 0, uncoupled = 0;
  auto without = coupled_stage(rim);
  without.planet_coupling.clear();
  const auto alone = modes(assemble(without));
  for (std::size_t i = 0; i < found.modes.size(); ++i) {
    const double frequency = expected.modes[i].frequency;
    if (frequency == 0) continue;
    worst = std::max(worst, std::abs(found.modes[i].frequency / frequency - 1));
    uncoupled = std::max(uncoupled, std::abs(alone.modes[i].frequency / frequency - 1));
  }
  record.at_most("natural frequencies, largest relative difference", "", worst, 1e-6, "masses of the places");
  BOOST_TEST(uncoupled > 0.05, "without the coupling they differ by " << uncoupled);

  // Energy that is neither in springs nor in the laws of the meshes belongs to the planets.
  const auto energy = modal_energy(coupled, mean_tangents(coupled), found);
  BOOST_TEST_REQUIRE(energy.elements.back() == "planet_body");
  for (Eigen::Index i = 0; i < energy.strain.cols(); ++i)
    if (found.modes[static_cast<std::size_t>(i)].frequency > 0)
      BOOST_TEST(std::abs(energy.strain.col(i).sum() - 1) < 1e-12);
}

// F_s = k_s (x_s - c (F_r - F_s)) and the same with s and r exchanged; without contact one of them is zero.
BOOST_AUTO_TEST_CASE(forces_of_the_two_meshes_by_hand) {
  annulus::test::Verification record("Mesh forces of a thin planet", "two equations solved by hand");
  const Rim rim;
  auto stage = coupled_stage(rim);
  const double sun = mean_stiffness(stage.sun_mesh), ring = mean_stiffness(stage.ring_mesh), c = rim.between;
  double worst = 0;
  for (const std::optional<double> backlash : {std::optional<double>(), std::optional(10e-6)}) {
    stage.sun_half_backlash = stage.ring_half_backlash = backlash;
    const auto system = assemble(stage);
    const double play = backlash.value_or(0);
    for (const auto& [x_sun, x_ring] : {std::pair{60e-6, 40e-6}, {35e-6, 80e-6}, {30e-6, 90e-6}, {100e-6, 14e-6}}) {
      Eigen::VectorXd approach = Eigen::VectorXd::Zero(10);
      approach.head(5).setConstant(x_sun);
      approach.tail(5).setConstant(x_ring);
      auto workspace = system.workspace();
      system.evaluate_forces(0, approach.data(), Eigen::VectorXd::Zero(10).eval().data(), workspace);
      Eigen::Matrix2d matrix;
      matrix << 1 / sun - c, c, c, 1 / ring - c;
      const Eigen::Vector2d gap(workspace.error[0] + play, workspace.error[5] + play);
      Eigen::Vector2d force = matrix.inverse() * (Eigen::Vector2d(x_sun, x_ring) - gap);
      for (const int open : {0, 1})
        if (backlash && force[open] < 0) {
          force[1 - open] = (open == 0 ? x_ring - gap[1] : x_sun - gap[0]) / matrix(1 - open, 1 - open);
          force[open] = 0;
        }
      worst = std::max({worst, std::abs(workspace.elastic[0] - force[0]) / force.norm(),
                        std::abs(workspace.elastic[5] - force[1]) / force.norm()});
    }
  }
  record.at_most("forces, largest difference over their size", "", worst, 1e-11, "rounding");
}

// Under equal forces the coupling changes nothing.
BOOST_AUTO_TEST_CASE(statics_know_nothing_of_it) {
  const Rim rim;
  auto stage = coupled_stage(rim);
  const auto solve = [](const PlanetaryStage& s) {
    const auto system = assemble(s);
    StaticSolver solver(system);
    auto workspace = system.workspace();
    return solver.solve(0, workspace);
  };
  const Eigen::VectorXd coupled = solve(stage);
  stage.planet_coupling.clear();
  const Eigen::VectorXd alone = solve(stage);
  BOOST_TEST((coupled - alone).cwiseAbs().maxCoeff() < 1e-10 * alone.cwiseAbs().maxCoeff());
}

// Both couplings at once, which change over the mesh cycle: every planet reads its own at the phase of its ring mesh.
BOOST_AUTO_TEST_CASE(beside_a_coupling_through_the_ring) {
  annulus::test::Verification record("Coupling through ring and planets at once", "one system of equations");
  const Rim rim;
  auto stage = coupled_stage(rim);
  const int planets = stage.planets();
  stage.set_half_backlash(std::nullopt);
  stage.sun_phase_lag = stage.ring_phase_lag = stage.ring_tooth_offset = {};
  for (int n = 0; n < planets; ++n) {
    stage.sun_phase_lag.push_back(0.1 * n);
    stage.ring_phase_lag.push_back(0.37 + 0.21 * n);
    stage.ring_tooth_offset.push_back(n);
  }
  stage.planet_coupling.clear();
  constexpr int phases = 16;
  for (int i = 0; i < phases; ++i)
    stage.planet_coupling.push_back(rim.between * (1 + 0.3 * std::sin(tau * i / phases)));
  auto ring = std::make_shared<RingCoupling>();
  ring->planets = planets;
  ring->ring_teeth = stage.ring_teeth;
  ring->per_cycle = 3;
  for (int i = 0; i < 6; ++i) {
    Eigen::MatrixXd d(planets, planets);
    for (int n = 0; n < planets; ++n)
      for (int m = 0; m <= n; ++m) d(n, m) = d(m, n) = n == m ? 0 : 0.1e-9 * std::cos(tau * (i / 6.0 + 0.2 * (n + m)));
    ring->compliance.push_back(d);
  }
  stage.ring_coupling = ring;
  const auto system = assemble(stage);
  const PeriodicCurve between(stage.planet_coupling, phases);
  double worst = 0;
  for (const double t : {0.0, 0.31e-3, 1.7e-3, 0.2}) {
    Eigen::VectorXd approach(2 * planets);
    for (int m = 0; m < 2 * planets; ++m) approach[m] = 1e-6 * (60 + 7 * m % 11);
    auto workspace = system.workspace();
    system.evaluate_forces(t, approach.data(), Eigen::VectorXd::Zero(2 * planets).eval().data(), workspace);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2 * planets, 2 * planets);
    const double cycles = stage.mesh_rate() * t;
    const auto phase = [&](int n) {
      return cycles - stage.ring_phase_lag[static_cast<std::size_t>(n)] +
             stage.ring_tooth_offset[static_cast<std::size_t>(n)];
    };
    const auto curves = compliance_curves(ring->compliance, ring->per_cycle);
    std::size_t entry = 0;
    for (int n = 0; n < planets; ++n) {
      for (int m = 0; m <= n; ++m, ++entry)
        matrix(planets + n, planets + m) = matrix(planets + m, planets + n) = curves[entry](phase(0));
      const double c = between(phase(n));
      matrix(n, n) += 1 / mean_stiffness(stage.sun_mesh) - c;
      matrix(planets + n, planets + n) += 1 / mean_stiffness(stage.ring_mesh) - c;
      matrix(n, planets + n) += c;
      matrix(planets + n, n) += c;
    }
    const Eigen::VectorXd error = Eigen::Map<const Eigen::VectorXd>(workspace.error.data(), 2 * planets);
    const Eigen::VectorXd expected = matrix.partialPivLu().solve(approach - error);
    const Eigen::VectorXd found = Eigen::Map<const Eigen::VectorXd>(workspace.elastic.data(), 2 * planets);
    worst = std::max(worst, (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff());
  }
  // The curve through the ring has three knots a cycle and is read at eighteen.
  record.at_most("forces, largest difference over the largest force", "", worst, 1e-3, "common knots of the curves");
}

// Harmonic balance and integration in time, with errors of the planets: energy and both methods.
BOOST_AUTO_TEST_CASE(motion) {
  annulus::test::Verification record("Motion of a stage with thin planets", "two methods, balance of energy");
  auto stage = coupled_stage({});
  stage.sun_mesh = HarmonicStiffness{mean_stiffness(stage.sun_mesh), 0.1, 0};
  stage.ring_mesh = HarmonicStiffness{mean_stiffness(stage.ring_mesh), 0.05, 0.3};
  SimulationOptions balance, integration;
  balance.confirmation = Confirmation::never;
  integration.integrate_for(400, stage.error_period());
  const auto a = simulate(stage, balance), b = simulate(stage, integration);
  record.at_most("energy balance", "", std::abs(b.energy.relative), 1e-3, "tolerance of the integration");
  for (std::size_t n = 0; n < 5; ++n)
    record.close("peak factor of a sun mesh", "", a.sun_planet.branches[n].peak_factor.value,
                 b.sun_planet.branches[n].peak_factor.value, 5e-3, "samples of both methods");
}

BOOST_AUTO_TEST_CASE(too_much_of_it_is_refused) {
  auto stage = coupled_stage({});
  const double limit = 1 / (mean_stiffness(stage.sun_mesh) + mean_stiffness(stage.ring_mesh));
  stage.planet_coupling = {0.99 * limit};
  stage.check();
  stage.planet_coupling = {1.01 * limit};
  BOOST_CHECK_EXCEPTION(stage.check(), InputError, [](const InputError& error) {
    return std::string(error.what()).find("through its rim") != std::string::npos;
  });
}

BOOST_AUTO_TEST_SUITE_END()
