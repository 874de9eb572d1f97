#include "dynamics/systems/planetary/planetary_modes.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "core/errors.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(modes)

using namespace annulus::dynamics;

std::vector<double> frequencies(const PlanetaryModes& found, ModeKind kind) {
  std::vector<double> list;
  for (std::size_t i = 0; i < found.modes.size(); ++i)
    if (found.kinds[i] == kind) list.push_back(found.modes[i].frequency);
  return list;
}

// [LinParker1999], table of the four-planet example. 0.05 %: the published figures (four to
// six digits) rest on rounded inputs; the lowest pair deviates by 0.043 %.
BOOST_AUTO_TEST_CASE(lin_and_parker_four_planets) {
  annulus::test::Verification record(
      "Natural frequencies of a planetary stage with four planets",
      "Lin and Parker, J. Vib. Acoust. 121 (1999), published frequencies of the four-planet example");
  const auto found = annulus::dynamics::modes(stages::lin_parker(4));
  BOOST_REQUIRE(found.modes.size() == 21U);
  const std::map<ModeKind, std::vector<double>> published = {
      {ModeKind::rotational, {0, 1536.6, 1970.6, 2625.7, 7773.6, 13071.1}},
      {ModeKind::translational,
       {727.0, 727.0, 1091.0, 1091.0, 1892.8, 1892.8, 2342.5, 2342.5, 7189.9, 7189.9, 10437.6, 10437.6}},
      {ModeKind::planet, {1808.2, 5963.8, 6981.7}}};
  std::vector<annulus::test::RecordedPlot::Curve> curves;
  for (const auto& [kind, values] : published) {
    const auto list = frequencies(found, kind);
    BOOST_REQUIRE(list.size() == values.size());
    annulus::test::RecordedPlot::Curve curve{to_string(kind), {}, {}, {}};
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto name = std::string(to_string(kind)) + " mode " + std::to_string(i + 1);
      record.near(name, "Hz", list[i], values[i], 5e-4 * values[i], "published digits, rounded inputs");
      curve.x.push_back(static_cast<double>(i + 1));
      curve.computed.push_back(list[i]);
      curve.reference.push_back(values[i]);
    }
    curves.push_back(curve);
  }
  record.plot({"Natural frequencies", "number within its kind", "Hz", curves});
}

BOOST_AUTO_TEST_CASE(structure_for_any_number_of_planets) {
  annulus::test::Verification record("Kinds and multiplicities of modes with three to eight equal planets",
                                     "Lin and Parker 1999: 6 rotational, 6 pairs of translational, 3 planet modes "
                                     "(N - 3)-fold, for any number N of planets");
  std::vector<double> planet_frequencies;
  for (int planets = 3; planets <= 8; ++planets) {
    const auto found = annulus::dynamics::modes(stages::lin_parker(planets));
    const auto rotational = frequencies(found, ModeKind::rotational);
    const auto translational = frequencies(found, ModeKind::translational);
    const auto planet = frequencies(found, ModeKind::planet);
    BOOST_TEST(rotational.size() == 6U);
    BOOST_TEST(translational.size() == 12U);
    BOOST_TEST(planet.size() == static_cast<std::size_t>(3 * (planets - 3)));
    BOOST_TEST(rotational.front() == 0.0);
    // Pairs and multiples of one frequency differ by rounding: eps x the square of the highest frequency over twice the
    // frequency itself, 2e-11 of it at worst.
    for (std::size_t i = 0; i < translational.size(); i += 2)
      record.near("frequencies of a translational pair", "Hz", translational[i + 1], translational[i],
                  1e-9 * translational[i], "rounding of the eigenvalue solver");
    if (planets == 4) planet_frequencies = planet;
    for (std::size_t i = 0; i < planet.size(); ++i)  // three frequencies, each planets - 3 times, for every number
      record.near("planet modes against those of four planets", "Hz", planet[i], planet_frequencies[i / (planets - 3)],
                  1e-9 * planet[i], "rounding of the eigenvalue solver");
  }
}

