#include "dynamics/systems/planetary/study_point.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "dynamics/systems/planetary/planetary_modes.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

namespace annulus::dynamics {

namespace {

/// Central bodies held, constant stiffness, pin position errors of the planets alone: nothing moves.
PlanetaryStage held_centres() {
  auto stage = stages::ring_paper();
  for (auto* body : {&stage.sun, &stage.ring, &stage.carrier}) body->support = rigid;
  stage.ring.torsional_support = rigid;
  stage.sun_mesh = ConstantStiffness{1.364e9};
  stage.ring_mesh = ConstantStiffness{1.87e9};
  const double amount[] = {11, 32, 13, 34, 15}, phase[] = {20, 70, 190, 260, 330};
  for (std::size_t n = 0; n < 5; ++n) stage.planet_errors[n] = {{}, {amount[n] * units::um, phase[n] * units::deg}};
  return stage;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(study_point)

BOOST_AUTO_TEST_CASE(held_centres_share_after_the_closed_form) {
  // Closed form: L = 1 + max_n K_path (mean(e) - e_n) / F
  test::Verification record("Load sharing of a point of a study, central bodies held",
                            "closed form: L = 1 + max K (mean error - error_n) / F");
  const auto stage = held_centres();
  const double a = stage.sun_working_angle, r = stage.ring_working_angle;
  const double path = 1 / (1 / 1.364e9 + 1 / 1.87e9 +
                           (std::pow(std::cos(a) + std::cos(r), 2) + std::pow(std::sin(a) - std::sin(r), 2)) / 1e9);
  double mean = 0, lowest = 1e9;
  for (int n = 0; n < 5; ++n) {
    const double e = sun_mesh_error(stage, n, 0).value + ring_mesh_error(stage, n, 0).value;
    mean += e / 5;
    lowest = std::min(lowest, e);
  }
  const double expected = 1 + path * (mean - lowest) / stage.mean_mesh_force();
  const auto point = evaluate_point(stage, {});
  // Without the rotating frame's centripetal terms it would be exact; they are 1e-4 of the bearing stiffness.
  for (const std::string mesh : {"sun_planet_", "ring_planet_"}) {
    const auto value = [&](const char* key) { return point.figures.value(mesh + key); };
    const double averaged = value("load_sharing_averaged"), quasi_static = value("load_sharing_quasi_static");
    record.close("load sharing coefficient", "", quasi_static, expected, 2e-4,
                 "centripetal terms: 1e-4 of the bearing stiffness");
    record.close("averaged against quasi-static coefficient", "", averaged, quasi_static, 1e-4,
                 "centripetal terms: 1e-4 of the bearing stiffness");
    BOOST_TEST(value("peak_factor") == averaged, boost::test_tools::tolerance(1e-4));
    // Whatever the planets carry, nothing vibrates.
    BOOST_TEST(value("dynamic_factor") == 1.0, boost::test_tools::tolerance(1e-4));
    BOOST_TEST(value("contact_loss") == 0.0);
  }
  BOOST_TEST(point.figures.value("steady") == 1.0);
  BOOST_TEST(!point.figures.find("sun_rms_m"));  // held
  // Nothing moves: the deflection of each mesh is constant, to the integrator's tolerance of some 1e-6 of 50 um.
  BOOST_TEST(point.figures.value("sun_planet_deflection_peak_to_peak_m") < 1e-8);
  // Poincare points carry the force and its deflection: F = k (delta - b/2), to the integrator's tolerance.
  BOOST_TEST_REQUIRE(point.poincare.size() == static_cast<std::size_t>(point.window_cycles));
  for (const auto& p : point.poincare)
    BOOST_TEST(p.force == 1.364e9 * (p.deflection - 50e-6), boost::test_tools::tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(motion_is_that_of_the_time_series) {
  annulus::test::Verification record("Motion of the sun at a point of a study",
                                     "the time series of the same stage, evaluated anew");
  auto stage = stages::ring_paper();
  SimulationOptions options;
  options.mesh_cycles = 70;
  options.estimate_error = false;
  const auto point = evaluate_point(stage, {.simulation = options, .poincare_cycles = 10});
  const auto response = simulate(stage, options);
  const auto& s = response.series;
  const auto x = s.displacement.row(0), y = s.displacement.row(1);
  const double rms = std::sqrt(((x.array() - x.mean()).square() + (y.array() - y.mean()).square()).mean());
  record.close("root mean square of the orbit", "m", point.figures.value("sun_rms_m"), rms, 1e-12, "rounding of sums");
  BOOST_TEST(point.figures.value("sun_planet_load_sharing_averaged") ==
             response.sun_planet.load_sharing.averaged.value);
  BOOST_TEST(point.poincare.size() == 10U);
  BOOST_TEST(point.poincare[3].force == s.force(0, 3 * options.samples_per_cycle));
  // In contact F = k (delta - b/2) + c delta', the damper's part being small: delta is near b/2 + F / k(0).
  record.close("deflection of a Poincare point", "m", point.poincare[3].deflection,
               50e-6 + point.poincare[3].force / (1.364e9 * 1.2258), 0.02, "the damper's part of the force");
  // Frequencies: distinct and rising, those of the modes.
  const auto all = modes(stage).modes;
  double last = 0;
  for (int i = 1; i <= 6; ++i) {
    const double frequency = point.figures.value("frequency_" + std::to_string(i) + "_Hz");
    BOOST_TEST(frequency > last * (1 + 1e-6));
    BOOST_TEST(std::any_of(all.begin(), all.end(), [&](const Mode& m) { return m.frequency == frequency; }));
    last = frequency;
  }
  const auto bare = evaluate_point(stage, {.simulation = options, .motion = false});
  BOOST_TEST(bare.poincare.empty());
  BOOST_TEST(!bare.figures.find("frequency_1_Hz"));
  BOOST_TEST(bare.figures.value("ring_planet_dynamic_factor") == point.figures.value("ring_planet_dynamic_factor"));
}

BOOST_AUTO_TEST_CASE(points_agree_with_time_integration) {
  test::Verification record("Load sharing of a point of a study", "time integration to the steady state");
  const auto stage = stages::ring_paper();
  SimulationOptions stepped;
  stepped.steady_state = SteadyState::time_integration;
  const auto integrated = simulate(stage, stepped);
  // Sampling (64 or 32 per cycle, peaks refined) and steady_tolerance: 1e-3 of the mean force.
  const char* origin = "sampling and steady state: 1e-3 of the mean force";
  for (const bool motion : {true, false}) {
    const auto point = evaluate_point(stage, {.simulation = {}, .motion = motion});
    BOOST_TEST(point.figures.value("steady") == 1.0);
    record.close("averaged, sun meshes", "", point.figures.value("sun_planet_load_sharing_averaged"),
                 integrated.sun_planet.load_sharing.averaged.value, 2e-3, origin);
    record.close("instantaneous, ring meshes", "", point.figures.value("ring_planet_load_sharing_instantaneous"),
                 integrated.ring_planet.load_sharing.instantaneous.value, 2e-3, origin);
    record.close("quasi-static, sun meshes", "", point.figures.value("sun_planet_load_sharing_quasi_static"),
                 integrated.sun_planet.load_sharing.quasi_static.value, 2e-3, origin);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::dynamics
