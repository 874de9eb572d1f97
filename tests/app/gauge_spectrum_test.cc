#include "app/systems/planetary/gauge_spectrum.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

/// Strain gauges on a ring past which planets carry their forces.
BOOST_AUTO_TEST_SUITE(gauge_spectrum)

using namespace annulus;

constexpr double pi = std::numbers::pi;

/// A gauge whose strain under one planet is cos(`waves` x turns), µm/m, at eight places per tooth; the table begins
/// with the contact in the pitch point, where the planet is not over the middle of a tooth.
app::MeshResult ring_with_gauge(int teeth, int waves) {
  app::MeshResult mesh;
  mesh.gauges.columns = {"ring_angle_deg", "gauge_1_um_per_m"};
  for (int i = 0; i < 8 * teeth; ++i) {
    const double angle = 2 * pi * i / (8 * teeth);
    mesh.gauges.rows.push_back({angle * 180 / pi + 90.0 / teeth, std::cos(waves * angle)});
  }
  return mesh;
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

double line(const Csv& csv, double carrier_order) {
  for (const auto& row : csv.rows)
    if (std::abs(row[1] - carrier_order) < 1e-6) return row[3];
  return 0;
}

// Equal planets leave lines at multiples of their number alone. A wave of their forces makes two sidebands about the
// mesh frequency, which lie at such multiples, whatever remains of the mesh frequency itself.
BOOST_AUTO_TEST_CASE(sidebands_of_passing_planets) {
  test::Verification record("Strain gauges in motion", "Fourier series of equal planets");
  const auto stage = stage_of();
  const int teeth = stage.ring_teeth;  // 162: two more than a multiple of the planets
  for (const int waves : {1, 2, 4}) {
    const auto csv = app::gauge_spectrum(stage, ring_with_gauge(teeth, waves), motion_of(stage, 0.2));
    const auto near = [&](const std::string& what, double order, double expected) {
      record.near(what, "µm/m", line(csv, order), expected, 1e-4, "interpolation of the gauge's curve");
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
  BOOST_TEST(app::gauge_spectrum(stage, ring_with_gauge(stage.ring_teeth, 1), response).rows.empty());
  BOOST_TEST(app::gauge_spectrum(stage, app::MeshResult(), motion_of(stage, 0.2)).rows.empty());
}

BOOST_AUTO_TEST_SUITE_END()