BOOST_AUTO_TEST_CASE(shapes_are_mass_normalised_and_solve_the_eigenproblem) {
  annulus::test::Verification record("Mode shapes solve the eigenproblem", "definition: K x = w^2 M x, x' M x = 1");
  const auto stage = stages::ring_paper();
  const auto system = assemble(stage);
  const auto found = annulus::dynamics::modes(stage);
  BOOST_TEST((found.dofs == system.names()));
  Eigen::MatrixXd stiffness = system.stiffness();
  for (int m = 0; m < 10; ++m)
    stiffness += (m < 5 ? 1.364e9 : 1.87e9) * system.mesh_vector(m) * system.mesh_vector(m).transpose();
  for (const auto& mode : found.modes) {
    record.near("modal mass", "", mode.shape.dot(system.mass() * mode.shape), 1, 1e-12, "rounding");
    const double square = std::pow(2 * std::numbers::pi * mode.frequency, 2);
    // Backward error of the dense solver: eps x size x the largest stiffness.
    const Eigen::VectorXd residual = stiffness * mode.shape - square * system.mass() * mode.shape;
    record.at_most("residual over the largest stiffness", "",
                   residual.cwiseAbs().maxCoeff() / stiffness.cwiseAbs().maxCoeff(), 1e-13,
                   "backward error of the dense solver: eps x size");
  }
  for (const auto kind : found.kinds) BOOST_TEST((kind != ModeKind::mixed));
  BOOST_TEST(found.modes.front().frequency == 0.0);
  BOOST_TEST(found.modes[1].frequency > 1.0);  // one rigid motion only
}

// [Kahraman1994]: purely torsional, ring fixed, planets riding on the carrier. In coordinates
// u the planets' own modes have w^2 = (k1 + k2)/m_p, N - 1 times.
BOOST_AUTO_TEST_CASE(torsional_closed_form) {
  annulus::test::Verification record(
      "Torsional natural frequencies, planets riding on the carrier",
      "closed form: Kahraman, Mech. Mach. Theory 29 (1994); reduction to three degrees of freedom");
  auto stage = stages::ring_paper();
  for (double* support :
       {&stage.sun.support, &stage.ring.support, &stage.carrier.support, &stage.ring.torsional_support})
    *support = rigid;
  stage.planet_bearings.clear();
  const auto found = annulus::dynamics::modes(stage);
  BOOST_REQUIRE(found.modes.size() == 7U);
  const double mp = stage.planet.inertia / std::pow(stage.planet.radius, 2);
  const double expected = std::sqrt((1.364e9 + 1.87e9) / mp) / (2 * std::numbers::pi);
  const auto planet = frequencies(found, ModeKind::planet);
  BOOST_REQUIRE(planet.size() == 4U);
  for (const double f : planet) record.close("planet modes, N - 1 times", "Hz", f, expected, 1e-12, "rounding");

  // The other two roots: sun s, carrier c and the planets moving alike p reduce to three DOFs with potential
  // N/2 [k1 (s + p - cos a_s c)^2 + k2 (-p - cos a_r c)^2]. w = 0 leaves a quadratic for w^2.
  const double n = 5, ms = stage.sun.inertia / std::pow(stage.sun.radius, 2);
  const double mc = stage.carrier.inertia / std::pow(stage.carrier.radius, 2) + n * stage.planet.mass, m = n * mp;
  const double k1 = n * 1.364e9, k2 = n * 1.87e9, cs = std::cos(stage.sun_working_angle),
               cr = std::cos(stage.ring_working_angle);
  const double trace = k1 / ms + (k1 + k2) / m + (k1 * cs * cs + k2 * cr * cr) / mc;
  // Sum of the principal second minors of M^-1 K: each is k1 k2 (b1 x b2)^2 / (m_i m_j).
  const double minors = k1 * k2 * (1 / (ms * m) + cr * cr / (ms * mc) + std::pow(cs + cr, 2) / (m * mc));
  const double root = std::sqrt(trace * trace - 4 * minors);
  const auto rotational = frequencies(found, ModeKind::rotational);
  BOOST_REQUIRE(rotational.size() == 3U);
  BOOST_TEST(rotational[0] == 0.0);
  for (const int i : {1, 2}) {
    const double square = (trace + (i == 1 ? -root : root)) / 2;
    record.close(i == 1 ? "lower rotational mode" : "upper rotational mode", "Hz", rotational[i],
                 std::sqrt(square) / (2 * std::numbers::pi), 1e-12, "rounding");
  }
}

