#include "dynamics/systems/planetary/bearing_forces.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "dynamics/systems/planetary/body_results.h"
#include "dynamics/systems/planetary/stage_motion.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(bearing_forces)

using namespace annulus::dynamics;
using annulus::geometry::StageMember;

/// Steady response over one error period, sampled finely enough for differences in time.
TimeSeries steady_series(const PlanetaryStage& stage, int samples_per_cycle) {
  SimulationOptions options;
  options.samples_per_cycle = samples_per_cycle;
  options.estimate_error = false;
  options.steady_tolerance = 1e-4;
  auto response = simulate(stage, options);
  BOOST_TEST(response.steady);
  return std::move(response.series);
}

Eigen::RowVectorXd row(const TimeSeries& series, const Eigen::MatrixXd& values, const std::string& dof) {
  const auto found = std::find(series.dofs.begin(), series.dofs.end(), dof);
  BOOST_REQUIRE(found != series.dofs.end());
  return values.row(found - series.dofs.begin());
}

/// Fourth-order difference of a velocity; its first and last two values are left zero.
Eigen::RowVectorXd rate(const Eigen::RowVectorXd& v, double step) {
  Eigen::RowVectorXd a = Eigen::RowVectorXd::Zero(v.size());
  for (Eigen::Index i = 2; i + 2 < v.size(); ++i)
    a[i] = (v[i - 2] - 8 * v[i - 1] + 8 * v[i + 1] - v[i + 2]) / (12 * step);
  return a;
}

double worst(const Eigen::RowVectorXd& difference) {
  return difference.segment(2, difference.size() - 4).cwiseAbs().maxCoeff();
}

/// m (x'' - 2 Omega y' - Omega^2 x) of a body, and alike for y.
struct Inertia {
  Eigen::RowVectorXd x, y;
};
Inertia inertia(const TimeSeries& s, const std::string& body, double mass, double speed) {
  const double step = s.time[1] - s.time[0];
  const auto x = row(s, s.displacement, body + "_x"), y = row(s, s.displacement, body + "_y");
  const auto vx = row(s, s.velocity, body + "_x"), vy = row(s, s.velocity, body + "_y");
  return {mass * (rate(vx, step) - 2 * speed * vy - speed * speed * x),
          mass * (rate(vy, step) + 2 * speed * vx - speed * speed * y)};
}

// Each planet: the forces of its two meshes, of its pin and of inertia (taken from the sampled velocities) cancel.
// 256 samples a mesh cycle put the fourth-order difference of a 5 kHz motion at (0.18)^4/30 = 3e-5 of it.
BOOST_AUTO_TEST_CASE(planets_are_in_equilibrium) {
  annulus::test::Verification record("Forces on the planet pins",
                                     "Newton: meshes, pin and inertia (from the sampled velocities) cancel");
  const auto stage = stages::ring_paper();
  const auto series = steady_series(stage, 256);
  const auto pins = annulus::dynamics::bearing_forces(stage, series);
  const double omega = stage.carrier_speed, as = stage.sun_working_angle, ar = stage.ring_working_angle;
  const double centrifugal = stage.planet.mass * stage.carrier.radius * omega * omega;
  const double expected = stage.carrier_torque() / (5 * stage.carrier.radius);
  for (int n = 0; n < 5; ++n) {
    const Eigen::RowVectorXd fs = series.force.row(n), fr = series.force.row(5 + n);
    auto mass_times = inertia(series, "planet" + std::to_string(n + 1), stage.planet.mass, omega);
    // The centrifugal force m a Omega^2 is a preload, and it turns with the carrier.
    mass_times.y += stage.planet.mass * omega * omega * row(series, series.displacement, "carrier_u");
    const char* origin = "fourth-order difference of the velocities at 256 samples a mesh cycle";
    record.at_most("radial balance over the mean pin force", "",
                   worst(std::sin(as) * fs - std::sin(ar) * fr - pins.radial.row(n).array().matrix() +
                         Eigen::RowVectorXd::Constant(fs.size(), centrifugal) - mass_times.x) /
                       expected,
                   1e-3, origin);
    record.at_most("tangential balance over the mean pin force", "",
                   worst(std::cos(as) * fs + std::cos(ar) * fr - pins.tangential.row(n) - mass_times.y) / expected,
                   1e-3, origin);
  }
  // All pins together carry the torque of the carrier; the windows repeat to 1e-4 of the mesh force.
  record.near("torque of all pins over that of the carrier", "",
              pins.tangential.colwise().sum().mean() / (5 * expected), 1, 1e-4,
              "windows repeat to 1e-4 of the mesh force");
  BOOST_TEST((pins.resultant().array() >= pins.tangential.array().abs()).all());
}

BOOST_AUTO_TEST_CASE(without_errors_each_pin_carries_its_share) {
  annulus::test::Verification record("Mean pin forces without errors", "statics: torque of the carrier shared by all");
  auto stage = stages::ring_paper();
  stage.planet_errors.clear();
  const auto pins = annulus::dynamics::bearing_forces(stage, steady_series(stage, 64));
  const double expected = stage.carrier_torque() / (5 * stage.carrier.radius);
  for (int n = 0; n < 5; ++n)
    record.near("mean tangential force over its share", "", pins.tangential.row(n).mean() / expected, 1, 1e-4,
                "windows repeat to 1e-4 of the mesh force");
}

