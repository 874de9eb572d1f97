#include "geometry/planetary.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "gears.h"
#include "geometry/profile.h"
#include "tests/verification_record.h"

namespace annulus::geometry::test {

namespace {

constexpr double pi = std::numbers::pi;

struct SetCase {
  Gear sun, planet, ring;
  double centre_distance;
  int planets;
  std::vector<int> steps{};  ///< places of unequally spaced planets, in assembly angles

  [[nodiscard]] PlanetarySet set() const {
    if (steps.empty()) return {sun, planet, ring, centre_distance, planets};
    std::vector<double> angles;
    for (const int step : steps) angles.push_back(2 * pi * step / (sun.teeth() + ring.teeth()));
    return {sun, planet, ring, centre_distance, angles};
  }
};

/// A standard helical set; the ring of the wanted hand relative to the planets'.
SetCase helical_set(double ring_hand) {
  const double beta = 18 * units::deg;
  auto ring = helical(plain_gear(GearKind::internal, 80), ring_hand * beta);
  ring.tip_diameter = ring.module * (80 / std::cos(beta) - 1.6);  // short, as below
  return {Gear(helical(plain_gear(GearKind::external, 30), -beta)),
          Gear(helical(plain_gear(GearKind::external, 25), beta)), Gear(ring), 55 * units::mm / std::cos(beta), 5};
}

/// Sets with odd and even planets, equal and different working angles, in phase and sequentially phased, with equal and
/// unequal places of the planets.
std::vector<SetCase> phasing_cases() {
  const auto external = [](int z, double x) { return Gear(plain_gear(GearKind::external, z, x)); };
  // The rings have a short addendum: with a full one their tips would reach below the planets' form circles.
  const auto internal = [](int z, double x) {
    auto p = plain_gear(GearKind::internal, z, x);
    p.tip_diameter = p.module * (z + 2 * (x - 0.8));
    return Gear(p);
  };
  return {{paper_sun(), paper_planet(), paper_ring(), paper_centre_distance, 5},
          {external(30, 0), external(25, 0), internal(80, 0), 55 * units::mm, 5},
          {external(30, 0), external(24, 0), internal(78, 0), 54 * units::mm, 4},
          {external(28, 0.2), external(23, 0.3), internal(74, 0.85), 52 * units::mm, 3},
          {external(28, 0.2), external(23, 0.3), internal(74, 0.85), 52 * units::mm, 4, {0, 23, 53, 77}},
          {external(30, 0), external(25, 0), internal(80, 0), 55 * units::mm, 3, {0, 37, 71}},
          helical_set(1)};
}

/// Distance between two numbers of cycles, whole cycles dropped.
double cycle_distance(double a, double b) { return std::abs(std::remainder(a - b, 1.0)); }

}  // namespace

BOOST_AUTO_TEST_SUITE(planetary)

BOOST_AUTO_TEST_CASE(impossible_sets_are_refused_with_the_reason) {
  check_refused([] { (void)PlanetarySet(paper_sun(), paper_planet(), paper_ring(), paper_centre_distance, 4); },
                "assembly condition");
  check_refused([] { (void)PlanetarySet(paper_sun(), paper_planet(), paper_ring(), paper_centre_distance, 6); },
                "collide");
  check_refused([] { (void)PlanetarySet(paper_sun(), paper_planet(), paper_ring(), paper_centre_distance, 0); },
                "at least one");
  check_refused([] { (void)PlanetarySet(paper_ring(), paper_planet(), paper_ring(), paper_centre_distance, 5); },
                "external sun");
  BOOST_CHECK_NO_THROW(PlanetarySet(paper_sun(), paper_planet(), paper_ring(), paper_centre_distance, 1));
  const auto build = [](const SetCase& c) { (void)c.set(); };
  BOOST_CHECK_NO_THROW(build(helical_set(1)));
  check_refused([&] { build(helical_set(-1)); }, "hand");
}

BOOST_AUTO_TEST_CASE(planets_stand_where_they_are_put_if_they_fit) {
  const auto at = [](const std::vector<double>& degrees) {
    std::vector<double> angles;
    for (const double angle : degrees) angles.push_back(angle * units::deg);
    return PlanetarySet(paper_sun(), paper_planet(), paper_ring(), paper_centre_distance, angles);
  };
  // 48 + 162 teeth: a planet fits every 12/7 degrees.
  const auto set = at({0, 72, 5 * 12 * 6 / 7.0 + 96, 216});
  BOOST_TEST(set.planets() == 4);
  BOOST_TEST(set.assembly_angle() == 12.0 / 7 * units::deg, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(set.planet_angle(1) == 72 * units::deg, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(set.ring_teeth_ahead(1) == 162.0 / 5, boost::test_tools::tolerance(1e-15));
  // Two decimals are enough; the planet then stands exactly where it fits.
  BOOST_TEST(at({0, 70.29, 216}).planet_angle(1) == 41 * 12.0 / 7 * units::deg, boost::test_tools::tolerance(1e-15));
  check_refused([&] { (void)at({0, 71, 216}); }, "planet 2 at 71 degrees does not fit");
  check_refused([&] { (void)at({0, 71, 216}); }, "70.285714 and 72.000000 degrees");
  check_refused([&] { (void)at({12.0 / 7, 72}); }, "first one stands at the angle 0");
  check_refused([&] { (void)at({}); }, "at least one planet");
  check_refused([&] { (void)at({0, 72, 360}); }, "stay below 360");
  // Any order, each with its number.
  BOOST_TEST(at({0, 216, 72}).planet_angle(1) == 216 * units::deg, boost::test_tools::tolerance(1e-15));
  check_refused([&] { (void)at({0, 216, 72, 216}); }, "collide");
  check_refused([&] { (void)at({0, std::nan("")}); }, "not a number");
  check_refused([&] { (void)at({0, 48, 216}); }, "collide");
  check_refused([&] { (void)at({0, 72, 312}); }, "collide");
}

BOOST_AUTO_TEST_CASE(ring_tooth_offsets_make_positions_advance_evenly) {
  for (const auto& c : phasing_cases()) {
    const PlanetarySet set = c.set();
    BOOST_TEST(set.ring_tooth_offset(0) == 0);
    for (int n = 0; n < c.planets; ++n) {
      const double offset = set.ring_tooth_offset(n);
      BOOST_TEST(offset == std::round(offset));
      const double coordinate = offset - set.ring_phase_lag(n);
      const double further = c.ring.teeth() * set.planet_angle(n) / (2 * pi);
      BOOST_TEST(std::abs(coordinate + set.ring_phase_lag(0) - further) < 1e-10);  // rounding of some hundred cycles
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(phasing)

/// Polar angle of the leading flank at a radius, searched on the flank curve itself.
double flank_angle(const ToothProfile& profile, double radius) {
  double low = 0;
  double high = radius;
  for (int i = 0; i < 80; ++i) {
    const double roll = 0.5 * (low + high);
    (profile.flank_point(roll).norm() < radius ? low : high) = roll;
  }
  const Eigen::Vector2d p = profile.flank_point(0.5 * (low + high));
  return std::atan2(p.y(), p.x());
}

/// One gear in the carrier frame.
struct Placed {
  ToothProfile profile;
  Eigen::Vector2d centre;
  double start;  ///< angle of tooth 0 at time 0
  double speed;  ///< rad per mesh cycle

  /// Distance along the circle from `q` to the nearest flank of the wanted side, which is +1 leading, -1 trailing.
  [[nodiscard]] double flank_distance(int side, double cycles, const Eigen::Vector2d& q) const {
    const Eigen::Vector2d d = q - centre;
    const double flank = start + speed * cycles + side * flank_angle(profile, d.norm());
    return std::remainder(std::atan2(d.y(), d.x()) - flank, profile.gear().pitch_angle()) * d.norm();
  }
  /// Time at which a flank of the side stands at `q`, within one cycle that starts shortly before 0: the flank distance
  /// changes its sign.
  [[nodiscard]] double passing_time(int side, const Eigen::Vector2d& q) const {
    constexpr int steps = 64;
    const double limit = profile.gear().pitch_angle() / 4 * (q - centre).norm();  // excludes the jump of `remainder`
    for (int i = 0; i < steps; ++i) {
      double a = (i - 0.5) / steps;
      double b = a + 1.0 / steps;
      const double fa = flank_distance(side, a, q);
      const double fb = flank_distance(side, b, q);
      if (std::abs(fa) > limit || std::abs(fb) > limit || (fa > 0) == (fb > 0)) continue;
      for (int k = 0; k < 60; ++k) {
        const double t = 0.5 * (a + b);
        ((flank_distance(side, t, q) > 0) == (fa > 0) ? a : b) = t;
      }
      return 0.5 * (a + b);
    }
    BOOST_FAIL("no flank passes the point within a cycle");
    return -1;
  }
};

// All gears as flank curves in the carrier frame. Only the conventions are shared with the implementation: the sun
// turns counter-clockwise, planet 0 sits at the angle 0, and at time 0 a leading flank of the sun stands at its pitch
// point.
BOOST_AUTO_TEST_CASE(lags_agree_with_flank_curves_placed_in_the_carrier_frame) {
  annulus::test::Verification record("Phases of the meshes of all planets",
                                     "flank curves of all gears placed in the carrier frame, passing times searched");
  for (const auto& c : phasing_cases()) {
    const PlanetarySet set = c.set();
    const double a = c.centre_distance;
    const double sun_pitch = a * c.sun.teeth() / (c.sun.teeth() + c.planet.teeth());
    const double ring_pitch = a * c.ring.teeth() / (c.ring.teeth() - c.planet.teeth());
    const ToothProfile sun_profile(c.sun);
    const Placed sun{sun_profile, {0, 0}, -flank_angle(sun_profile, sun_pitch), 2 * pi / c.sun.teeth()};
    Placed ring{ToothProfile(c.ring), {0, 0}, 0, -2 * pi / c.ring.teeth()};
    for (int n = 0; n < c.planets; ++n) {
      const double phi = set.planet_angle(n);
      const Eigen::Vector2d outwards(std::cos(phi), std::sin(phi));
      const Eigen::Vector2d sun_point = sun_pitch * outwards;
      const Eigen::Vector2d ring_point = ring_pitch * outwards;
      // Times are found to the rounding of angles, 1e-15 rad of some 0.1 rad per tooth.
      const double tolerance = 1e-11;
      const double sun_time = sun.passing_time(1, sun_point);
      record.at_most("lag of a sun mesh, difference", "mesh cycles", cycle_distance(sun_time, set.sun_phase_lag(n)),
                     tolerance, "rounding of angles");

      // Turn the planet until one of its flanks meets the sun's flank there. Of its two flanks only the leading one has
      // the opposite normal: that is tangency, the other would be a crossing.
      Placed planet{ToothProfile(c.planet), a * outwards, 0, -2 * pi / c.planet.teeth()};
      planet.start = planet.flank_distance(1, sun_time, sun_point) / (sun_point - planet.centre).norm();
      const double sun_angle = std::atan2(sun_point.y(), sun_point.x());
      const auto normal = [&](const Placed& gear, const Eigen::Vector2d& q, int side) {
        const double radius = (q - gear.centre).norm();
        const Eigen::Vector2d local = gear.profile.flank_normal(gear.profile.roll_length_at(radius));
        const Eigen::Vector2d d = q - gear.centre;
        const double tooth = std::atan2(d.y(), d.x()) - side * flank_angle(gear.profile, radius);
        return Eigen::Vector2d(Eigen::Rotation2Dd(tooth) * Eigen::Vector2d(local.x(), side * local.y()));
      };
      BOOST_TEST((normal(sun, sun_point, 1) + normal(planet, sun_point, 1)).norm() < 1e-10, "at " << sun_angle);
      BOOST_TEST((normal(sun, sun_point, 1) + normal(planet, sun_point, -1)).norm() > 0.1);

      const double ring_time = planet.passing_time(-1, ring_point);
      record.at_most("lag of a ring mesh, difference", "mesh cycles", cycle_distance(ring_time, set.ring_phase_lag(n)),
                     tolerance, "rounding of angles");
      // Planet 0 places the ring; the other planets have to find one of its leading flanks at their time.
      if (n == 0) ring.start = ring.flank_distance(1, ring_time, ring_point) / ring_pitch;
      BOOST_TEST(std::abs(ring.flank_distance(1, ring_time, ring_point)) < 1e-12);
      BOOST_TEST((normal(ring, ring_point, 1) + normal(planet, ring_point, -1)).norm() < 1e-10);
    }
  }
}

// Parker and Lin 2004, planets turning clockwise: gamma_sn = z_s phi_n / 2 pi, gamma_rn = -z_r phi_n / 2 pi.
BOOST_AUTO_TEST_CASE(lags_agree_with_parker_and_lin) {
  annulus::test::Verification record(
      "Phases of the meshes of all planets",
      "Parker and Lin, J. Mech. Des. 126 (2004): z_s phi_n / 2 pi and -z_r phi_n / 2 pi");
  for (const auto& c : phasing_cases()) {
    const PlanetarySet set = c.set();
    for (int n = 0; n < c.planets; ++n) {
      const double turn = set.planet_angle(n) / (2 * pi);
      record.at_most("lag of a sun mesh, difference", "mesh cycles",
                     cycle_distance(set.sun_phase_lag(n), c.sun.teeth() * turn), 1e-12, "rounding");
      record.at_most("lag of a ring mesh, difference", "mesh cycles",
                     cycle_distance(set.ring_phase_lag(n) - set.ring_phase_lag(0), -c.ring.teeth() * turn), 1e-12,
                     "rounding");
      BOOST_TEST(set.sun_phase_lag(n) >= 0);
      BOOST_TEST(set.sun_phase_lag(n) < 1);
      BOOST_TEST(set.ring_phase_lag(n) >= 0);
      BOOST_TEST(set.ring_phase_lag(n) < 1);
    }
  }
}

// Without profile shift the planet's tooth is half a pitch thick: gamma_rs is 0 for odd and 1/2 for even planets.
BOOST_AUTO_TEST_CASE(lag_between_sun_and_ring_mesh_of_standard_gears) {
  annulus::test::Verification record(
      "Lag between sun and ring mesh of standard gears",
      "Parker and Lin 2004: 0 for planets with an odd number of teeth, 1/2 for an even one");
  const auto cases = phasing_cases();
  const PlanetarySet odd(cases[1].sun, cases[1].planet, cases[1].ring, cases[1].centre_distance, 5);
  const PlanetarySet even(cases[2].sun, cases[2].planet, cases[2].ring, cases[2].centre_distance, 4);
  record.at_most("odd: difference", "mesh cycles", cycle_distance(odd.ring_phase_lag(0), 0), 1e-12, "rounding");
  record.at_most("even: difference", "mesh cycles", cycle_distance(even.ring_phase_lag(0), 0.5), 1e-12, "rounding");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::geometry::test