// A stiff bearing tends to the rigid one: first order in 1/k_p.
BOOST_AUTO_TEST_CASE(rigid_bearings_are_the_limit_of_stiff_ones) {
  annulus::test::Verification record("A stiff planet bearing tends to the rigid one",
                                     "limit: the difference is of first order in 1 / bearing stiffness");
  auto stage = stages::ring_paper();
  stage.planet_bearings.clear();
  const auto limit = annulus::dynamics::modes(stage);
  double previous = 0;
  for (const double stiffness : {1e12, 1e13}) {
    stage.planet_bearings = {{stiffness, stiffness}};
    const auto found = annulus::dynamics::modes(stage);
    double worst = 0;
    for (std::size_t i = 1; i < limit.modes.size(); ++i)
      worst = std::max(worst, std::abs(found.modes[i].frequency / limit.modes[i].frequency - 1));
    BOOST_TEST(worst < 20 * 1.87e9 / stiffness);
    if (previous > 0)
      record.near("difference of frequencies, 1e12 against 1e13 N/m", "times", previous / worst, 10, 0.5,
                  "second order");
    previous = worst;
  }
}

BOOST_AUTO_TEST_CASE(unequal_spacing_mixes_the_kinds) {
  annulus::test::Verification record("Modes of four planets of which one is displaced",
                                     "symmetry is lost, and with it the kinds; turning as a whole stays free");
  auto stage = stages::lin_parker(4);
  stage.planet_angles[1] += 0.3;
  const auto found = annulus::dynamics::modes(stage);
  record.at_least("mixed modes", "", static_cast<double>(frequencies(found, ModeKind::mixed).size()), 1, "some");
  record.near("lowest frequency", "Hz", found.modes.front().frequency, 0, 0, "turning stays free");
}

// [LinParker2000]: planet modes take no notice of where the planets stand; with planets in opposite pairs rotational
// modes do not either, and modes that only translate remain, no longer in pairs.
BOOST_AUTO_TEST_CASE(what_unequal_spacing_leaves_alone) {
  annulus::test::Verification record(
      "Modes of unequally spaced planets that those of equally spaced ones share",
      "Lin and Parker, Structured vibration characteristics of planetary gears with unequally spaced planets, J. Sound "
      "Vib. 233 (2000)");
  const auto same = [&](const std::string& name, const std::vector<double>& a, const std::vector<double>& b) {
    BOOST_TEST_REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) record.near(name, "Hz", a[i], b[i], 1e-9 * b[i], "rounding");
  };
  auto five = stages::lin_parker(5);
  const auto equal_five = annulus::dynamics::modes(five);
  five.planet_angles = {0, 1.1, 2.7, 3.9, 5.1};
  const auto unequal_five = annulus::dynamics::modes(five);
  BOOST_TEST(frequencies(unequal_five, ModeKind::planet).size() == 6U);
  same("planet modes, five planets anywhere", frequencies(unequal_five, ModeKind::planet),
       frequencies(equal_five, ModeKind::planet));
  BOOST_TEST(frequencies(unequal_five, ModeKind::translational).empty());

  auto four = stages::lin_parker(4);
  const auto equal_four = annulus::dynamics::modes(four);
  four.planet_angles = {0, 1.2, std::numbers::pi, std::numbers::pi + 1.2};
  const auto opposite = annulus::dynamics::modes(four);
  same("planet modes, two opposite pairs", frequencies(opposite, ModeKind::planet),
       frequencies(equal_four, ModeKind::planet));
  same("rotational modes, two opposite pairs", frequencies(opposite, ModeKind::rotational),
       frequencies(equal_four, ModeKind::rotational));
  const auto translational = frequencies(opposite, ModeKind::translational);
  BOOST_TEST(translational.size() == 12U);
  for (std::size_t i = 0; i < translational.size(); i += 2)
    BOOST_TEST(translational[i + 1] - translational[i] > 1e-3 * translational[i]);
}

// One and two planets have less symmetry: two planets leave modes that are alike (6) and unlike (9) under half a turn,
// one planet leaves none.
BOOST_AUTO_TEST_CASE(one_and_two_planets) {
  annulus::test::Verification record("Numbers of modes with one and with two planets",
                                     "symmetry: even and odd under half a turn; none with one planet");
  const auto counted = [&](const char* which, std::size_t found, int expected) {
    record.near(which, "", static_cast<double>(found), expected, 0, "counted by hand");
  };
  const auto two = annulus::dynamics::modes(stages::lin_parker(2));
  counted("modes even under half a turn, two planets", frequencies(two, ModeKind::rotational).size(), 6);
  counted("modes unlike under half a turn, two planets", frequencies(two, ModeKind::translational).size(), 9);
  const auto one = annulus::dynamics::modes(stages::lin_parker(1));
  counted("modes, one planet", one.modes.size(), 12);
  record.near("lowest frequency, one planet", "Hz", one.modes.front().frequency, 0, 0, "turning stays free");
  BOOST_TEST((one.kinds.front() == ModeKind::rotational));
  BOOST_TEST(one.modes[1].frequency > 1.0);
}

