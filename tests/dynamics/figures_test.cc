#include "dynamics/figures/mesh_results.h"
#include "dynamics/figures/spectrum.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "dynamics/figures/common_figures.h"
#include "dynamics/figures/motion.h"

BOOST_AUTO_TEST_SUITE(figures)

using namespace annulus::dynamics;

BOOST_AUTO_TEST_CASE(load_sharing_of_given_forces) {
  Eigen::MatrixXd force(2, 4);
  force << 1, 3, 1, 3,  //
      3, 1, 3, 1;
  BOOST_TEST(load_sharing_instantaneous(force) == 1.5);  // 2 x 3/4
  BOOST_TEST(load_sharing_over_time(force)(1, 2) == 1.5);
  force(0, 3) = 7;
  BOOST_TEST(load_sharing_instantaneous(force) == 1.75);
  force.col(1).setZero();  // no load: nothing to share at that instant
  BOOST_TEST(load_sharing_instantaneous(force) == 1.75);
  BOOST_TEST(std::isnan(load_sharing_over_time(force)(0, 1)));
  BOOST_TEST(std::isnan(load_sharing_instantaneous(Eigen::MatrixXd::Zero(2, 3))));
}

// A branch that back flanks carry adds load to the others: K_gamma counts absolute loads.
BOOST_AUTO_TEST_CASE(load_sharing_counts_absolute_loads) {
  Eigen::MatrixXd force(3, 1);
  force << 3, 1, -2;  // the sum is 2: 3 x 3/2 = 4.5 of three branches would be impossible
  BOOST_TEST(load_sharing_instantaneous(force) == 1.5);
  BOOST_TEST(load_sharing_over_time(force)(2, 0) == -1.0);
  force << 2, -1, -1;  // balances itself
  BOOST_TEST(load_sharing_instantaneous(force) == 1.5);
}

/// Loads that change slowly under a vibration of a tenth, (1 + slope t)(1 - cos(2 pi t)/10) of the mesh cycle t, beside
/// a mesh that carries twice as much and vibrates half as much, and one that carries nothing.
SteadyResponse drifting_loads(double slope, int cycles, int samples_per_cycle) {
  SteadyResponse found;
  found.total_cycles = cycles;
  found.best.samples_per_cycle = samples_per_cycle;
  found.best.force = Eigen::MatrixXd::Zero(3, static_cast<Eigen::Index>(cycles) * samples_per_cycle);
  for (Eigen::Index i = 0; i < found.best.force.cols(); ++i) {
    const double t = static_cast<double>(i) / samples_per_cycle, wave = std::cos(2 * std::numbers::pi * t);
    found.best.force(0, i) = (1 + slope * t) * (1 - 0.1 * wave);
    found.best.force(1, i) = 2 - 0.1 * wave;
  }
  return found;
}

