#include "dynamics/systems/two_k_v/two_k_v_modes.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "dynamics/systems/two_k_v/two_k_v_sensitivity.h"
#include "tests/dynamics/two_k_v_stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(two_k_v_modes)

using namespace annulus::dynamics;

// Half a turn exchanges the two arc gears: the frequencies have half the period.
BOOST_AUTO_TEST_CASE(frequencies_repeat_after_half_a_turn) {
  annulus::test::Verification record("Frequencies over the crank angle",
                                     "symmetry: half a turn exchanges the two arc gears");
  const auto found = modes_over_crank(stages::reducer(), 8, FrozenStiffness::mean);
  for (int i = 0; i < 4; ++i)
    record.at_most(
        "largest difference of a frequency after half a turn, over the highest", "",
        (found.frequency.col(i) - found.frequency.col(i + 4)).cwiseAbs().maxCoeff() / found.frequency.maxCoeff(), 1e-9,
        "rounding");
  // In the first mode both cranks move alike, and sum t_i = 0 takes the angle out of the energy.
  BOOST_TEST(found.frequency.row(0).maxCoeff() - found.frequency.row(0).minCoeff() <= 1e-9 * found.frequency(0, 0));
}

// The published first frequency, with the assumed inertias and stiffnesses: 1 % for their digits.
BOOST_AUTO_TEST_CASE(first_frequency_of_the_paper) {
  annulus::test::Verification record("First natural frequency of the published 2K-V reducer",
                                     "the paper's 131 Hz (docs/arc_tooth_2kv.md)");
  const auto stage = stages::reducer();
  record.near("first natural frequency", "Hz", first_frequency(stage), 131, 1.31,
              "1 %: digits of the assumed inertias and stiffnesses");
  const auto found = annulus::dynamics::modes(stage);
  const auto energy = annulus::dynamics::modal_energy(stage, found);
  for (Eigen::Index m = 0; m < energy.strain.cols(); ++m) {
    BOOST_TEST(std::abs(energy.strain.col(m).sum() - 1) <= 1e-12);
    BOOST_TEST(std::abs(energy.kinetic.col(m).sum() - 1) <= 1e-12);
  }
  BOOST_TEST_MESSAGE(mode_name(by_group(energy), 0));
  BOOST_TEST(mode_name(by_group(energy), 0).starts_with("input on "));
}

/// Everything stiff but what `keep` sets. 1e5 leaves an error of the order of the compliances' ratio.
TwoKVStage stiff_reducer(double factor) {
  auto stage = stages::reducer();
  stage.input_shaft *= factor;
  stage.crank_shaft *= factor;
  stage.crank_bearing *= factor;
  stage.arc_bearing *= factor;
  stage.sun_mesh = ConstantStiffness{1.4e8 * factor};
  stage.arc_mesh = ConstantStiffness{7.5e8 * factor};
  return stage;
}

BOOST_AUTO_TEST_CASE(one_dof_limits) {
  annulus::test::Verification record(
      "Reducer with all but one element stiff",
      "closed form: one degree of freedom, sqrt(k / m), inertias of the whole train reduced");
  const char* origin = "stiff elements a million times stiffer";
  const double two_pi = 2 * std::numbers::pi;
  auto shaft = stiff_reducer(1e6);
  shaft.input_shaft = 536;  // the input on its shaft, all else held with the output
  const double expected_shaft = std::sqrt(536 / 8.405e-6) / two_pi;
  record.near("input on its shaft", "Hz", first_frequency(shaft), expected_shaft, 1e-4 * expected_shaft, origin);

  auto bearing = stiff_reducer(1e6);
  bearing.crank_bearing = 1.5e8;  // the whole train moves as one against the output in the crank bearings
  const double r_c = 22e-3;
  const double inertia = 103 * 103 * (8.405e-6 + 9.2e-8) + 2 * 29 * 29 * (1.03e-5 + 4.6e-7) + 2 * 0.1083 * r_c * r_c +
                         2 * 1.8e-4 + 2 * 0.24 * std::pow(0.9e-3 * 29, 2);
  const double expected_bearing = std::sqrt(2 * 1.5e8 * r_c * r_c / inertia) / two_pi;
  record.near("train in the crank bearings", "Hz", first_frequency(bearing), expected_bearing, 1e-4 * expected_bearing,
              origin);

  auto support = stiff_reducer(1e6);
  support.output_support = 2e4;  // the whole reducer on the spring of the output
  const double expected_support = std::sqrt(2e4 / (inertia + 4.5e-4)) / two_pi;
  record.near("reducer on the spring of the output", "Hz", first_frequency(support), expected_support,
              1e-4 * expected_support, origin);
}

