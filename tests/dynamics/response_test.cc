#include "dynamics/systems/planetary/response.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(response)

using namespace annulus;
using namespace annulus::dynamics;

SimulationOptions quick() {
  SimulationOptions options;
  options.samples_per_cycle = 32;
  return options;
}

BOOST_AUTO_TEST_CASE(base_scene_reaches_its_steady_state) {
  annulus::test::Verification record("Steady state of the stage of the ring paper", "balances of energy and of forces");
  const auto stage = stages::ring_paper();
  const auto r = simulate(stage, quick());
  BOOST_TEST(r.steady);
  BOOST_TEST(r.whole_period);
  BOOST_TEST(r.window_cycles == 55);
  BOOST_TEST(r.total_cycles % 55 == 0);
  BOOST_TEST(*r.steady_difference <= SimulationOptions{}.steady_tolerance);
  // Bookkeeping to the integrator's tolerance times its steps (5000 x 1e-6).
  record.at_most("energy balance, relative", "", r.energy.relative, 5e-3, "integrator: 5000 steps of 1e-6");
  BOOST_TEST(r.energy.dissipated > 0);
  record.at_most("balance of the mean forces, relative", "", r.force_balance_relative, 1e-4, "steady to 1e-3");
  for (const auto* kind : {&r.sun_planet, &r.ring_planet}) {
    double mean = 0;
    for (const auto& branch : kind->branches) {
      mean += branch.mean_force / 5;
      BOOST_TEST(branch.contact_loss.value == 0.0);
      BOOST_TEST(branch.peak_factor.value > branch.mean_force / r.mean_mesh_force);
      BOOST_TEST(branch.smallest_factor < branch.mean_force / r.mean_mesh_force);
      BOOST_TEST(branch.peak_factor.error <= 5e-3);
    }
    record.near("mean force over that of statics", "", mean / r.mean_mesh_force, 1, 1e-4,
                "steady to 1e-3, most of it in the differences");
    const auto& sharing = kind->load_sharing;
    BOOST_TEST(sharing.averaged.value < sharing.instantaneous.value);
    BOOST_TEST(sharing.averaged.value > 1.0);
    BOOST_TEST(sharing.quasi_static.value > 1.0);
    BOOST_TEST(sharing.instantaneous.error <= 5e-3);
  }
  BOOST_REQUIRE(r.series.time.size() == 55 * 32);
  BOOST_TEST(r.series.force.rows() == 10);
  BOOST_TEST((r.series.meshes.front() == "sun_planet1" && r.series.meshes.back() == "ring_planet5"));
  BOOST_TEST(std::abs(r.series.time[0] - (r.total_cycles - 55) / r.mesh_frequency) <= 1e-12);
}

