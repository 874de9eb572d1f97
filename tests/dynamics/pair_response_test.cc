#include "dynamics/systems/helical_pair/pair_response.h"

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "core/errors.h"
#include "dynamics/error_propagation/error_propagation.h"
#include "dynamics/systems/helical_pair/pair_figures.h"
#include "tests/dynamics/pairs.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(pair_response)

using namespace annulus;
using namespace annulus::dynamics;
using Complex = std::complex<double>;

/// The harmonic balance alone. 256 samples: the parabola through the highest three then meets the top of a sine to
/// 1e-8.
SimulationOptions unconfirmed() {
  SimulationOptions options;
  options.confirmation = Confirmation::where_needed;
  options.samples_per_cycle = 256;
  return options;
}

HelicalPair linear(HelicalPair pair) {
  pair.mesh = ConstantStiffness{mean_stiffness(pair.mesh)};
  return pair;
}

const auto close = boost::test_tools::tolerance(1e-6);
const char* const top = "parabola through the highest of 256 samples: 1e-8";

BOOST_AUTO_TEST_CASE(torsional_pair_follows_its_frequency_response) {
  test::Verification record("Torsional helical pair under its transmission error, four speeds",
                            "closed form: frequency response of one degree of freedom");
  auto pair = linear(pairs::held(pairs::error_paper()));
  const double c = std::cos(pair.base_helix_angle), k = mean_stiffness(pair.mesh), m = pair.reduced_mass();
  const double damping = 2 * pair.mesh_damping_ratio * std::sqrt(k * m);
  test::RecordedPlot::Curve factor{"", {}, {}, {}, {}};
  // delta'' + c^2/m (k delta + damping delta') = static - e''
  const auto amplitude = [&](double w, double e) {
    const Complex law(k, w * damping);
    return w * w * e / (c * c / m * law - w * w);
  };
  for (const double speed : {300.0, 1500.0, 2900.0, 5000.0}) {
    pair.pinion_speed = speed * units::rpm;
    const double w = 2 * std::numbers::pi * pair.mesh_frequency(), e = pair.mesh_error.amount;
    const Complex delta = amplitude(w, e), force = Complex(k, w * damping) * delta;
    const auto r = evaluate_pair(pair, unconfirmed());
    BOOST_TEST(r.total_cycles == 0);
    BOOST_TEST(r.static_force == pair.pinion_torque / (pair.pinion.radius * c), close);
    record.close("largest mesh force", "N", r.force_max.value, r.static_force + std::abs(force), 1e-6, top);
    record.close("smallest mesh force", "N", r.force_min.value, r.static_force - std::abs(force), 1e-6, top);
    record.close("dynamic factor", "", r.dynamic_factor.value, 1 + std::abs(force) / r.static_force, 1e-6, top);
    BOOST_TEST(r.peak_factor.value == 1 + std::abs(force) / r.static_force, boost::test_tools::tolerance(1e-6));
    BOOST_TEST(r.force_mean == r.static_force, close);
    record.close("dynamic transmission error, peak to peak", "m", r.dynamic.transmission_error.peak_to_peak.value,
                 2 * std::abs(delta + e) / c, 1e-6, top);
    factor.x.push_back(speed);
    factor.computed.push_back(r.dynamic_factor.value);
    BOOST_TEST(r.dynamic.relative.peak_to_peak.value == 2 * std::abs(delta + e) / c, close);  // bearings held
    BOOST_TEST(r.dynamic.transmission_error.mean.value == r.static_force / (k * c), close);
    const double lighter = pair.pinion.inertia / std::pow(pair.pinion.radius, 2);  // 205 kg against 289
    record.close("largest acceleration of rotation", "m/s^2", r.acceleration.rotation.value,
                 c * std::abs(force) / lighter, 1e-6, top);
    BOOST_TEST(r.acceleration.tooth.value == r.acceleration.rotation.value, close);
    BOOST_TEST(r.acceleration.axial.value == 0.0);
  }
  for (double speed = 300; speed <= 5000; speed += 25) {
    pair.pinion_speed = speed * units::rpm;
    const double w = 2 * std::numbers::pi * pair.mesh_frequency();
    const Complex force = Complex(k, w * damping) * amplitude(w, pair.mesh_error.amount);
    factor.reference_x.push_back(speed);
    factor.reference.push_back(1 + std::abs(force) / pair.static_force());
  }
  record.plot({"Dynamic factor", "speed of the pinion, r/min", "", {factor}});
}

