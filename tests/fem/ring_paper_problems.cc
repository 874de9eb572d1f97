#include "ring_paper_problems.h"

#include <Eigen/Core>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numeric>
#include <utility>

#include "ring_paper.h"

namespace annulus::tests {

std::vector<double> equal_places(int planets) {
  std::vector<double> places;
  for (int n = 0; n < planets; ++n) places.push_back(162.0 * n / planets);
  return places;
}

fem::LoadedMeshProblem ring_mesh(const fem::RingStructure& structure, int phases, std::vector<double> loads) {
  fem::LoadedMeshProblem problem{ring_paper_pair(true), {}, 88e-3, 86e-3, ring_outside, structure};
  problem.name = "ring_planet";
  problem.loads = std::move(loads);
  problem.phases = phases;
  return problem;
}

fem::LoadedMeshProblem sun_mesh(int phases, std::vector<double> loads) {
  fem::LoadedMeshProblem problem{ring_paper_pair(false), {}, 88e-3, 86e-3, 65e-3};
  problem.name = "sun_planet";
  problem.loads = std::move(loads);
  problem.phases = phases;
  return problem;
}

fem::LoadedMeshProblem with_planet_lead(fem::LoadedMeshProblem problem, double crowning, double slope) {
  auto planet = ring_paper_planet();
  planet.lead_crowning = crowning;
  planet.lead_slope = slope;
  problem.pair = {geometry::Gear(planet), problem.pair.wheel(), problem.pair.centre_distance()};
  return problem;
}

fem::LoadedMeshProblem with_helix(fem::LoadedMeshProblem problem, double helix_angle) {
  auto planet = problem.pair.pinion().parameters(), wheel = problem.pair.wheel().parameters();
  const double side = problem.pair.internal() ? -1 : 1;
  planet.helix_angle = helix_angle;
  wheel.helix_angle = -side * helix_angle;
  const geometry::Gear p(planet), w(wheel);
  const double alpha = p.transverse_pressure_angle();
  const double involute = geometry::involute(alpha) + 2 * std::tan(planet.pressure_angle) *
                                                          (wheel.profile_shift + side * planet.profile_shift) /
                                                          (wheel.teeth + side * planet.teeth);
  const double working = geometry::inverse_involute(involute);
  problem.pair = {p, w, (w.reference_radius() + side * p.reference_radius()) * std::cos(alpha) / std::cos(working)};
  return problem;
}

PinResultant pin_resultant(const fem::LoadedPosition& position, double first_pin_angle) {
  Eigen::Vector2d force = Eigen::Vector2d::Zero();
  double moment = 0;
  const auto& pins = position.pins;
  for (std::size_t q = 0; q < pins.size(); ++q) {
    const double angle = first_pin_angle + 2 * M_PI * static_cast<double>(q) / static_cast<double>(pins.size());
    const Eigen::Vector2d radial(std::cos(angle), std::sin(angle)), tangential(-radial.y(), radial.x());
    force += pins[q].radial_force * radial + pins[q].tangential_force * tangential;
    moment += pins[q].tangential_force * ring_outside;
  }
  const double c = std::cos(position.ring_angle), s = std::sin(position.ring_angle);
  const double outwards = c * force.x() + s * force.y(), clockwise = s * force.x() - c * force.y();
  const double beta = pin_diameter / 2 / ring_outside;
  return {force.norm(), std::atan2(outwards, clockwise), -moment * (1 - beta * beta / 10)};
}

fem::PinHeld paper_pins(int pins, double first_pin_angle) {
  fem::PinHeld held;
  held.angles = fem::equal_angles(pins, first_pin_angle);
  held.pin_diameter = pin_diameter;
  return held;
}

fem::LoadedMeshResult solve_plane(const fem::LoadedMeshProblem& problem, int level, int threads) {
  fem::LoadedMeshSettings settings;
  settings.level = level;
  settings.threads = threads;
  return solve_loaded_mesh(problem, settings);
}

fem::LoadedMeshResult solve_solid(const fem::LoadedMeshProblem& problem) {
  fem::LoadedMeshSettings settings;
  settings.fidelity = fem::Fidelity::solid;
  settings.level = 1;
  settings.threads = 2;
  return solve_loaded_mesh(problem, settings);
}

namespace {

// Sums of some hundred forces, systems of condition number up to 1e6 (stiff pins on a floating ring).
constexpr double invariant_round_off = 1e-9;

}  // namespace

void check_positions(const std::vector<fem::LoadedPosition>& positions, test::Verification* record) {
  constexpr double round_off = invariant_round_off;
  double force = 0, energy = 0, share = 0, least_share = 1, penetration = 0, reciprocity = 0;
  BOOST_TEST_REQUIRE(!positions.empty());
  for (const auto& p : positions) {
    reciprocity = std::max(reciprocity, p.reciprocity_relative);
    force = std::max(force, p.force_balance_relative);
    energy = std::max(energy, p.energy_balance_relative);
    penetration = std::max(penetration, p.max_penetration);
    share = std::max(share, std::abs(std::accumulate(p.pair_share.begin(), p.pair_share.end(), 0.0) - 1));
    for (const double s : p.pair_share) least_share = std::min(least_share, s);
    BOOST_TEST(p.entry.lte > p.entry.unloaded_te);
    BOOST_TEST(std::abs(p.entry.unloaded_te) < 1e-12);  // m; unmodified flanks: see the tests of the flank geometry
    BOOST_TEST(p.pair_share.size() == p.pair_roll.size());
    // Growing contacts and more teeth only ever stiffen.
    BOOST_TEST(p.entry.stiffness_tangent >= p.entry.stiffness_secant);
  }
  BOOST_TEST_MESSAGE("force " << force << ", energy " << energy << ", shares " << share << ", penetration "
                              << penetration << " m, reciprocity " << reciprocity);
  BOOST_TEST(least_share >= 0);
  const auto vanishes = [&](const char* quantity, const char* unit, double value, double bound, const char* origin) {
    if (record) record->at_most(quantity, unit, value, bound, origin);
    BOOST_TEST(value < bound, quantity);
  };
  vanishes("balance of forces, relative", "", force, round_off, "rounding of the solve");
  vanishes("balance of energy, relative", "", energy, round_off, "rounding of the solve");
  vanishes("sum of the load shares - 1", "", share, round_off, "rounding of the solve");
  vanishes("largest penetration", "m", penetration, 1e-14, "rounding of deflections of some 10 um");
  vanishes("reciprocity of the compliance, relative", "", reciprocity, round_off, "rounding of the solve");
}

void check_invariants(const fem::LoadedMeshResult& result, test::Verification* record) {
  check_positions(result.positions, record);
  BOOST_TEST_MESSAGE("closure " << result.closure_relative << ", estimated error " << result.worst_error_relative);
  BOOST_TEST(result.reciprocity_relative < invariant_round_off);
  BOOST_TEST(result.closure_relative < invariant_round_off);
  if (record)
    record->at_most("closure of the mesh cycle, relative", "", result.closure_relative, invariant_round_off,
                    "rounding of the solve");
}

void check_identical(const fem::LoadedMeshResult& a, const fem::LoadedMeshResult& b) {
  BOOST_TEST_REQUIRE(a.positions.size() == b.positions.size());
  int different = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    const auto &p = a.positions[i], &q = b.positions[i];
    different += !(p.entry.lte == q.entry.lte && p.entry.stiffness_tangent == q.entry.stiffness_tangent &&
                   p.entry.error_relative == q.entry.error_relative && p.max_pressure == q.max_pressure &&
                   p.pair_share == q.pair_share);
  }
  BOOST_TEST(different == 0);
}

double largest_lte_difference(const fem::LoadedMeshResult& a, const fem::LoadedMeshResult& b) {
  BOOST_TEST_REQUIRE(a.positions.size() == b.positions.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i)
    worst = std::max(worst, std::abs(a.positions[i].entry.lte / b.positions[i].entry.lte - 1));
  return worst;
}

}  // namespace annulus::tests