// Three ways to the same steady state: harmonic balance, harmonic balance confirmed, time integration from rest.
BOOST_AUTO_TEST_CASE(harmonic_balance_and_time_integration_agree) {
  annulus::test::Verification record("Harmonic balance and time integration to the same steady state", "each other");
  auto stage = stages::ring_paper();
  stage.planet_errors[1].eccentricity.phase = 2;
  auto options = quick();
  const auto confirmed = simulate(stage, options);
  BOOST_TEST(confirmed.confirmed);
  BOOST_TEST(confirmed.total_cycles == 55);
  BOOST_REQUIRE((confirmed.periodic && confirmed.periodic->converged));
  // The integrator's tolerance of 1e-6 times some, and what 16 harmonics leave out.
  BOOST_TEST(*confirmed.steady_difference <= 1e-5);
  options.confirmation = Confirmation::never;
  const auto direct = simulate(stage, options);
  BOOST_TEST(direct.steady);
  BOOST_TEST(direct.total_cycles == 0);
  BOOST_TEST(std::isnan(direct.energy.relative));
  BOOST_TEST(direct.force_balance_relative <= 1e-6);
  record.at_most("largest difference of a mesh force over the mean", "",
                 (direct.series.force - confirmed.series.force).cwiseAbs().maxCoeff() / direct.mean_mesh_force, 1e-5,
                 "integrator 1e-6, harmonics above the 16th");
  annulus::test::RecordedPlot::Curve curve{"", {}, {}, {}};
  for (Eigen::Index i = 0; i < 96; ++i) {
    curve.x.push_back(static_cast<double>(i) / 32);
    curve.computed.push_back(direct.series.force(0, i) * 1e-3);
    curve.reference.push_back(confirmed.series.force(0, i) * 1e-3);
  }
  record.plot({"Force on the first sun mesh", "mesh cycles", "kN", {curve}});
  options.keep_series = false;
  BOOST_TEST(simulate(stage, options).series.force.size() == 0);
  options = quick();
  options.steady_state = SteadyState::time_integration;
  const auto integrated = simulate(stage, options);
  BOOST_TEST(integrated.steady);
  BOOST_TEST((!integrated.periodic && !integrated.confirmed));
  for (const auto& [a, b] :
       {std::pair(direct.sun_planet, integrated.sun_planet), std::pair(direct.ring_planet, integrated.ring_planet)}) {
    const auto agree = [](const Figure& x, const Figure& y) {
      return std::abs(x.value - y.value) <= x.error + y.error;
    };
    BOOST_TEST(agree(a.load_sharing.instantaneous, b.load_sharing.instantaneous));
    BOOST_TEST(agree(a.load_sharing.averaged, b.load_sharing.averaged));
    for (int n = 0; n < 5; ++n) BOOST_TEST(agree(a.branches[n].peak_factor, b.branches[n].peak_factor));
  }
}

// At a tenth of the torque contact is lost everywhere and harmonic balance fails; time integration settles, also
// when no confirmation was asked for.
BOOST_AUTO_TEST_CASE(time_integration_takes_over_where_harmonic_balance_fails) {
  annulus::test::Verification record("A tenth of the torque: time integration where harmonic balance fails",
                                     "two windows of an error period, which have to agree; contact is lost");
  auto stage = stages::ring_paper();
  stage.sun_torque *= 0.1;
  auto options = quick();
  options.confirmation = Confirmation::never;
  options.periodic.max_iterations = 3;
  const auto r = simulate(stage, options);
  BOOST_REQUIRE(r.periodic.has_value());
  BOOST_TEST(!r.periodic->converged);
  BOOST_TEST(!r.periodic->trouble.empty());
  BOOST_TEST(r.steady);
  BOOST_TEST(!r.confirmed);
  record.at_least("mesh cycles integrated", "", r.total_cycles, 110, "two error periods of 55");
  record.at_least("times a mesh opens or closes", "", static_cast<double>(r.statistics.contact_events), 1,
                  "contact is lost");
}

// The error that is stated covers the distance to a much finer run.
BOOST_AUTO_TEST_CASE(stated_errors_cover_the_true_ones) {
  annulus::test::Verification record("Stated errors of load sharing, dynamic and peak factors",
                                     "a run with 8 times the samples, a thousandth of the tolerance, ten periods");
  const auto stage = stages::ring_paper();
  const auto coarse = simulate(stage, quick());
  SimulationOptions fine;
  fine.samples_per_cycle = 256;
  fine.integrator.relative_tolerance = 1e-9;
  fine.mesh_cycles = 10 * 55;
  const auto truth = simulate(stage, fine);
  BOOST_TEST(*truth.steady_difference < 1e-6);
  const auto covered = [&](const std::string& name, const Figure& a, const Figure& b) {
    record.near(name, "", a.value, b.value, a.error + 1e-9, "its own stated error");
  };
  covered("instantaneous load sharing, sun meshes", coarse.sun_planet.load_sharing.instantaneous,
          truth.sun_planet.load_sharing.instantaneous);
  covered("instantaneous load sharing, ring meshes", coarse.ring_planet.load_sharing.instantaneous,
          truth.ring_planet.load_sharing.instantaneous);
  covered("averaged load sharing, sun meshes", coarse.sun_planet.load_sharing.averaged,
          truth.sun_planet.load_sharing.averaged);
  for (int n = 0; n < 5; ++n) {
    const auto &rough = coarse.sun_planet.branches[n], &accurate = truth.sun_planet.branches[n];
    covered("peak factor of a sun mesh", rough.peak_factor, accurate.peak_factor);
    covered("dynamic factor of a sun mesh", rough.dynamic_factor, accurate.dynamic_factor);
  }
}