BOOST_AUTO_TEST_CASE(six_dofs_follow_their_dynamic_stiffness) {
  test::Verification record("Helical pair on bearings, six degrees of freedom, under its transmission error",
                            "dynamic stiffness matrix, solved directly");
  const auto pair = linear(pairs::error_paper());
  const auto system = assemble(pair);
  const double w = 2 * std::numbers::pi * pair.mesh_frequency(), k = mean_stiffness(pair.mesh);
  const Complex law(k, w * system.meshes()[0].damping);
  const Eigen::VectorXd b = system.mesh_vector(0);
  const Eigen::MatrixXcd dynamic =
      system.stiffness().cast<Complex>() + Complex(0, w) * system.damping().cast<Complex>() -
      Complex(w * w) * system.mass().cast<Complex>() + law * (b * b.transpose()).cast<Complex>();
  const Eigen::VectorXcd q = dynamic.partialPivLu().solve(law * pair.mesh_error.amount * b.cast<Complex>());
  const auto at = [&](const char* name) { return q[system.find(name)]; };
  const auto r = evaluate_pair(pair, unconfirmed());
  const double force = std::abs(law * (b.cast<Complex>().dot(q) - pair.mesh_error.amount));
  const auto larger = [&](const char* one, const char* other) {
    return w * w * std::max(std::abs(at(one)), std::abs(at(other)));
  };
  record.close("largest mesh force", "N", r.force_max.value, r.static_force + force, 1e-6, top);
  record.close("acceleration along the line of action", "m/s^2", r.acceleration.line_of_action.value,
               larger("pinion_y", "wheel_y"), 1e-6, top);
  record.close("acceleration along the axis", "m/s^2", r.acceleration.axial.value, larger("pinion_z", "wheel_z"), 1e-6,
               top);
  record.close("acceleration of rotation", "m/s^2", r.acceleration.rotation.value, larger("pinion_u", "wheel_u"), 1e-6,
               top);
  record.close("dynamic transmission error, peak to peak", "m", r.dynamic.transmission_error.peak_to_peak.value,
               2 * std::abs(at("pinion_u") + at("wheel_u")), 1e-6, top);
  BOOST_TEST(r.dynamic.relative.peak_to_peak.value ==
                 2 * std::abs(at("pinion_u") + at("wheel_u") + at("pinion_y") - at("wheel_y")),
             close);
  BOOST_TEST(r.dynamic.relative.mean.value == r.static_force / k / std::cos(pair.base_helix_angle) +
                                                  2 * r.static_force * std::pow(std::sin(pair.base_helix_angle), 2) /
                                                      1e9 / std::cos(pair.base_helix_angle),
             close);
}

BOOST_AUTO_TEST_CASE(force_is_the_mean_and_linear_in_the_error) {
  test::Verification record("Dynamic force of a linear helical pair",
                            "theorem: linear in the error, not in the torque");
  auto pair = linear(pairs::error_paper());
  const auto swing = [&](double error, double torque) {
    pair.mesh_error.amount = error;
    pair.pinion_torque = torque;
    const auto r = evaluate_pair(pair, unconfirmed());
    BOOST_TEST(r.force_mean == r.static_force, close);
    return r.force_max.value - r.static_force;
  };
  const double one = swing(5e-6, 20e3);
  record.close("amplitude at three times the error", "N", swing(15e-6, 20e3), 3 * one, 1e-6, top);
  record.close("amplitude at twice the torque", "N", swing(5e-6, 40e3), one, 1e-6, top);
}

BOOST_AUTO_TEST_CASE(time_integration_confirms_and_balances_its_energy) {
  test::Verification record("Helical pair integrated in time", "balance of energy; mean force of statics");
  const auto r = evaluate_pair(pairs::error_paper());
  BOOST_TEST(r.confirmed);
  BOOST_TEST(r.steady);
  // The integrator's 1e-6 over a few hundred steps.
  record.at_most("energy balance, relative", "", r.energy.relative, 1e-4, "integrator: some hundred steps of 1e-6");
  record.close("mean force", "N", r.force_mean, r.static_force, 1e-4, "integrator: some hundred steps of 1e-6");
  const auto quick = evaluate_pair(pairs::error_paper(), unconfirmed());
  // Two methods, to the sum of their estimates.
  const auto agree = [](const Figure& a, const Figure& b) { return std::abs(a.value - b.value) <= a.error + b.error; };
  BOOST_TEST(agree(r.force_max, quick.force_max));
  BOOST_TEST(agree(r.force_min, quick.force_min));
  BOOST_TEST(agree(r.acceleration.tooth, quick.acceleration.tooth));
  BOOST_TEST(agree(r.dynamic.transmission_error.peak_to_peak, quick.dynamic.transmission_error.peak_to_peak));
  BOOST_TEST(r.force_max.error < 1e-3 * r.force_max.value);
}