// Rigid bearings: the forces come from the planets' equilibrium; the carrier's own equation of rotation, from sampled
// velocities, is another way to their sum.
BOOST_AUTO_TEST_CASE(rigid_bearings) {
  annulus::test::Verification record("Pin forces in rigid bearings",
                                     "the carrier's equation of rotation, from sampled velocities");
  auto stage = stages::ring_paper();
  stage.planet_bearings.clear();
  stage.carrier.support = rigid;
  const auto series = steady_series(stage, 256);
  const auto pins = annulus::dynamics::bearing_forces(stage, series);
  const double a = stage.carrier.radius, output = stage.carrier_torque() / a;
  const Eigen::RowVectorXd acceleration =
      rate(row(series, series.velocity, "carrier_u"), series.time[1] - series.time[0]);
  record.at_most("balance of the carrier over its torque", "",
                 worst(stage.carrier.inertia / (a * a) * acceleration - pins.tangential.colwise().sum() +
                       Eigen::RowVectorXd::Constant(acceleration.size(), output)) /
                     output,
                 1e-3, "fourth-order difference of the velocities at 256 samples a mesh cycle");
}

// What acts on a body is what its inertia and its supports take.
BOOST_AUTO_TEST_CASE(support_reactions_balance_the_meshes) {
  annulus::test::Verification record("Reactions of the supports of sun, ring and carrier",
                                     "Newton: what acts on a body is what its inertia and its supports take");
  const auto stage = stages::ring_paper();
  const auto series = steady_series(stage, 256);
  const auto pins = annulus::dynamics::bearing_forces(stage, series);
  const double omega = stage.carrier_speed;
  for (const auto member : {StageMember::sun, StageMember::ring, StageMember::carrier}) {
    const bool sun = member == StageMember::sun, carrier = member == StageMember::carrier;
    Eigen::RowVectorXd x = Eigen::RowVectorXd::Zero(series.time.size()), y = x;
    for (int n = 0; n < 5; ++n) {
      const double phi = stage.planet_angles[n];
      if (carrier) {
        x += std::cos(phi) * pins.radial.row(n) - std::sin(phi) * pins.tangential.row(n);
        y += std::sin(phi) * pins.radial.row(n) + std::cos(phi) * pins.tangential.row(n);
      } else {
        const double psi = phi + (sun ? -stage.sun_working_angle : stage.ring_working_angle);
        x += std::sin(psi) * series.force.row(sun ? n : 5 + n);
        y -= std::cos(psi) * series.force.row(sun ? n : 5 + n);
      }
    }
    const auto& body = sun ? stage.sun : carrier ? stage.carrier : stage.ring;
    const auto mass_times = inertia(series, sun ? "sun" : carrier ? "carrier" : "ring", body.mass, omega);
    const auto reaction = support_reaction(stage, series, member);
    const double scale = stage.mean_mesh_force();
    const char* origin = "fourth-order difference of the velocities at 256 samples a mesh cycle";
    record.at_most("balance in x over the mean mesh force", "",
                   worst(x - mass_times.x - reaction.x.transpose()) / scale, 1e-3, origin);
    record.at_most("balance in y over the mean mesh force", "",
                   worst(y - mass_times.y - reaction.y.transpose()) / scale, 1e-3, origin);
  }
  // The housing takes the difference of the torques through the ring: T_s - T_c.
  const double expected = stage.sun_torque - stage.carrier_torque();
  record.near("torque on the housing over the difference of the torques", "",
              support_reaction(stage, series, StageMember::ring).torque.mean() / expected, 1, 1e-4,
              "windows repeat to 1e-4 of the mesh force");
  BOOST_TEST(support_reaction(stage, series, StageMember::sun).torque.cwiseAbs().maxCoeff() == 0.0);
}

// All supports rigid and one planet: the sun's bearing takes the mesh force as it is, and a rigid ring the same torque.
BOOST_AUTO_TEST_CASE(rigid_supports) {
  annulus::test::Verification record("One planet, all supports rigid",
                                     "statics: bearings take the mesh forces as they are");
  auto stage = stages::ring_paper();
  stage.planet_angles = {0.4};
  stage.planet_errors.clear();
  stage.sun_phase_lag = stage.ring_phase_lag = stage.ring_tooth_offset = {0};
  stage.sun.support = stage.ring.support = stage.carrier.support = stage.ring.torsional_support = rigid;
  const auto series = steady_series(stage, 64);
  const auto sun = support_reaction(stage, series, StageMember::sun);
  const Eigen::VectorXd force = series.force.row(0).transpose();
  record.at_most("force on the sun's bearing less mesh force, over it", "",
                 (sun.magnitude() - force.cwiseAbs()).cwiseAbs().maxCoeff() / force.maxCoeff(), 1e-12, "rounding");
  // The line of action leans by a_s from the tangent at the planet: the sun is pushed back, against the rotation, and
  // away from the planet.
  const double phi = 0.4;
  const Eigen::VectorXd outwards = std::cos(phi) * sun.x + std::sin(phi) * sun.y;
  record.near("radial part of it over the mesh force: -sin of the working pressure angle", "",
              outwards.mean() / force.mean(), -std::sin(stage.sun_working_angle), 1e-12, "rounding");
  const auto ring = support_reaction(stage, series, StageMember::ring);
  record.near("torque on the ring over the difference of the torques", "",
              ring.torque.mean() / (stage.sun_torque - stage.carrier_torque()), 1, 1e-4,
              "windows repeat to 1e-4 of the mesh force");
  // Carrier: the pin's force, whatever the way there.
  const auto carrier = support_reaction(stage, series, StageMember::carrier);
  const auto pins = annulus::dynamics::bearing_forces(stage, series);
  BOOST_TEST((carrier.magnitude() - pins.resultant().row(0).transpose()).cwiseAbs().maxCoeff() <=
             1e-12 * force.maxCoeff());
}