// Slow enough, the dynamic forces are the quasi-static ones.
BOOST_AUTO_TEST_CASE(slow_running_is_quasi_static) {
  annulus::test::Verification record("A planetary stage at a crawl", "limit: quasi-static forces");
  auto stage = stages::ring_paper();
  stage.carrier_speed /= 400;                               // 1.7 Hz mesh frequency, natural frequencies from 183 Hz on
  for (auto& e : stage.planet_errors) e.eccentricity = {};  // period of one mesh cycle
  auto options = quick();
  options.min_window_cycles = 1;
  options.samples_per_cycle = 16;
  const auto r = simulate(stage, options);
  const auto path = quasi_static(stage, 16);
  BOOST_REQUIRE(r.series.force.cols() == path.sun_force.cols());
  // Inertia adds (1.7/183)^2 = 1e-4 of the change of force over a cycle (some per cent of the mean), dampers
  // c w / k = 2 zeta w / w_n = 1e-3 of it.
  const char* origin = "(1.7 Hz / 183 Hz)^2 and dampers, 1e-3, of a change of some per cent";
  record.at_most("sun mesh force, largest difference over the mean", "",
                 (r.series.force.topRows(5) - path.sun_force).cwiseAbs().maxCoeff() / r.mean_mesh_force, 1e-4, origin);
  record.at_most("ring mesh force, largest difference over the mean", "",
                 (r.series.force.bottomRows(5) - path.ring_force).cwiseAbs().maxCoeff() / r.mean_mesh_force, 1e-4,
                 origin);
  BOOST_TEST((path.sun_force.rowwise().maxCoeff() - path.sun_force.rowwise().minCoeff()).maxCoeff() >
             0.01 * r.mean_mesh_force);
}

// While no mesh separates, backlash only shifts the coordinates.
BOOST_AUTO_TEST_CASE(backlash_does_not_matter_without_separation) {
  annulus::test::Verification record("Backlash while no mesh separates", "theorem: it only shifts the coordinates");
  auto stage = stages::ring_paper();
  auto options = quick();
  options.mesh_cycles = 165;
  options.integrator.absolute_tolerance = 1e-12;
  stage.set_half_backlash({});
  const auto linear = simulate(stage, options);
  for (const double half : {1e-5, 1e-3}) {
    stage.set_half_backlash(half);
    const auto r = simulate(stage, options);
    BOOST_TEST(r.statistics.contact_events == 0);
    // The shift changes magnitudes, hence steps: tolerance x steps.
    record.at_most("largest difference of a mesh force over the mean", "",
                   (r.series.force - linear.series.force).cwiseAbs().maxCoeff() / r.mean_mesh_force, 1e-4,
                   "tolerance x steps of the integrator");
  }
}

BOOST_AUTO_TEST_CASE(without_errors_load_sharing_does_not_depend_on_torque) {
  annulus::test::Verification record("Load sharing without errors at full and at a tenth of the torque",
                                     "theorem: a linear system scales");
  auto stage = stages::ring_paper();
  stage.planet_errors.clear();
  stage.set_half_backlash({});
  auto options = quick();
  options.mesh_cycles = 100;
  options.integrator.relative_tolerance = 1e-8;
  const auto full = simulate(stage, options);
  stage.sun_torque *= 0.1;
  const auto tenth = simulate(stage, options);
  BOOST_TEST(full.sun_planet.load_sharing.instantaneous.value > 1.001);  // the planets' phases differ
  // A linear system scales: rounding and tolerance x steps.
  record.near("load sharing coefficient", "", tenth.sun_planet.load_sharing.instantaneous.value,
              full.sun_planet.load_sharing.instantaneous.value, 1e-5, "tolerance x steps of the integrator");
}

