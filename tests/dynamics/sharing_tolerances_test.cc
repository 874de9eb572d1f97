#include "dynamics/systems/planetary/sharing_tolerances.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "core/errors.h"
#include "dynamics/systems/planetary/response.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

using namespace annulus;
using namespace annulus::dynamics;

namespace {

constexpr double k_sun = 4e8, k_ring = 6e8, in_series = k_sun * k_ring / (k_sun + k_ring);

/// Everything rigid but the meshes, which are constant and linear; the sun floats.
PlanetaryStage floating_sun(int planets) {
  auto s = stages::ring_paper();
  s.planet_angles.clear();
  for (int n = 0; n < planets; ++n) s.planet_angles.push_back(2 * std::numbers::pi * n / planets);
  s.planet_errors.clear();
  s.sun_phase_lag.clear();
  s.ring_phase_lag.clear();
  s.ring_tooth_offset.clear();
  s.sun_mesh = ConstantStiffness{k_sun};
  s.ring_mesh = ConstantStiffness{k_ring};
  s.set_half_backlash(std::nullopt);
  s.sun.support = 0;
  s.ring.support = s.ring.torsional_support = s.carrier.support = rigid;
  s.planet_bearings.clear();
  return s;
}

/// Sum over the planets of four of (-1)^n (e_sn + e_rn) at mid-cycle c: what a floating sun cannot make up for.
double pattern_of_errors(const PlanetaryStage& s, int c) {
  double sum = 0;
  for (int n = 0; n < 4; ++n) {
    const double t = (c + 0.5) / s.mesh_frequency();
    sum += (n % 2 ? -1 : 1) * (sum_of(sun_mesh_errors(s, n), t).value + sum_of(ring_mesh_errors(s, n), t).value);
  }
  return sum;
}

/// Largest load-sharing factor of five planets over all mesh cycles, of `positions` columns each.
double worst_sharing(const Eigen::MatrixXd& sun_force, int positions) {
  double worst = 0;
  for (Eigen::Index c = 0; c < sun_force.cols(); c += positions) {
    const Eigen::VectorXd force = sun_force.middleCols(c, positions).rowwise().mean().cwiseAbs();
    worst = std::max(worst, 5 * force.maxCoeff() / force.sum());
  }
  return worst;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(sharing_tolerances)

/// Three mesh forces on a floating sun are equal by statics, whatever the errors.
BOOST_AUTO_TEST_CASE(three_planets_and_a_floating_sun_share_evenly) {
  annulus::test::Verification record("Three planets and a floating sun with deviations of every kind",
                                     "statics: three forces in equilibrium at 120 degrees are equal");
  const auto result = assembly_sharing(floating_sun(3), {50e-6, 20e-6, 30e-6, 40e-6}, {.assemblies = 40});
  for (const double factor : result.factors.front())
    record.near("load-sharing factor of an assembly", "", factor, 1, 1e-9, "rounding of the equilibrium");
}

/// Four planets: the loads of opposite planets are equal, and 1 -1 1 -1 of them is what the errors make of the meshes
/// in series: a = k/4 x sum of (-1)^n (e_sn + e_rn), K_γ = 1 + |a| / F. Independent of the solver.
BOOST_AUTO_TEST_CASE(four_planets_follow_the_closed_form) {
  annulus::test::Verification record(
      "Four planets and a floating sun with pin position errors and an eccentric sun",
      "closed form: K = 1 + |sum of (-1)^n (e_sn + e_rn)| k / (4 F), k both meshes in series");
  const auto nominal = floating_sun(4);
  const StageTolerances tolerances{
      .planet_pin_position = 20e-6, .sun_eccentricity = 30e-6, .within = WithinZone::uniform};
  for (int assembly = 0; assembly < 20; ++assembly) {
    const auto s = drawn_assembly(nominal, tolerances, 7, assembly);
    const double a = in_series / 4 * std::abs(pattern_of_errors(s, 0));
    const double factor = error_period_sharing(s, {1}).factors.front();
    record.close("load-sharing factor of an assembly", "", factor, 1 + a / s.mean_mesh_force(), 1e-8,
                 "rounding of the equilibrium");
  }
}

/// Eccentric planets: the same with errors that turn. The forces averaged over a mesh cycle lack the share
/// (pi/z)²/6 = 5e-4 of their change, and cycles are whole: the highest one is met within half a cycle, (pi/z)²/2
/// = 1.6e-3.
BOOST_AUTO_TEST_CASE(eccentric_planets_meet_their_worst_cycle) {
  annulus::test::Verification record("Four planets and a floating sun with eccentric planets, over the error period",
                                     "closed form: amplitude of the sum of (-1)^n (e_sn + e_rn) as phasors");
  const auto nominal = floating_sun(4);
  for (int assembly = 0; assembly < 10; ++assembly) {
    const auto s = drawn_assembly(nominal, {.planet_eccentricity = 25e-6}, 3, assembly);
    std::complex<double> sum = 0;  // e_sn + e_rn as phasors
    for (int n = 0; n < 4; ++n)
      for (const auto& errors : {sun_mesh_errors(s, n), ring_mesh_errors(s, n)})
        for (const auto& e : errors) sum += (n % 2 ? -1.0 : 1.0) * e.amount * std::polar(1.0, e.phase);
    const double excess = in_series / 4 * std::abs(sum) / s.mean_mesh_force();
    const double found = error_period_sharing(s, {1}).factors.front() - 1;
    record.at_most("excess of the load-sharing factor over its amplitude", "", found / excess, 1 + 1e-9, "rounding");
    record.close("excess of the load-sharing factor", "", found, excess, 2.2e-3,
                 "(pi/z)^2/6 of the mean over a mesh cycle and (pi/z)^2/2 of whole cycles, z = 55");
  }
}

/// The worst mesh cycles come from the linear response. All cycles of the error period, solved with backlash and
/// varying stiffness, hold none that is worse by more than a thousandth; at a twentieth of the torque, where teeth
/// separate, by one per cent.
BOOST_AUTO_TEST_CASE(no_other_cycle_is_worse) {
  annulus::test::Verification record("Worst mesh cycle of the error period, with backlash and harmonic stiffness",
                                     "the equilibria of all mesh cycles of the error period");
  auto nominal = stages::ring_paper();
  nominal.sun_torque /= 10;
  constexpr int positions = 16;
  double separated = 0;
  for (int assembly = 0; assembly < 4; ++assembly)
    for (const auto& [share, tolerance] : {std::pair{10.0, 1e-3}, {1.0, 1e-3}, {0.5, 1e-2}}) {
      auto s = drawn_assembly(nominal,
                              {.planet_pin_position = 20e-6, .sun_eccentricity = 20e-6, .planet_eccentricity = 15e-6},
                              11, assembly);
      s.sun.support = 1e8;
      s.sun_torque *= share;
      const auto path = quasi_static(s, positions, 100000);
      separated += (path.sun_force.array().abs() < 1).cast<double>().mean();
      const double worst = worst_sharing(path.sun_force, positions);
      const double found = error_period_sharing(s, {1}).factors.front();
      BOOST_TEST(found <= worst * (1 + 1e-9));
      const auto* torque = share == 10 ? "nominal" : share == 1 ? "a tenth" : "a twentieth";
      record.close(std::string("load-sharing factor, torque: ") + torque, "", found, worst, tolerance,
                   share == 0.5 ? "one per cent where teeth separate" : "a thousandth");
    }
  BOOST_TEST(separated > 0);
}

/// A ring whose stiffness changes from tooth to tooth, as on pins, by half its mean: planets between the pins carry
/// less. The cycles of ring and errors together are searched.
BOOST_AUTO_TEST_CASE(no_other_cycle_is_worse_on_a_ring_that_changes_from_tooth_to_tooth) {
  annulus::test::Verification record("Worst mesh cycle on a ring whose stiffness changes by half its mean over 9 teeth",
                                     "the equilibria of all mesh cycles of the error period");
  constexpr int teeth = 9, phases = 16, positions = 16;
  std::vector<double> angles;
  std::vector<StiffnessEntry> entries;
  const std::vector<double> loads = {1e4, 6e4, 12e4};
  for (int tooth = 0; tooth < teeth; ++tooth) {
    angles.push_back(tooth * 2 * std::numbers::pi / 162);
    for (int phase = 0; phase < phases; ++phase)
      for (const double load : loads) {
        const double k = 1.5e9 * (1 + 0.25 * std::cos(2 * std::numbers::pi * (tooth + phase / 16.0) / teeth));
        entries.push_back({0, load / k, k, k, 0});
      }
  }
  const StiffnessTable table("ring_planet", phases, angles, loads, entries);
  auto nominal = stages::ring_paper();
  nominal.planet_errors.clear();
  nominal.ring_mesh = table_stiffness(table, 59e3, 0, LoadDependence::table);
  for (int n = 0; n < 5; ++n) nominal.ring_tooth_offset[static_cast<std::size_t>(n)] = std::floor(162.0 * n / 5);
  double without = 0;
  for (int assembly = -1; assembly < 4; ++assembly) {
    const auto s = assembly < 0 ? nominal
                                : drawn_assembly(nominal, {.planet_pin_position = 15e-6, .planet_eccentricity = 15e-6},
                                                 5, assembly);
    const auto path = quasi_static(s, positions, 100000);
    const double worst = worst_sharing(path.sun_force, positions);
    const double found = error_period_sharing(s, {1}).factors.front();
    BOOST_TEST(found <= worst * (1 + 1e-9));
    record.close(assembly < 0 ? "load-sharing factor without errors" : "load-sharing factor with errors", "", found,
                 worst, assembly < 0 ? 1e-9 : 1e-3, assembly < 0 ? "rounding" : "a thousandth");
    if (assembly < 0) without = worst;
  }
  BOOST_TEST(without > 1.01);  // the ring alone makes the load uneven
}

/// Pin positions of four planets: the pattern is the sum of four independent deviations, nearly normal, and |a| half
/// normal. The quantiles contain those of that law. Var(r²)/2 of a deviation cut at three standard deviations is
/// s² (1 - 4.5 e^-4.5 / (1 - e^-4.5)).
BOOST_AUTO_TEST_CASE(quantiles_are_those_of_a_half_normal_law) {
  annulus::test::Verification record("Quantiles of the load sharing of four planets over 2000 assemblies",
                                     "half-normal law of a sum of four independent deviations");
  const auto nominal = floating_sun(4);
  const double radius = 15e-6, cut = 4.5 * std::exp(-4.5) / (1 - std::exp(-4.5));
  const double per_coordinate = radius / 3 * std::sqrt(1 - cut);
  // A sin(th - phi + a_s) + A sin(th - phi - a_r) = 2 A cos((a_s + a_r)/2) sin(...).
  const double projection = 2 * std::cos((nominal.sun_working_angle + nominal.ring_working_angle) / 2);
  const double deviation = in_series / 4 * 2 * projection * per_coordinate / nominal.mean_mesh_force();
  const auto result = assembly_sharing(nominal, {.planet_pin_position = radius}, {.assemblies = 2000, .threads = 2});
  for (const auto& [probability, normal] : {std::pair{0.5, 0.67449}, {0.95, 1.95996}, {0.99, 2.57583}}) {
    const auto found = quantile_interval(result.factors.front(), probability, 0.999);
    const auto name = "quantile " + std::to_string(std::lround(100 * probability)) + " % of K less 1";
    record.near(name, "", found.value - 1, normal * deviation,
                std::max(found.high - found.value, found.value - found.low),
                "99.9 % interval of a quantile of 2000 draws");
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(assembly_draws)

// A generator passes on the torque, and what changes in it has no tolerance.
BOOST_AUTO_TEST_CASE(a_drive_line_changes_nothing) {
  auto stage = floating_sun(4);
  const StageTolerances tolerances{50e-6, 20e-6, 30e-6, 40e-6};
  const auto alone = assembly_sharing(stage, tolerances, {.assemblies = 10});
  stage.rotors = {{"generator", "sun", 3, 4e6, 0.02}};
  stage.rotors[0].ripples = {{std::numbers::sqrt2, 0.2 * stage.sun_torque, 0}};
  const auto driven = assembly_sharing(stage, tolerances, {.assemblies = 10});
  BOOST_TEST(driven.factors.front() == alone.factors.front(), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(draws_stay_in_their_zones_and_depend_on_nothing_else) {
  const auto nominal = stages::ring_paper();
  for (const auto within : {WithinZone::normal, WithinZone::uniform})
    for (int i = 0; i < 200; ++i) {
      const StageTolerances zones{.planet_pin_position = 10e-6, .sun_eccentricity = 5e-6, .within = within};
      const auto s = drawn_assembly(nominal, zones, 1, i);
      BOOST_TEST(s.planet_errors[3].position.amount <= 10e-6);
      BOOST_TEST(s.sun.errors.eccentricity.amount <= 5e-6);
      BOOST_TEST(s.planet_errors[3].eccentricity.amount == nominal.planet_errors[3].eccentricity.amount);
      auto wider = zones;
      wider.planet_pin_position *= 2;
      const auto other = drawn_assembly(nominal, wider, 1, i);
      BOOST_TEST(other.sun.errors.eccentricity.amount == s.sun.errors.eccentricity.amount);
      BOOST_TEST(other.planet_errors[3].position.amount == 2 * s.planet_errors[3].position.amount);
    }
}

BOOST_AUTO_TEST_CASE(contributions_and_threads) {
  auto s = floating_sun(4);
  s.planet_errors.assign(4, {});
  s.planet_errors[1].position = {40e-6, 0.3};  // of the scene: the draws replace it, in the contributions as well
  const StageTolerances tolerances{.planet_pin_position = 20e-6, .sun_eccentricity = 30e-6};
  AssemblyOptions options{.assemblies = 300, .torque_shares = {0.5, 2}};
  const auto one = assembly_sharing(s, tolerances, options);
  options.threads = 2;
  const auto two = assembly_sharing(s, tolerances, options);
  BOOST_TEST((one.factors == two.factors));
  BOOST_TEST(one.torque_shares == (std::vector<double>{0.5, 1, 2}), boost::test_tools::per_element());
  // Linear: the excess is inverse to the torque.
  for (std::size_t i = 0; i < 300; ++i)
    BOOST_TEST(std::abs((one.factors[0][i] - 1) - 4 * (one.factors[2][i] - 1)) < 1e-8);
  // A floating sun makes up for its own eccentricity.
  BOOST_TEST_REQUIRE(one.contributions.size() == 2U);
  BOOST_TEST(std::abs(one.contributions[1].alone.p99.value - 1) < 1e-9);
  BOOST_TEST(std::abs(one.contributions[0].alone.p95.value - one.quantiles[1].p95.value) < 1e-9);
  BOOST_TEST(std::abs(one.contributions[0].without.p95.value - 1) < 1e-9);
  BOOST_CHECK_THROW((void)assembly_sharing(s, {}, options), InputError);
  options.torque_shares = {0};
  BOOST_CHECK_THROW((void)assembly_sharing(s, tolerances, options), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
