#include "dynamics/spatial/rolling_rows.h"

#include <Eigen/Core>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/errors.h"
#include "core/units.h"
#include "tests/dynamics/law_slopes.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(rolling_rows)

using namespace annulus::dynamics;
using annulus::units::deg;
using Element = RollingRow::Element;
using Ring = RollingRow::Ring;

/// A row of rollers so thin that their profile is none, unless it is to count.
RollingRow rollers(int count, double angle = 0, double diameter = 1e-9) {
  RollingRow row;
  row.count = count;
  row.diameter = diameter;
  row.length = 40e-3;
  row.contact_angle = angle;
  row.pitch_diameter = 0.2;
  return row;
}
RollingRow balls(int count, double angle = 0) {
  RollingRow row;
  row.element = Element::ball;
  row.count = count;
  row.diameter = 22e-3;
  row.contact_angle = angle;
  row.pitch_diameter = 0.125;
  return row;
}
double line_stiffness(const RollingRow& row) {
  return 35948 * std::pow(1e3 * row.length, 8.0 / 9) * std::pow(1e3, 10.0 / 9);
}

Eigen::VectorXd vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
}

// The step of the differences leaves its square over that of the deflection, and rounding over the step.
BOOST_AUTO_TEST_CASE(force_and_tangent_belong_to_the_energy) {
  annulus::test::Verification record("Rows of rolling elements", "differences of the energy and of the force");
  std::vector<std::pair<RollingRow, std::vector<double>>> rows;
  auto row = rollers(17, 0, 30e-3);
  row.clearance = 20e-6;
  rows.push_back({row, {3e-5, -2e-5, 4e-4, -1e-4}});
  row.clearance = -10e-6;
  rows.push_back({row, {3e-5, -2e-5}});
  row.contact_angle = -15 * deg;
  rows.push_back({row, {3e-5, -2e-5, 1e-5, 4e-4, -1e-4}});
  row.ring = Ring::outer;
  rows.push_back({row, {3e-5, -2e-5, -4e-5, 4e-4, -1e-4}});
  rows.push_back({balls(9), {3e-5, -2e-5, 4e-5, 4e-4, -1e-4}});
  rows.push_back({balls(16, 40 * deg), {3e-5, -2e-5, 4e-5, 4e-4, -1e-4}});
  rows.push_back({balls(16, 40 * deg), {3e-5, -2e-5}});
  double force = 0, tangent = 0;
  for (const auto& [r, at] : rows) {
    const auto law = law_of(r, at.size() > 2 ? Motions::in_space : Motions::in_plane);
    const auto found = annulus::test::law_slopes(*law, vector(at), 1e-9);
    force = std::max(force, found.force);
    tangent = std::max(tangent, found.tangent);
    BOOST_TEST(law->in_contact().rows() == law->size());
    BOOST_TEST(law->largest_element_load(vector(at)) > 0);
  }
  record.at_most("force, largest relative difference", "", force, 1e-7, "step of the differences");
  record.at_most("tangent, largest relative difference", "", tangent, 1e-7, "step of the differences");
}

// Rings that approach each other without clearance, half of the elements in contact: with the exponent n of the contact
// and I(m) the integral of cos^m over half a turn, the largest load is 2 pi F / (I(n + 1) Z cos(alpha)), and the axial
// force F tan(alpha) I(n) / I(n + 1), in which bearing catalogues print 4.08 and 1.260 for lines, 4.37 and 1.216 for
// points.
BOOST_AUTO_TEST_CASE(elements_share_a_radial_load) {
  annulus::test::Verification record("Rows of rolling elements under a radial load",
                                     "integrals of Sjövall, closed form");
  const double angle = 15 * deg;
  const auto integral = [](double m) {
    return std::sqrt(std::numbers::pi) * std::tgamma((m + 1) / 2) / std::tgamma(m / 2 + 1);
  };
  for (const bool point : {false, true}) {
    const std::string contact = point ? "point contact" : "line contact";
    const double n = point ? 1.5 : 10.0 / 9, tau = 2 * std::numbers::pi;
    auto row = point ? balls(400, angle) : rollers(400, angle);
    row.pitch_diameter = 3;  // the balls have room
    // Far apart: the contact angle of the balls stays.
    row.inner_groove = row.outer_groove = 0.7;
    const auto law = law_of(row, Motions::in_space);
    const Eigen::VectorXd deflection = vector({1e-6, 0, 0, 0, 0});
    const auto state = law->at(deflection);
    record.close("largest load, " + contact, "",
                 law->largest_element_load(deflection) * row.count * std::cos(angle) / state.force[0],
                 tau / integral(n + 1), 1e-4, "400 elements instead of many; balls: change of the contact angle");
    record.close("axial force, " + contact, "", state.force[2] / (state.force[0] * std::tan(angle)),
                 integral(n) / integral(n + 1), 3e-4,
                 "400 elements instead of many; balls: change of the contact angle");
  }
}

