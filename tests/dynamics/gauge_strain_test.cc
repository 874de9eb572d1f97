#include "dynamics/systems/planetary/gauge_strain.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

/// Strain gauges on a ring past which planets carry their forces.
BOOST_AUTO_TEST_SUITE(gauge_strain)

using namespace annulus;

constexpr double pi = std::numbers::pi;

/// A gauge whose strain under one planet is cos(`waves` x turns), at eight places per tooth.
PeriodicCurve gauge_on(int teeth, int waves) {
  std::vector<double> strain;
  for (int i = 0; i < 8 * teeth; ++i) strain.push_back(std::cos(waves * 2 * pi * i / (8 * teeth)));
  return {strain, 8 * teeth};
}

/// One mesh cycle of forces of the ring meshes: the mean, and a wave of `share` of it at the mesh frequency, in the
/// phase of each mesh.
dynamics::DynamicResponse motion_of(const dynamics::PlanetaryStage& stage, double share) {
  constexpr int samples = 32;
  dynamics::DynamicResponse response;
  response.steady = response.whole_period = true;
  response.window_cycles = 1;
  response.mesh_frequency = stage.mesh_frequency();
  response.series.time = Eigen::VectorXd::LinSpaced(samples, 0, (samples - 1.0) / samples) / response.mesh_frequency;
  response.series.force = Eigen::MatrixXd::Constant(2 * stage.planets(), samples, stage.mean_mesh_force());
  for (int n = 0; n < stage.planets(); ++n)
    for (int i = 0; i < samples; ++i) {
      const double phase = static_cast<double>(i) / samples + stage.ring_tooth_offset[static_cast<std::size_t>(n)] -
                           stage.ring_phase_lag[static_cast<std::size_t>(n)];
      response.series.force(stage.planets() + n, i) *= 1 + share * std::cos(2 * pi * phase);
    }
  return response;
}

/// Four equal planets, evenly spaced; places in teeth of the ring.
dynamics::PlanetaryStage stage_of() {
  auto stage = dynamics::stages::ring_paper();
  const int planets = 4;
  stage.planet_angles.clear();
  stage.planet_errors.clear();
  stage.ring_tooth_offset.clear();
  stage.ring_phase_lag.clear();
  stage.sun_phase_lag.assign(planets, 0);
  for (int n = 0; n < planets; ++n) {
    stage.planet_angles.push_back(2 * pi * n / planets);
    stage.ring_tooth_offset.push_back(static_cast<double>(stage.ring_teeth) * n / planets);
    stage.ring_phase_lag.push_back(0);
  }
  return stage;
}

double line(const dynamics::StrainLines& lines, double order) {
  for (Eigen::Index i = 0; i < lines.order.size(); ++i)
    if (std::abs(lines.order[i] - order) < 1e-9) return lines.amplitude(0, i);
  return 0;
}

// Equal planets leave lines at multiples of their number alone. A wave of their forces makes two sidebands about the
// mesh frequency, which lie at such multiples, whatever remains of the mesh frequency itself.
BOOST_AUTO_TEST_CASE(sidebands_of_passing_planets) {
  test::Verification record("Strain gauges in motion", "Fourier series of equal planets");
  const auto stage = stage_of();
  const int teeth = stage.ring_teeth;  // 162: two more than a multiple of the planets
  for (const int waves : {1, 2, 4}) {
    const auto lines = dynamics::strain_lines(stage, {gauge_on(teeth, waves)}, motion_of(stage, 0.2)).value();
    const auto near = [&](const std::string& what, int carrier_order, double expected) {
      const double order = static_cast<double>(carrier_order) / teeth;
      record.near(what, "", line(lines, order), expected, 1e-4, "interpolation of the gauge's curve");
    };
    near("line of passing planets", waves, waves % 4 == 0 ? 4 : 0);
    for (const int side : {-1, 1})
      near("sideband of the mesh frequency", teeth + side * waves, (teeth + side * waves) % 4 == 0 ? 0.4 : 0);
    near("mesh frequency", teeth, 0);
  }
}

BOOST_AUTO_TEST_CASE(motions_that_do_not_repeat_have_none) {
  const auto stage = stage_of();
  auto response = motion_of(stage, 0.2);
  response.steady = false;
  BOOST_TEST(!dynamics::strain_lines(stage, {gauge_on(stage.ring_teeth, 1)}, response));
  BOOST_TEST(!dynamics::strain_lines(stage, {}, motion_of(stage, 0.2)));
}

// cos w (t + a) summed over four planets at a = n / 4 turns is 4 cos w t where w is a multiple of 4, and nothing else.
BOOST_AUTO_TEST_CASE(strain_of_passing_planets) {
  test::Verification record("Strain under equal planets over a turn", "closed form");
  const Eigen::VectorXd angles = Eigen::Vector4d(0, 1, 2, 3) * pi / 2;
  const double first = 0.3;
  for (const int waves : {1, 2, 4}) {
    const auto strain = dynamics::strain_over_turn(gauge_on(162, waves), angles, first, 90);
    double apart = 0;
    for (int i = 0; i < 90; ++i)
      apart = std::max(apart, std::abs(strain.at(static_cast<std::size_t>(i)) -
                                       (waves % 4 == 0 ? 4 * std::cos(waves * (2 * pi * i / 90 - first)) : 0)));
    record.near("largest difference", "", apart, 0, 1e-4, "interpolation of the gauge's curve");
  }
}

BOOST_AUTO_TEST_SUITE_END()