BOOST_AUTO_TEST_CASE(slow_turning_is_quasi_static) {
  test::Verification record("A helical pair at a crawl", "limit: the quasi-static transmission error");
  auto pair = pairs::error_paper();
  pair.pinion.error = {20e-6, 0.4};
  pair.pinion_speed = 1 * units::rpm;
  auto options = unconfirmed();
  options.samples_per_cycle = 64;
  const auto r = evaluate_pair(pair, options);
  // (0.35 Hz / 292 Hz)^2 and the damping are some 1e-5.
  const char* origin = "(0.35 Hz / 292 Hz)^2 and the damping: some 1e-5";
  record.close("transmission error, peak to peak", "m", r.dynamic.transmission_error.peak_to_peak.value,
               r.quasi_static.transmission_error.peak_to_peak.value, 1e-4, origin);
  record.close("largest relative displacement", "m", r.dynamic.relative.largest.value,
               r.quasi_static.relative.largest.value, 1e-4, origin);
}

BOOST_AUTO_TEST_CASE(back_flanks_mirror_the_drive_flanks) {
  test::Verification record("Helical pair driven on the back flanks", "symmetry: mirror image of the drive flanks");
  auto pair = pairs::error_paper();
  pair.half_backlash = 60e-6;
  const auto drive = evaluate_pair(pair, unconfirmed());
  pair.pinion_torque *= -1;
  pair.mesh_error.amount *= -1;
  const auto back = evaluate_pair(pair, unconfirmed());
  record.close("smallest force against the largest one", "N", back.force_min.value, -drive.force_max.value, 1e-6, top);
  BOOST_TEST(back.force_max.value == -drive.force_min.value, close);
  record.close("dynamic factor", "", back.dynamic_factor.value, drive.dynamic_factor.value, 1e-6, top);
  BOOST_TEST(back.dynamic.relative.mean.value == -drive.dynamic.relative.mean.value, close);
  // Without separation the backlash is not felt, and is not part of the transmission error.
  pair = pairs::error_paper();
  const auto none = evaluate_pair(pair, unconfirmed());
  BOOST_TEST(none.force_max.value == drive.force_max.value, close);
  BOOST_TEST(none.dynamic.transmission_error.largest.value == drive.dynamic.transmission_error.largest.value, close);
}

BOOST_AUTO_TEST_CASE(errors_alone_move_an_unloaded_pair) {
  annulus::test::Verification record("A pair without load on its errors", "superposition: the system is linear");
  auto pair = linear(pairs::error_paper());
  const auto loaded = evaluate_pair(pair, unconfirmed());
  pair.pinion_torque = 0;
  const auto r = evaluate_pair(pair, unconfirmed());
  record.close("largest mesh force", "N", r.force_max.value, loaded.force_max.value - loaded.static_force, 1e-6,
               "rounding of the solve");
  record.at_most("mean force over the largest", "", std::abs(r.force_mean) / r.force_max.value, 1e-6,
                 "rounding of the solve");
  BOOST_TEST((std::isnan(r.dynamic_factor.value) && std::isnan(r.peak_factor.value)));
  pair.mesh_error = {};
  BOOST_CHECK_THROW((void)evaluate_pair(pair), InputError);
  pair = pairs::error_paper();
  pair.pinion_speed = 0;
  BOOST_CHECK_THROW((void)evaluate_pair(pair), InputError);
}

BOOST_AUTO_TEST_CASE(loss_of_contact_is_integrated_in_time) {
  test::Verification record("A lightly loaded helical pair near its resonance, integrated in time",
                            "balance of energy; a swing that reaches zero doubles the static force");
  auto pair = pairs::error_paper();
  pair.half_backlash = 100e-6;
  pair.pinion_torque = 2000;
  pair.pinion_speed = 3600 * units::rpm;  // near the resonance
  auto options = unconfirmed();
  options.samples_per_cycle = 64;
  const auto r = evaluate_pair(pair, options);
  BOOST_TEST(r.contact_loss.value > 0.0);
  record.at_most("share of the time without contact", "", r.contact_loss.value, 1, "the load is carried");
  BOOST_TEST(r.contact_loss.value < 1.0);
  BOOST_TEST(r.total_cycles > 0);
  // The balance did not hold here: the window it was tried with is not booked with the last one.
  BOOST_TEST(r.total_cycles > r.window_cycles);
  record.at_most("energy balance, relative", "", r.energy.relative, 1e-4, "integrator: some hundred steps of 1e-6");
  BOOST_TEST(r.energy.relative < 1e-4);
  record.at_least("largest over static force", "", r.force_max.value / r.static_force, 2, "a swing down to zero");
  BOOST_TEST(r.force_max.value > 2 * r.static_force);
}