BOOST_AUTO_TEST_CASE(cylindrical_rollers) {
  annulus::test::Verification record("Row of cylindrical rollers", "ISO/TS 16281: sums over the rollers by hand");
  auto row = rollers(200);
  const double c = line_stiffness(row), approach = 20e-6;
  const double most = law_of(row, Motions::in_plane)->largest_element_load(vector({approach, 0}));
  record.close("approach of the rings", "m", std::pow(most / c, 0.9), approach, 1e-6, "profile");
  // Preload: all rollers carry, and small motions meet a stiffness that is the same in both directions.
  row.clearance = -20e-6;
  const auto still = law_of(row, Motions::in_space)->at(Eigen::VectorXd::Zero(4));
  BOOST_TEST(still.force.norm() <= 1e-9 * row.count * c * std::pow(10e-6, 10.0 / 9));
  record.close("stiffness under preload", "N/m", still.tangent(0, 0),
               row.count / 2.0 * 10.0 / 9 * c * std::pow(10e-6, 1.0 / 9), 1e-6, "sum over the rollers");
  record.close("tilt stiffness under preload", "N m/rad", still.tangent(2, 2), still.tangent(0, 0) * 40e-3 * 40e-3 / 12,
               2e-3, "slices along the roller");
  // The logarithmic profile leaves both raceways. Here one roller stands under the load, the next ones far beside it.
  auto profiled = rollers(4, 0, 30e-3);
  double sum = 0;
  for (int k = -15; k <= 15; ++k) {
    const double share = 2.0 * k / 31, profile = 0.00035 * 30e-3 * std::log(1 / (1 - share * share));
    sum += c / 31 * std::pow(std::max(0.0, 20e-6 - 2 * profile), 10.0 / 9);
  }
  record.close("one roller with its profile", "N", law_of(profiled, Motions::in_plane)->at(vector({20e-6, 0})).force[0],
               sum, 1e-6, "what holds the body in its play");
}

// A thrust alone: all rollers carry the same. Forces of short rollers pass through one point of the axis.
BOOST_AUTO_TEST_CASE(tapered_rollers) {
  annulus::test::Verification record("Row of tapered rollers", "statics of the row by hand");
  const double angle = 14 * deg, thrust = 30e-6;
  const auto row = rollers(20, angle);
  const auto state = law_of(row, Motions::in_space)->at(vector({0, 0, thrust, 0, 0}));
  record.close("thrust", "N", state.force[2],
               row.count * std::sin(angle) * line_stiffness(row) * std::pow(thrust * std::sin(angle), 10.0 / 9), 1e-6,
               "what holds the body in its play");
  BOOST_TEST(std::abs(law_of(row, Motions::in_space)->at(vector({0, 0, -thrust, 0, 0})).force[2]) <
             1e-5 * state.force[2]);
  for (const auto ring : {Ring::inner, Ring::outer}) {
    auto shorter = row;
    shorter.length = 1e-6;
    shorter.ring = ring;
    const auto pressed = law_of(shorter, Motions::in_space)->at(vector({2e-5, -1e-5, thrust, 1e-4, 2e-4}));
    BOOST_TEST(pressed.force[2] > 0);
    const double place = (ring == Ring::inner ? -1 : 1) * row.pitch_diameter / 2 * std::tan(angle);
    record.close("moment about y over the force along x", "m", pressed.force[4] / pressed.force[0], place, 1e-4,
                 "length of the rollers, what holds the body in its play");
    record.close("moment about x over the force along y", "m", -pressed.force[3] / pressed.force[1], place, 1e-4,
                 "length of the rollers, what holds the body in its play");
  }
}

// Under a thrust F = Z c A^1.5 sin(a) (cos(a0) / cos(a) - 1)^1.5, where A is the distance of the grooves' centres.
BOOST_AUTO_TEST_CASE(angular_contact_balls) {
  annulus::test::Verification record("Row of balls under a thrust", "closed form of the contact angle under load");
  const double angle = 40 * deg, apart = (0.52 + 0.53 - 1) * 22e-3;
  const auto row = balls(16, angle);
  const double ratio = row.diameter * std::cos(angle) / row.pitch_diameter;
  double compliance = 0;
  for (const auto& [path, groove] : {std::pair{ratio / (1 - ratio), 0.52}, {-ratio / (1 + ratio), 0.53}}) {
    const double sum = 4 / row.diameter + 2 / row.diameter * path - 1 / (groove * row.diameter);
    const double difference = (2 / row.diameter * path + 1 / (groove * row.diameter)) / sum;
    compliance += point_contact(1, sum, difference, 207e9 / 0.91).approach;
  }
  for (const double loaded : {40.5 * deg, 42 * deg, 44 * deg}) {
    const double thrust = apart * (std::cos(angle) * std::tan(loaded) - std::sin(angle));
    const double delta = apart * (std::cos(angle) / std::cos(loaded) - 1);
    record.close("thrust", "N", law_of(row, Motions::in_space)->at(vector({0, 0, thrust, 0, 0})).force[2],
                 16 * std::pow(delta / compliance, 1.5) * std::sin(loaded), 1e-6, "what holds the body in its play");
  }
  // Under small loads the balls press along their contact angle, through the middle of the ball.
  for (const auto ring : {Ring::inner, Ring::outer}) {
    auto light = row;
    light.ring = ring;
    light.inner_groove = 0.9;
    const auto pressed = law_of(light, Motions::in_space)->at(vector({1e-8, 0, 1e-8, 0, 0}));
    const double place = (ring == Ring::inner ? -1 : 1) * row.pitch_diameter / 2 * std::tan(angle);
    record.close("moment about y over the force along x", "m", pressed.force[4] / pressed.force[0], place, 1e-4,
                 "change of the contact angle, what holds the body in its play");
  }
  // A clearance takes its half off the way of a radial displacement.
  auto loose = balls(16);
  loose.clearance = 30e-6;
  const auto at = [](const RollingRow& r, double x) {
    return law_of(r, Motions::in_space)->largest_element_load(vector({x, 0, 0, 0, 0}));
  };
  record.close("radial clearance", "N", at(loose, 35e-6), at(balls(16), 20e-6), 1e-9, "rounding");
}