BOOST_AUTO_TEST_CASE(contact_is_lost_and_counted_at_light_load) {
  annulus::test::Verification record("Contact lost at a fiftieth of the torque",
                                     "unilateral contact: dampers alone can pull, while teeth touch");
  auto stage = stages::ring_paper();
  stage.sun_torque *= 0.02;
  auto options = quick();
  options.mesh_cycles = 165;
  const auto r = simulate(stage, options);
  record.at_least("times a mesh opens or closes", "", static_cast<double>(r.statistics.contact_events), 1,
                  "contact is lost");
  double loss = 0;
  for (const auto& branch : r.sun_planet.branches) loss = std::max(loss, branch.contact_loss.value);
  BOOST_TEST(loss > 0.0);
  record.at_most("largest share of the time without contact", "", loss, 1, "the load is carried");
  BOOST_TEST(loss < 1.0);
  record.at_least("least mesh force over the mean", "", r.series.force.minCoeff() / r.mean_mesh_force, -0.5,
                  "dampers alone can pull while teeth touch");
  BOOST_TEST(r.series.force.minCoeff() > -0.5 * r.mean_mesh_force);
}

// A table that samples the harmonic stiffness gives the harmonic answer, planet by planet: the phasing is the same.
BOOST_AUTO_TEST_CASE(table_stiffness_reproduces_the_harmonic_stage) {
  annulus::test::Verification record("A table that samples a harmonic stiffness", "the stage with the formula");
  const auto harmonic = stages::ring_paper();
  auto table = harmonic;
  const auto sampled = [](double mean, double ripple) {
    std::vector<double> values;
    for (int i = 0; i < 256; ++i) values.push_back(mean * (1 + ripple * std::cos(2 * std::numbers::pi * i / 256)));
    const annulus::PeriodicCurve curve(values, 256);
    return TableStiffness{curve, curve, annulus::PeriodicCurve({0.0}, 1), 0};
  };
  table.sun_mesh = sampled(1.364e9, 0.2258);
  table.ring_mesh = sampled(1.87e9, 0.1294);
  auto options = quick();
  options.mesh_cycles = 110;
  const auto a = simulate(harmonic, options), b = simulate(table, options);
  // Interpolation at 256 values: 4e-5 of the ripple at extrema, so 1e-5 of the stiffness, times resonance (below 10).
  record.at_most("largest difference of a mesh force over the mean", "",
                 (a.series.force - b.series.force).cwiseAbs().maxCoeff() / a.mean_mesh_force, 1e-4,
                 "interpolation 1e-5 of the stiffness x resonance below 10");
}

// The second paper's kind of stage: planets ride on the carrier, everything but the sun turns only, stiffness jumps.
BOOST_AUTO_TEST_CASE(a_mostly_torsional_stage_with_jumping_stiffness) {
  annulus::test::Verification record("A mostly torsional stage with jumping stiffness",
                                     "balance of energy; degrees of freedom and jumps counted by hand");
  auto stage = stages::ring_paper();
  for (double* support : {&stage.ring.support, &stage.ring.torsional_support, &stage.carrier.support}) *support = rigid;
  stage.planet_bearings.clear();
  stage.sun_mesh = RectangularStiffness{4.5e8, 0.35, 0.6, 0};
  stage.ring_mesh = RectangularStiffness{5.5e8, 0.25, 0.6, 0};
  stage.planet_errors.clear();
  const auto r = simulate(stage, quick());
  record.near("degrees of freedom", "", static_cast<double>(r.series.dofs.size()), 3 + 1 + 5, 0, "counted by hand");
  BOOST_TEST(r.steady);
  record.near("mesh cycles of the window", "", r.window_cycles, 20, 0, "the least asked for");
  // Phases of 0.2 cycles, duty 0.6, sun and ring alike: five instants a cycle, less one at the end of each window.
  record.near("jumps of a stiffness", "", static_cast<double>(r.statistics.stiffness_restarts),
              5 * r.total_cycles - r.total_cycles / 20, 0, "five a cycle, less one at the end of each window");
  BOOST_TEST(r.energy.dissipated > 0);
  // Windows begin and end at jumps: booked once.
  record.at_most("energy balance, relative", "", r.energy.relative, 3e-3, "integrator: some 3000 steps of 1e-6");
  BOOST_TEST(r.sun_planet.load_sharing.instantaneous.value > 1.01);
}