BOOST_AUTO_TEST_CASE(series_of_another_stage_are_refused) {
  const auto stage = stages::ring_paper();
  BOOST_CHECK_THROW((void)annulus::dynamics::bearing_forces(stage, TimeSeries{}), annulus::InternalError);
}

// A circle about (2, 1) um at three turns of the carrier, which itself turns a third of a turn.
BOOST_AUTO_TEST_CASE(orbit_of_a_circle) {
  annulus::test::Verification record("Orbit of a circle about a point off the axis", "closed form");
  const auto stage = stages::ring_paper();
  const auto system = annulus::dynamics::assemble(stage);
  annulus::dynamics::SteadyResponse found;
  auto& window = found.best;
  const int samples = 360, x = system.find("sun_x"), y = system.find("sun_y");
  window.time.resize(samples);
  window.displacement.setZero(system.dofs(), samples);
  window.velocity.setZero(system.dofs(), samples);
  window.force.setZero(static_cast<Eigen::Index>(system.meshes().size()), samples);
  for (int i = 0; i < samples; ++i) {
    const double angle = 2 * std::numbers::pi * i / samples;
    window.time[i] = angle / 3 / stage.carrier_speed;
    window.displacement(x, i) = 2e-6 + 5e-6 * std::cos(angle);
    window.displacement(y, i) = 1e-6 + 5e-6 * std::sin(angle);
  }
  const auto results = annulus::dynamics::body_results(stage, system, found);
  const char* rounding = "rounding";
  record.near("largest distance from the mean over the radius", "", results.value("sun_orbit_m") / 5e-6, 1, 1e-12,
              rounding);
  record.near("root mean square over the radius", "", results.value("sun_rms_m") / 5e-6, 1, 1e-12, rounding);
  record.near("swing over the diameter", "", results.value("sun_peak_to_peak_m") / 10e-6, 1, 1e-12, rounding);
  // Farthest from the axis along the mean: between two samples, where a parabola meets a cosine.
  const double farthest = 5e-6 + std::sqrt(5.0) * 1e-6, apart = std::abs(results.value("sun_distance_m") - farthest);
  record.near("largest distance from the axis over radius + distance of the centre", "",
              results.value("sun_distance_m") / farthest, 1, 1e-8, "fourth power of a degree");
  BOOST_TEST(apart <= results.figure("sun_distance_m").error);
  const auto path = orbit(stage, series_of(system, window));
  for (int i = 0; i < samples; ++i) {
    const double turned = 2 * std::numbers::pi * i / samples / 3;
    BOOST_TEST(std::abs(path.housing_x[i] - (std::cos(turned) * path.x[i] - std::sin(turned) * path.y[i])) <= 1e-18);
    BOOST_TEST(std::abs(std::hypot(path.housing_x[i], path.housing_y[i]) - std::hypot(path.x[i], path.y[i])) <= 1e-18);
  }
}

// Rectangular waves set off vibrations between the samples.
BOOST_AUTO_TEST_CASE(few_samples_are_within_their_errors) {
  annulus::test::Verification record("Forces of bearings and supports at few samples", "sixteen times as many samples");
  auto stage = stages::ring_paper();
  stage.held = StageMember::ring;
  stage.sun_mesh =
      annulus::dynamics::RectangularStiffness{.mean = mean_stiffness(stage.sun_mesh), .ripple = 0.2, .duty = 0.6};
  SimulationOptions options;
  options.integrator.relative_tolerance = 1e-8;
  const auto results = [&](int samples) {
    options.samples_per_cycle = samples;
    return simulate(stage, options).bodies;
  };
  const auto few = results(16), many = results(256);
  BOOST_TEST(many.entries().size() == 23U);  // with two of each of five planets
  for (const auto& [key, b, parts, spread] : many.entries()) {
    const auto a = few.figure(key);
    record.near(key + ", few over many samples", "", a.value / b.value, 1, (a.error + b.error) / std::abs(b.value),
                "sum of the stated errors");
    BOOST_TEST(a.error <= 0.5 * std::abs(a.value));  // else it says nothing
  }
}

BOOST_AUTO_TEST_SUITE_END()