// With the centres held and the ring fixed the planets' own motions are one frequency N - 1 times for any N from 2 on;
// rotational and planet modes are distinguished also where a frequency is shared.
BOOST_AUTO_TEST_CASE(held_centres) {
  annulus::test::Verification record("Planet modes with the centres held, one to six planets",
                                     "symmetry: 3 frequencies, N - 1 times each");
  for (int planets = 1; planets <= 6; ++planets) {
    auto stage = stages::lin_parker(planets);
    for (double* support :
         {&stage.sun.support, &stage.ring.support, &stage.carrier.support, &stage.ring.torsional_support})
      *support = rigid;
    const auto found = annulus::dynamics::modes(stage);
    const auto planet = frequencies(found, ModeKind::planet);
    BOOST_TEST(frequencies(found, ModeKind::rotational).size() == 5U);  // sun, carrier, planets alike in x, y, u
    BOOST_REQUIRE(planet.size() == static_cast<std::size_t>(3 * (planets - 1)));
    for (std::size_t i = 0; i + 1 < planet.size(); ++i)
      if (i % (planets - 1) + 1 < static_cast<std::size_t>(planets - 1))
        record.near("multiple frequencies", "Hz", planet[i + 1], planet[i], 1e-9 * planet[i],
                    "rounding of the eigenvalue solver");

    // Nothing turns but the planets: N equal and separate bodies, one combination of which is alike.
    stage.sun.torsional_support = stage.carrier.torsional_support = rigid;
    const auto apart = annulus::dynamics::modes(stage);
    BOOST_TEST(frequencies(apart, ModeKind::rotational).size() == 3U);
    BOOST_TEST(frequencies(apart, ModeKind::planet).size() == static_cast<std::size_t>(3 * (planets - 1)));
  }
}

// Three planets between floating bodies: 18 DOFs, 13 springs, so one rotation and two pairs of translations cost
// nothing. They share a frequency and are distinguished.
BOOST_AUTO_TEST_CASE(rigid_motions_are_distinguished) {
  annulus::test::Verification record("Motions of three planets between floating bodies that cost nothing",
                                     "counted by hand: 18 degrees of freedom, 13 springs");
  auto stage = stages::lin_parker(3);
  stage.sun.support = stage.ring.support = stage.carrier.support = 0;
  const auto found = annulus::dynamics::modes(stage);
  for (int i = 0; i < 5; ++i) record.near("frequency of a rigid motion", "Hz", found.modes[i].frequency, 0, 0, "exact");
  record.at_least("lowest frequency that is none", "Hz", found.modes[5].frequency, 1, "far above rounding");
  BOOST_TEST(found.modes[5].frequency > 1.0);
  record.near("rotational modes", "", static_cast<double>(frequencies(found, ModeKind::rotational).size()), 6, 0,
              "counted by hand");
  record.near("translational modes", "", static_cast<double>(frequencies(found, ModeKind::translational).size()), 12, 0,
              "counted by hand");
}

BOOST_AUTO_TEST_CASE(tables_enter_with_their_mean_tangent) {
  annulus::test::Verification record("Natural frequencies with a table of tangents of 4e8 and 6e8 N/m",
                                     "the stage with constant meshes of 5e8 N/m");
  auto stage = stages::lin_parker(4);
  const annulus::PeriodicCurve secant({9e8}, 1), tangent({4e8, 6e8}, 2), zero({0.0}, 1);
  stage.sun_mesh = stage.ring_mesh = TableStiffness{secant, tangent, zero, 0};
  const auto found = annulus::dynamics::modes(stage), reference = annulus::dynamics::modes(stages::lin_parker(4));
  for (std::size_t i = 0; i < found.modes.size(); ++i)
    record.near("frequency", "Hz", found.modes[i].frequency, reference.modes[i].frequency, 0, "the same matrix");
}

BOOST_AUTO_TEST_SUITE_END()