// With rigid arc gear bearings the torques and forces of all elements follow from the ratio alone, so that the
// compliances add up; and the condensed stiffnesses of both ends differ by ratio^2.
BOOST_AUTO_TEST_CASE(torsional_stiffness_is_the_series_of_compliances) {
  annulus::test::Verification record("Torsional stiffness of the reducer",
                                     "statics: compliances in series, forces from the ratio; both ends by ratio^2");
  auto stage = stages::reducer();
  stage.arc_bearing *= 1e7;
  const double r_bs = stage.sun_base_radius(), r_bp = stage.planet_base_radius(), r_c = 22e-3;
  const double sun_force = 1 / (103 * 2 * r_bs), arc_force = (1 - 1.0 / 103) / (2 * 0.9e-3 * 30);
  const double compliance = 1 / (103.0 * 103 * 536) + 2 * sun_force * sun_force / 1.4e8 +
                            2 * std::pow(sun_force * r_bp, 2) / 3141 + 2 * std::pow(1 / (2 * r_c), 2) / 1.5e8 +
                            2 * arc_force * arc_force / 7.5e8;
  const auto found = torsional_stiffness(stage, 6);
  for (int i = 0; i < 6; ++i)
    record.near("stiffness from the output, arc gear bearings rigid", "N m/rad", found.from_output[i], 1 / compliance,
                1e-5 / compliance, "bearings ten million times stiffer");
  const auto base = torsional_stiffness(stages::reducer(), 6);
  for (int i = 0; i < 6; ++i)
    record.near("stiffness from the output against ratio^2 x that from the input", "N m/rad", base.from_output[i],
                103 * 103 * base.from_input[i], 1e-9 * base.from_output[i], "rounding");
}

BOOST_AUTO_TEST_CASE(sensitivities) {
  annulus::test::Verification record("Sensitivities of the first natural frequency",
                                     "central differences; Rayleigh: stiffnesses add up to 1/2, inertias to -1/2");
  auto stage = stages::reducer();
  stage.crank_angle = 0.8;
  stage.output_support = 1e5;
  double stiffnesses = 0, inertias = 0, before = 1e9;
  const auto found = first_frequency_sensitivities(stage);
  BOOST_TEST(found.size() == frequency_inputs(stage).size());
  for (const auto& s : found) {
    const double step = 1e-4;
    const double difference =
        std::log(first_frequency(stage, s.input, 1 + step) / first_frequency(stage, s.input, 1 - step)) / (2 * step);
    // Second order in the step, and rounding of the eigenvalue (1e-16 of the highest square, 4e-9 of the first one).
    record.near("relative sensitivity to an input", "", s.value, difference, 1e-6,
                "second order in the step of 1e-4, rounding of the eigenvalue");
    BOOST_TEST(std::abs(s.value) <= before);
    before = std::abs(s.value);
    if (!s.exact) continue;
    if (s.value > 0)
      stiffnesses += s.value;
    else
      inertias += s.value;
  }
  record.near("sum over the stiffnesses", "", stiffnesses, 0.5, 1e-10, "rounding");
  record.near("sum over the inertias", "", inertias, -0.5, 1e-10, "rounding");
  BOOST_CHECK_THROW((void)scaled(stage, "input_support", 2), annulus::InputError);
  BOOST_CHECK_THROW((void)scaled(stage, "mass", 2), annulus::InputError);
}

BOOST_AUTO_TEST_CASE(band_of_an_input) {
  annulus::test::Verification record("Factors on an input that keep the first frequency within 5 % of 131 Hz",
                                     "definition: the first frequency with these factors");
  const auto stage = stages::reducer();
  const auto band = band_of_input(stage, "input_inertia", 131, 0.05);
  BOOST_REQUIRE((band.low && band.high));
  const char* origin = "end of the search for the factor";
  record.near("first frequency with the least inertia of the input", "Hz",
              first_frequency(stage, "input_inertia", *band.low), 131 * 1.05, 1e-6, origin);
  record.near("first frequency with the largest inertia of the input", "Hz",
              first_frequency(stage, "input_inertia", *band.high), 131 * 0.95, 1e-6, origin);
  // A stiffness that matters little: from some factor on the frequency stays inside the band.
  const auto shaft = band_of_input(stage, "crank_shaft", 131, 0.05);
  BOOST_TEST(shaft.low.has_value());
  BOOST_TEST(!shaft.high.has_value());
  // Not monotone over all factors: the crossings nearest to the base value bound it.
  const auto eccentricity = band_of_input(stage, "eccentricity", 131, 0.05);
  BOOST_REQUIRE((eccentricity.low && eccentricity.high));
  BOOST_TEST(*eccentricity.low < 1.0);
  BOOST_TEST(*eccentricity.high > 1.0);
  BOOST_CHECK_THROW((void)band_of_input(stage, "input_inertia", 0, 0.05), annulus::InputError);
}

// The promise is a millisecond for all modes of a position; a fourteenth of it is measured (release build).
BOOST_AUTO_TEST_SUITE_END()