BOOST_AUTO_TEST_CASE(shares_have_their_closed_forms) {
  test::Verification record(
      "Shares of errors and stiffness in the quasi-static transmission error",
      "closed forms: 2 e / cos b; F / cos b (1/k_min - 1/k_max); mean compliance with 1 / sqrt(1 - "
      "ripple^2)");
  auto pair = pairs::error_paper();
  pair.half_backlash = 100e-6;
  const double c = std::cos(pair.base_helix_angle), k = mean_stiffness(pair.mesh), force = pair.static_force();
  const auto s = transmission_error_shares(pair, unconfirmed());
  record.close("errors alone", "m", s.errors_alone.quasi_static, 2 * pair.mesh_error.amount / c, 1e-6, top);
  record.close("stiffness alone", "m", s.stiffness_alone.quasi_static, force / c * (1 / (0.95 * k) - 1 / (1.05 * k)),
               1e-6, top);
  // The mean of 1/(k (1 + ripple cos)) is 1/(k sqrt(1 - ripple^2)).
  const double compliance = pair.static_compliance() + (1 / std::sqrt(1 - 0.05 * 0.05) - 1) / k;
  record.close("mean deflection by the load", "m", s.load_deflection, force * compliance / c, 1e-6, top);
  BOOST_TEST(s.all.quasi_static > s.errors_alone.quasi_static);
  // Both causes stand a quarter of a cycle apart here: (sin, cos) of one phase.
  record.close("both, a quarter of a cycle apart", "m", s.all.quasi_static,
               std::hypot(s.errors_alone.quasi_static, s.stiffness_alone.quasi_static), 0.01,
               "1/k is a cosine to the ripple alone");
  BOOST_TEST(s.error_share().quasi_static == s.errors_alone.quasi_static / s.all.quasi_static, close);
  // No load, no bending: the errors are all there is.
  pair.pinion_torque = 0;
  pair.half_backlash.reset();
  const auto idle = transmission_error_shares(pair, unconfirmed());
  BOOST_TEST(idle.stiffness_alone.dynamic == 0.0);
  BOOST_TEST(idle.error_share().quasi_static == 1.0, close);
  BOOST_TEST(std::abs(idle.load_deflection) < 1e-12);
}

BOOST_AUTO_TEST_CASE(back_flanks_have_the_mirror_image_of_the_stiffness) {
  test::Verification record(
      "Pair on its back flanks, whose stiffness follows another course than that of the driving ones",
      "the same pair on driving flanks with the mirrored table");
  auto pair = pairs::held(pairs::error_paper());
  pair.mesh_error = {};
  pair.half_backlash = 5e-6;
  const double mean = mean_stiffness(pair.mesh), load = pair.static_force(), mirror = 0.37;
  // Rises slowly and falls fast; where it changes from tooth to tooth, over several mesh cycles too.
  const auto course = [&](double cycles, int positions) {
    const double angle = 2 * std::numbers::pi * cycles, slow = angle / positions;
    const double change = positions > 1 ? 0.04 * std::sin(slow) + 0.03 * std::cos(2 * slow) : 0;
    return mean * (1 + 0.15 * std::sin(angle) - 0.07 * std::sin(2 * angle) + change);
  };
  const auto table = [&](const auto& stiffness, int positions) {
    constexpr int phases = 128;
    std::vector<StiffnessEntry> entries;
    std::vector<double> angles;
    for (int r = 0; r < positions; ++r) {
      angles.push_back(0.1 * r);
      for (int i = 0; i < phases; ++i)
        for (const double share : {0.25, 1.0, 3.0}) {
          const double k = stiffness(r + static_cast<double>(i) / phases) * std::pow(share, 0.1), tangent = k / 0.9;
          entries.push_back({0, share * load / k, k, tangent, 0});
        }
    }
    return StiffnessTable("pinion_wheel", phases, angles, {0.25 * load, load, 3 * load}, entries);
  };
  SimulationOptions options;
  options.samples_per_cycle = 256;
  options.integrator.relative_tolerance = 1e-8;
  for (const int positions : {1, 3}) {
    for (const auto dependence : {LoadDependence::nominal, LoadDependence::table}) {
      // 128 phases hold the mirrored places of each other where the mirror lies on a phase.
      auto mirrored = pair, backwards = pair;
      const double on_phase = std::round(mirror * 128) / 128;
      const auto on = [&](double cycles) { return course(cycles, positions); };
      mirrored.mesh =
          table_stiffness(table([&](double cycles) { return on(on_phase - cycles); }, positions), load, 0, dependence);
      auto stiffness = table_stiffness(table(on, positions), load, 0, dependence);
      stiffness.back_flank_phase = on_phase;
      backwards.mesh = stiffness;
      backwards.pinion_torque *= -1;
      const auto expected = evaluate_pair(mirrored, options), found = evaluate_pair(backwards, options);
      const char* const origin = "integrator: relative tolerance 1e-8";
      record.close("largest mesh force", "N", -found.force_min.value, expected.force_max.value, 1e-5, origin);
      record.close("smallest mesh force", "N", -found.force_max.value, expected.force_min.value, 1e-5, origin);
      record.at_most("energy balance, relative", "", found.energy.relative, 1e-4,
                     "integrator: some hundred steps of 1e-8");
      // The course itself gives another motion.
      backwards.mesh = table_stiffness(table(on, positions), load, 0, dependence);
      record.at_least("difference to the course that is not mirrored", "",
                      std::abs(-evaluate_pair(backwards, options).force_min.value / expected.force_max.value - 1), 1e-3,
                      "fast rises excite more than fast falls");
    }
  }
}