// A ring that repeats after three teeth: planet n reads the table where it stands on the ring.
BOOST_AUTO_TEST_CASE(ring_positions_are_read_where_the_planet_stands) {
  annulus::test::Verification record("A table over three ring positions read by five planets",
                                     "its curve at the tooth where the planet stands");
  auto stage = stages::ring_paper();
  std::vector<double> values;
  for (int i = 0; i < 3 * 64; ++i) values.push_back(1.87e9 * (1 + 0.1 * std::cos(2 * std::numbers::pi * i / 192)));
  const annulus::PeriodicCurve curve(values, 64);
  stage.ring_mesh = TableStiffness{curve, curve, annulus::PeriodicCurve({0.0}, 1), 0};
  stage.ring_tooth_offset = {0, 32, 65, 97, 130};
  const auto system = assemble(stage);
  auto workspace = system.workspace();
  for (const double t : {0.0, 0.0037, 0.81}) {
    system.evaluate_excitation(t, workspace);
    for (int n = 0; n < 5; ++n) {
      const double cycles = stage.mesh_frequency() * t - stage.ring_phase_lag[n] + stage.ring_tooth_offset[n];
      record.near("ring mesh stiffness", "N/m", workspace.stiffness[5 + n], curve(cycles), 1.87e9 * 1e-12,
                  "rounding of the argument");
    }
  }
  for (auto& e : stage.planet_errors) e.eccentricity = {};
  record.near("period without errors that turn", "mesh cycles", stage.error_period(), 3, 0, "three ring teeth");
}

BOOST_AUTO_TEST_CASE(windows_that_cannot_be_compared_say_so) {
  annulus::test::Verification record("Windows shorter than an error period of 55 mesh cycles",
                                     "the mesh cycles asked for, and the longest window allowed");
  auto stage = stages::ring_paper();
  auto options = quick();
  options.mesh_cycles = 30;  // less than one error period
  options.estimate_error = false;
  const auto cut = simulate(stage, options);
  BOOST_TEST(!cut.whole_period);
  BOOST_TEST(!cut.steady);
  BOOST_TEST(!cut.steady_difference.has_value());
  record.near("mesh cycles of the window, 30 asked for", "", cut.window_cycles, 30, 0, "counted by hand");
  options.mesh_cycles.reset();
  options.max_window_cycles = 20;
  const auto limited = simulate(stage, options);
  BOOST_TEST(!limited.whole_period);
  record.near("mesh cycles of the window, 20 allowed", "", limited.window_cycles, 20, 0, "counted by hand");
  record.near("mesh cycles integrated, windows of 20", "", limited.total_cycles, 40, 0, "counted by hand: two windows");
}

BOOST_AUTO_TEST_CASE(unusable_requests_are_refused) {
  auto stage = stages::ring_paper();
  stage.sun_torque = 0;
  BOOST_CHECK_THROW((void)simulate(stage), annulus::InputError);
  stage = stages::ring_paper();
  stage.carrier_speed = 0;
  BOOST_CHECK_THROW((void)simulate(stage), annulus::InputError);
  stage = stages::ring_paper();
  stage.ring.torsional_support = 0;
  BOOST_CHECK_THROW((void)simulate(stage), annulus::InputError);
  auto options = quick();
  options.mesh_cycles = 0;
  BOOST_CHECK_THROW((void)simulate(stages::ring_paper(), options), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
