#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/csv.h"
#include "core/files.h"
#include "core/json.h"
#include "tests/dynamics/spur_pairs.h"
#include "tests/verification/outside_cases/outside_case.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(spur_pair_backlash)

using namespace annulus;
using test::OutsideCase;

/// Mesh forces over the mean force while the speed changes from value to value, by fixed steps of Runge-Kutta.
std::vector<double> brute_force(dynamics::SpurPair pair, const std::vector<double>& speeds, bool rising) {
  std::vector<double> forces(speeds.size());
  double x = pair.half_backlash + 1, v = 0;
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    const std::size_t i = rising ? k : speeds.size() - 1 - k;
    pair.speed = speeds[i];
    forces[i] = dynamics::largest_forces(pair, x, v, 250, 1).back();
  }
  return forces;
}

// Two stable motions over a band of speeds: which one runs depends on whether the pair runs up or down.
BOOST_AUTO_TEST_CASE(ninety_one_speeds_up_and_down) {
  test::Verification record("Spur pair with backlash over 91 speeds (data/cases/spur_pair_backlash)",
                            "the equation of Kahraman and Singh, J. Sound Vib. 142(1) (1990), by Runge-Kutta with "
                            "fixed steps, from speed to speed");
  const OutsideCase example("spur_pair_backlash");
  const auto out = example.run("spur_pair.toml");
  const auto summary = Json::parse(read_file(out / "summary.json"));
  const auto& sweep = summary.at("sweeps").at(0);
  const double nominal = summary.at("response").at("static_force_N").get<double>();
  const auto rpm = sweep.at("values").get<std::vector<double>>();
  BOOST_REQUIRE(rpm.size() == 91U);
  const double natural = summary.at("response").at("natural_frequencies_Hz").back().get<double>();
  constexpr int teeth = 30;
  std::vector<double> speeds;
  for (const double n : rpm) speeds.push_back(n / 60 * teeth / natural);
  constexpr double stiffness = 3e8, half_backlash = 30e-6;
  const dynamics::SpurPair pair{.zeta = 0.03, .ripple = 0.2, .half_backlash = half_backlash * stiffness / nominal};
  const auto ours = [&](const Json& json) {
    auto list = json.at("mesh_force_max_N").get<std::vector<double>>();
    for (double& force : list) force /= nominal;
    return list;
  };
  const auto up = ours(sweep), down = ours(sweep.at("down"));
  const auto expected_up = brute_force(pair, speeds, true), expected_down = brute_force(pair, speeds, false);
  std::vector<double> folds;
  for (const auto& event : sweep.at("branches").at(0).at("events"))
    if (event.at("kind") == "fold") folds.push_back(event.at("value").get<double>());
  BOOST_REQUIRE(folds.size() >= 2U);
  const double step = rpm[1] - rpm[0];
  int two = 0;
  for (std::size_t i = 0; i < rpm.size(); ++i) {
    const bool at_jump =
        std::any_of(folds.begin(), folds.end(), [&](double fold) { return std::abs(fold - rpm[i]) < step; });
    if (!at_jump) {
      record.close("largest mesh force over the mean while the speed rises", "", up[i], expected_up[i], 5e-3,
                   "samples of the forces");
      record.close("largest mesh force over the mean while the speed falls", "", down[i], expected_down[i], 5e-3,
                   "samples of the forces");
    }
    two += down[i] > 1.3 * up[i] ? 1 : 0;
  }
  BOOST_TEST(two > 15, two);
  // Where brute force jumps, a branch turns back.
  for (const auto* forces : {&expected_up, &expected_down})
    for (std::size_t i = 1; i < rpm.size(); ++i) {
      if (std::abs((*forces)[i] - (*forces)[i - 1]) < 0.5) continue;
      double nearest = 1e300;
      for (const double fold : folds) nearest = std::min(nearest, std::abs(fold - (rpm[i] + rpm[i - 1]) / 2));
      record.at_most("distance of a jump from the nearest fold", "r/min", nearest, step, "step of the sweep");
    }
}

BOOST_AUTO_TEST_SUITE_END()