// K_V refers to the mean of each mesh cycle, the peak factor to the nominal force. About the middle of a cycle, where
// the force is largest, a linear drift of the load changes no mean.
BOOST_AUTO_TEST_CASE(dynamic_factor_contains_no_load_sharing) {
  constexpr double slope = 0.05, nominal = 1.6;
  constexpr int cycles = 6;
  const auto branches = branch_results(drifting_loads(slope, cycles, 256), 0, 3, nominal);
  // The parabola through samples is exact to (2 pi / 256)^4; the drift moves the peak by slope / (0.1 (2 pi)^2) and
  // raises it by slope^2 / (0.2 (2 pi)^2) at most.
  BOOST_TEST(branches[0].dynamic_factor.value == 1.1, boost::test_tools::tolerance(4e-4));
  BOOST_TEST(branches[1].dynamic_factor.value == 1.05, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(branches[0].peak_factor.value == 1.1 * (1 + slope * (cycles - 0.5)) / nominal,
             boost::test_tools::tolerance(1e-3));
  BOOST_TEST(branches[1].peak_factor.value == 2.1 / nominal, boost::test_tools::tolerance(1e-6));
  BOOST_TEST((std::isnan(branches[2].dynamic_factor.value) && branches[2].peak_factor.value == 0));
  BOOST_TEST(worst_branch(branches, &BranchResult::dynamic_factor) == 0U);
  BOOST_TEST(worst_branch(branches, &BranchResult::peak_factor) == 1U);
  // Seen by meshes that run twice as slowly, a mesh cycle spans two of those.
  const auto slow = branch_results(drifting_loads(0, cycles, 256), 0, 1, nominal, 2);
  BOOST_TEST(slow[0].dynamic_factor.value == 1.1, boost::test_tools::tolerance(1e-6));
}

// A share with a kink between two positions: the first of two branches carries up to 1.4 times the other.
BOOST_AUTO_TEST_CASE(quasi_static_peaks_are_looked_for_between_the_positions) {
  const auto found = drifting_loads(0, 2, 16);
  constexpr double truth = 2 * 1.4 / 2.4;
  for (const double top : {0.53, 0.5625, 0.59}) {
    const auto forces = [&](const Eigen::RowVectorXd& times) {
      Eigen::MatrixXd force = Eigen::MatrixXd::Ones(2, times.size());
      force.row(0).array() += 0.4 - 0.8 * (times.array() - top).abs();
      return force;
    };
    const Eigen::MatrixXd positions = forces(Eigen::RowVectorXd::LinSpaced(16, 0, 15.0 / 16));
    const auto highest = highest_shares(positions, 2);
    BOOST_REQUIRE(!highest.empty());
    const double at = static_cast<double>(highest.front()) / 16;
    BOOST_TEST(std::abs(at - top) <= 1.0 / 16);
    const auto around = forces(Eigen::RowVectorXd::LinSpaced(17, at - 1.0 / 16, at + 1.0 / 16));
    const auto sharing = load_sharing(found, 0, 2, positions, {around}).quasi_static;
    BOOST_TEST(std::abs(sharing.value - truth) <= sharing.error * (1 + 1e-9));
    BOOST_TEST(sharing.error < 5e-3);
  }
  Eigen::MatrixXd equal(2, 3);
  equal << 1, 1, 1,  //
      1, 1, 1;
  BOOST_TEST(highest_shares(equal, 2).size() == 2U);
  BOOST_TEST(highest_shares(Eigen::MatrixXd::Zero(2, 3), 2).empty());
}

BOOST_AUTO_TEST_CASE(curves_are_reduced_to_each_cycle) {
  Eigen::VectorXd values(6);
  values << 1, 2, 6, 5, 3, 4;
  const auto cycles = over_cycles(values, 2);
  BOOST_TEST((cycles.mean == Eigen::Vector2d(3, 4)));
  BOOST_TEST((cycles.smallest == Eigen::Vector2d(1, 3)));
  BOOST_TEST((cycles.largest == Eigen::Vector2d(6, 5)));
  BOOST_TEST(motion_range(values.transpose()).peak_to_peak == 5.0);
}

BOOST_AUTO_TEST_CASE(frequencies_are_listed_once_or_as_often_as_they_occur) {
  const std::vector<Frequency> list = {{{0, 0}}, {{100, 1}}, {{100 * (1 + 1e-9), 2}}, {{150, 3}}};
  const auto once = frequency_figures(list, 2, Multiples::once), all = frequency_figures(list, 2, Multiples::listed);
  BOOST_TEST(once.value("frequency_2_Hz") == 150.0);
  BOOST_TEST(once.figure("frequency_2_Hz").error == 3.0);
  BOOST_TEST(all.figure("frequency_2_Hz").error == 2.0);
  BOOST_TEST(!all.find("frequency_3_Hz"));
}

BOOST_AUTO_TEST_CASE(spectrum_finds_orders_and_amplitudes) {
  const int cycles = 11, samples = 11 * 32;
  Eigen::VectorXd series(samples);
  for (int i = 0; i < samples; ++i) {
    const double x = static_cast<double>(i) / 32;  // mesh cycles
    series[i] = 5 + 2 * std::cos(2 * std::numbers::pi * x + 0.4) +
                0.5 * std::sin(2 * std::numbers::pi * (3.0 / 11) * x) + std::cos(std::numbers::pi * i);
  }
  const auto found = spectrum(series, cycles);
  BOOST_REQUIRE(found.order.size() == samples / 2 + 1);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(found.order.size());
  expected[0] = 5;
  expected[11] = 2;
  expected[3] = 0.5;
  expected[samples / 2] = 1;
  BOOST_TEST((found.amplitude - expected).cwiseAbs().maxCoeff() <= 1e-13);  // rounding of the transform
  BOOST_TEST(found.order[11] == 1.0);
  BOOST_TEST(found.order[samples / 2] == 16.0);
  BOOST_CHECK_THROW((void)spectrum(series, 0), annulus::InputError);
}

// A carrier of 1 at order 2, modulated by 30 % at 3/11 of the mesh frequency, has sidebands of 0.15.
BOOST_AUTO_TEST_CASE(highest_lines_with_their_sidebands) {
  const int cycles = 11, samples = 11 * 32;
  Eigen::VectorXd series(samples);
  for (int i = 0; i < samples; ++i) {
    const double x = 2 * std::numbers::pi * i / 32;
    series[i] = 9 + (1 + 0.3 * std::cos(x * 3 / 11)) * std::cos(2 * x);
  }
  const auto lines = highest_lines(spectrum(series, cycles), 10);
  BOOST_REQUIRE(lines.size() == 3U);  // the mean is no line, and rounding lies below the floor
  BOOST_TEST(lines[0].order == 2.0);
  BOOST_TEST(lines[0].sideband == 0.0);
  BOOST_TEST(std::abs(lines[0].amplitude - 1) <= 1e-13);
  for (const int i : {1, 2}) {
    BOOST_TEST(lines[i].harmonic == 2);
    BOOST_TEST(std::abs(std::abs(lines[i].sideband) - 3.0 / 11) <= 1e-13);
    BOOST_TEST(std::abs(lines[i].amplitude - 0.15) <= 1e-13);
  }
  BOOST_TEST(highest_lines(spectrum(series, cycles), 1).size() == 1U);
}

BOOST_AUTO_TEST_SUITE_END()