/// A table of a stiffness that jumps between its phases, as where unmodified teeth take up a light load at once.
StiffnessTable sampled_wave(const RectangularStiffness& wave, double load, int phases) {
  std::vector<StiffnessEntry> entries;
  for (int i = 0; i < phases; ++i) {
    const bool high = static_cast<double>(i) / phases < wave.duty;
    const double k = wave.mean * (1 + wave.ripple * ((high ? 1 : 0) - wave.duty));
    entries.push_back({0, load / k, k, k, 0});
  }
  return {"pinion_wheel", phases, {0.0}, {load}, entries};
}

BOOST_AUTO_TEST_CASE(jumps_that_a_table_does_not_resolve_are_within_its_error) {
  test::Verification record("A slow pair whose stiffness jumps between two of 32 tabulated phases",
                            "piecewise exact solution with the jump where it is");
  auto pair = pairs::held(pairs::error_paper());
  pair.mesh_error = {};
  pair.pinion_speed = 100 * units::rpm;  // the natural period is the distance of two phases
  const double mean = mean_stiffness(pair.mesh), load = pair.static_force();
  constexpr int phases = 32;
  for (const double within : {0.05, 0.3, 0.5, 0.9}) {
    const RectangularStiffness wave{mean, 0.3, (20 + within) / phases, 0};
    auto options = unconfirmed();
    options.samples_per_cycle = 32;
    const auto evaluate = [&](const std::vector<StiffnessTable>& tables) {
      auto tabulated = pair;
      tabulated.mesh = table_stiffness(tables.front(), load);
      const auto r = evaluate_pair(tabulated, options);
      return Evaluation{.figures = figures(r), .outcome = r};
    };
    const auto table = sampled_wave(wave, load, phases);
    const auto nominal = evaluate({table});
    const auto found = propagate_errors(
        nominal,
        {.meshes = {{"mesh", table}}, .evaluate = evaluate, .seeks_steady_state = true, .nominal_alike = true});
    auto exact = pair;
    exact.mesh = wave;
    options.samples_per_cycle = 1024;
    const auto r = evaluate_pair(exact, options);
    for (const auto& [name, key, value] : {std::tuple{"largest mesh force", "mesh_force_max_N", r.force_max.value},
                                           std::tuple{"smallest mesh force", "mesh_force_min_N", r.force_min.value}}) {
      const auto stated = found.figure(key);
      record.at_most(std::string(name) + ": difference over the stated error", "",
                     std::abs(stated.value - value) / stated.error, 1 / std::cos(2 * std::numbers::pi / 8),
                     "the peak at a jump is a cusp, and eight samples of a natural period miss up to that");
      record.at_least(std::string(name) + ": difference over the static force", "",
                      std::abs(stated.value - value) / load, 0.02, "a table without the jump lacks its vibration");
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