// The pressure of Hertz's ellipse, integrated over it: what both bodies give way must fill their gap inside.
BOOST_AUTO_TEST_CASE(contact_in_a_point) {
  annulus::test::Verification record("Contact in a point", "displacements of two half-spaces by integration");
  const double load = 3000, sum = 120, modulus = 227e9;
  boost::math::quadrature::tanh_sinh<double> integrate;
  for (const double difference : {0.0, 0.4, 0.9}) {
    const auto contact = point_contact(load, sum, difference, modulus);
    const double a = contact.major, b = contact.minor;
    const auto gives_way = [&](double x, double y) {
      constexpr int rays = 720;
      double total = 0;
      for (int k = 0; k < rays; ++k) {
        const double theta = 2 * std::numbers::pi * (k + 0.5) / rays, c = std::cos(theta) / a, s = std::sin(theta) / b;
        // Along a ray: 1 - (x/a)^2 - (y/b)^2 = inside - 2 half r - square r^2.
        const double square = c * c + s * s, half = x / a * c + y / b * s,
                     inside = 1 - x * x / (a * a) - y * y / (b * b);
        const double end = (-half + std::sqrt(half * half + square * inside)) / square;
        total += integrate.integrate(
            [&](double r) { return std::sqrt(std::max(0.0, inside - 2 * half * r - square * r * r)); }, 0.0, end);
      }
      const double pressure = 3 * load / (2 * std::numbers::pi * a * b);
      return 2 / (std::numbers::pi * modulus) * pressure * total * 2 * std::numbers::pi / rays;
    };
    const double along = sum / 4 * (1 - difference), across = sum / 4 * (1 + difference);
    record.close("approach, difference of curvatures 0, 0.4, 0.9", "m", gives_way(0, 0), contact.approach, 1e-6,
                 "quadrature");
    record.close("along the major axis", "m", gives_way(0.6 * a, 0), contact.approach - along * 0.36 * a * a, 1e-5,
                 "quadrature");
    record.close("along the minor axis", "m", gives_way(0, 0.6 * b), contact.approach - across * 0.36 * b * b, 1e-5,
                 "quadrature");
  }
  BOOST_CHECK_THROW((void)point_contact(1, -1, 0, modulus), annulus::InputError);
  BOOST_CHECK_THROW((void)point_contact(1, 1, 1, modulus), annulus::InputError);
}

BOOST_AUTO_TEST_CASE(rows_that_are_refused) {
  const auto refused = [](RollingRow row, const std::string& text) {
    BOOST_CHECK_EXCEPTION((void)law_of(row, Motions::in_space), annulus::InputError,
                          [&](const auto& error) { return std::string(error.what()).find(text) != std::string::npos; });
  };
  refused(rollers(2), "three or more");
  refused(balls(2), "three or more");
  auto row = rollers(20, 10 * deg);
  row.pitch_diameter = 0;
  refused(row, "pitch diameter");
  refused(rollers(20, 95 * deg), "contact angle");
  row = balls(16);
  row.outer_groove = 0.5;
  refused(row, "grooves");
  refused(balls(18), "overlap");
  refused(rollers(20, 0, 32e-3), "overlap");
  row = balls(16);
  row.clearance = 2.3e-3;
  refused(row, "out of their grooves");
  row = rollers(20, 60 * deg);
  row.length = 0.24;
  refused(row, "reach the axis");
  // A groove so wide that the ellipse lies across it.
  row = balls(6);
  row.diameter = 40e-3;
  row.pitch_diameter = 120e-3;
  row.outer_groove = 3;
  BOOST_TEST(law_of(row, Motions::in_space)->at(vector({1e-5, 0, 0, 0, 0})).force[0] > 0);
}

BOOST_AUTO_TEST_SUITE_END()
