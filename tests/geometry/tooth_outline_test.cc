#include "geometry/tooth_outline.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>

#include "gears.h"
#include "geometry/gear_places.h"
#include "polygons.h"
#include "tests/verification_record.h"

namespace annulus::geometry::test {

namespace {

using annulus::test::moved;
using annulus::test::Polyline;

constexpr double fine = 1e-8;  // m, of chords: a hundredth of a micrometre

/// All teeth of a gear as one closed outline.
Polyline whole(const Gear& gear, const Eigen::Vector2d& centre, double angle, double tolerance) {
  const auto tooth = tooth_outline(ToothProfile(gear), tolerance);
  Polyline all;
  for (int k = 0; k < gear.teeth(); ++k)
    for (std::size_t i = 0; i + 1 < tooth.size(); ++i)
      all.push_back(moved(tooth[i], centre, angle + k * gear.pitch_angle()));
  return all;
}

/// inv(alpha), written out here.
double inv(double angle) { return std::tan(angle) - angle; }

}  // namespace

BOOST_AUTO_TEST_SUITE(tooth_outlines)

// Tooth thickness at a circle in closed form (ISO 21771): s_y = d_y (pi/2z +- 2 x tan(alpha)/z +- (inv alpha - inv
// alpha_y)), upper signs external.
BOOST_AUTO_TEST_CASE(outlines_have_the_thickness_of_their_teeth) {
  for (const Gear& gear : {paper_sun(), paper_planet(), paper_ring()}) {
    const auto outline = tooth_outline(ToothProfile(gear), fine);
    const auto& p = gear.parameters();
    const double sign = gear.kind() == GearKind::external ? 1 : -1, z = gear.teeth();
    const double reference = p.module * z / 2, base = reference * std::cos(p.pressure_angle);
    for (const double radius : {reference, reference + 0.4 * p.module, gear.tip_radius() - sign * 0.1 * p.module}) {
      const double at = std::acos(base / radius);
      const double half = std::numbers::pi / (2 * z) + sign * (2 * p.profile_shift * std::tan(p.pressure_angle) / z +
                                                               inv(p.pressure_angle) - inv(at));
      // Where the outline crosses the circle on the leading side.
      bool found = false;
      for (std::size_t i = 1; i < outline.size(); ++i) {
        const auto &a = outline[i - 1], &b = outline[i];
        if (b.y() <= 0 || (a.norm() - radius) * (b.norm() - radius) > 0) continue;
        const double t = (radius - a.norm()) / (b.norm() - a.norm());
        const Eigen::Vector2d q = a + t * (b - a);
        found = true;
        BOOST_TEST(std::abs(radius * std::atan2(q.y(), q.x()) - radius * half) < 5 * fine);
      }
      BOOST_TEST(found);
    }
  }
}

// A chamfer at 45 degrees takes as much off half the thickness as off the height.
BOOST_AUTO_TEST_CASE(outlines_have_the_chamfers_of_their_tips) {
  for (const bool internal : {false, true}) {
    auto p = internal ? paper_gear(GearKind::internal, 162, 0.1516) : paper_gear(GearKind::external, 55, 0.7361);
    p.tip_chamfer = 0.4 * units::mm;
    const Gear gear(p);
    double widest = 0, flank = 0;
    for (const auto& q : tooth_outline(ToothProfile(gear), fine)) {
      const double half = q.norm() * std::abs(std::atan2(q.y(), q.x()));
      if (std::abs(q.norm() - gear.tip_radius()) < 1e-9) widest = std::max(widest, half);
      if (std::abs(q.norm() - gear.tip_form_radius()) < 1e-9) flank = half;
    }
    BOOST_TEST(flank == gear.tooth_thickness(gear.tip_form_radius()) / 2, boost::test_tools::tolerance(1e-9));
    BOOST_TEST(std::abs(flank - widest - p.tip_chamfer) < 0.02 * p.tip_chamfer);  // of two radii
  }
}

BOOST_AUTO_TEST_CASE(outlines_are_closed_by_their_neighbours_and_stay_within_tolerance) {
  for (const Gear& gear : {paper_sun(), paper_ring(), Gear(helical(plain_gear(GearKind::external, 17), 0.3))}) {
    const auto outline = tooth_outline(ToothProfile(gear), 1e-6);
    BOOST_TEST((moved(outline.front(), {0, 0}, gear.pitch_angle()) - outline.back()).norm() < 1e-12);
    BOOST_TEST((outline.front() - Eigen::Vector2d(outline.back().x(), -outline.back().y())).norm() < 1e-15);
    double low = 1e9, high = 0;
    for (const auto& p : outline) low = std::min(low, p.norm()), high = std::max(high, p.norm());
    BOOST_TEST(low == std::min(gear.tip_radius(), gear.root_radius()), boost::test_tools::tolerance(1e-9));
    BOOST_TEST(high == std::max(gear.tip_radius(), gear.root_radius()), boost::test_tools::tolerance(1e-9));
    // The finer outline's corners lie on the exact curves: how far the coarse one departs from them.
    double worst = 0;
    for (const auto& p : tooth_outline(ToothProfile(gear), fine)) {
      double d = 1e9;
      for (std::size_t i = 1; i < outline.size(); ++i) {
        const Eigen::Vector2d along = outline[i] - outline[i - 1];
        const double t = std::clamp((p - outline[i - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        d = std::min(d, (p - outline[i - 1] - t * along).norm());
      }
      worst = std::max(worst, d);
    }
    BOOST_TEST(worst < 2e-6);  // the tolerance, and a chord is farthest from its curve beside the middle
    BOOST_TEST(outline.size() < 200U);
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(gear_places)

// Every planet of every set, in both meshes: no corner of an outline lies in the mate, and the driving flanks touch.
BOOST_AUTO_TEST_CASE(gears_of_a_stage_touch_and_do_not_overlap) {
  annulus::test::Verification record("Gears of a stage in their places",
                                     "outlines, exact to a tenth of a micrometre: they touch and do not overlap");
  struct Case {
    Gear sun, planet, ring;
    double distance;
    int planets;
  };
  const auto external = [](int z, double x) { return Gear(plain_gear(GearKind::external, z, x)); };
  const auto internal = [](int z, double x) {
    auto p = plain_gear(GearKind::internal, z, x);
    p.tip_diameter = p.module * (z + 2 * (x - 0.8));
    return Gear(p);
  };
  for (const auto& c : {Case{paper_sun(), paper_planet(), paper_ring(), paper_centre_distance, 5},
                        Case{external(30, 0), external(25, 0), internal(80, 0), 55 * units::mm, 5},
                        Case{external(28, 0.2), external(23, 0.3), internal(74, 0.85), 52 * units::mm, 3}}) {
    const PlanetarySet set(c.sun, c.planet, c.ring, c.distance, c.planets);
    const auto stand = stage_places(set);
    const double tolerance = 1e-7, module = c.planet.parameters().module;
    const auto sun = whole(c.sun, {0, 0}, stand.sun, tolerance), ring = whole(c.ring, {0, 0}, stand.ring, tolerance);
    for (int n = 0; n < c.planets; ++n) {
      const double phi = set.planet_angle(n);
      const Eigen::Vector2d out(std::cos(phi), std::sin(phi));
      const auto planet = whole(c.planet, c.distance * out, stand.planets[static_cast<std::size_t>(n)], tolerance);
      for (const bool inner : {false, true}) {
        const auto& pair = inner ? set.ring_mesh() : set.sun_mesh();
        const double wheel_pitch = pair.wheel().base_radius() / std::cos(pair.working_pressure_angle());
        const auto found = annulus::test::fit(planet, inner ? ring : sun, inner, wheel_pitch * out, 8 * module);
        // Printed profile shifts leave as much rounding as a negative backlash as GearPair accepts.
        const double slack = 2 * tolerance + std::max(0.0, -pair.normal_backlash());
        record.at_most("overlap beyond the negative backlash", "m", found.overlap - (slack - 2 * tolerance),
                       2 * tolerance, "sagitta of the outlines' chords");
        record.at_most("gap beyond the negative backlash", "m", found.gap - (slack - 2 * tolerance), 2 * tolerance,
                       "sagitta of the outlines' chords");
        // A turn by a tenth of a pitch is told: the test can fail.
        const auto turned = whole(c.planet, c.distance * out,
                                  stand.planets[static_cast<std::size_t>(n)] + 0.1 * c.planet.pitch_angle(), tolerance);
        BOOST_TEST(annulus::test::fit(turned, inner ? ring : sun, inner, wheel_pitch * out, 8 * module).overlap >
                   0.1 * module);
      }
    }
  }
}

// The line of action is a common tangent of both base circles through the pitch point; points on it lie on both flanks.
BOOST_AUTO_TEST_CASE(contact_points_lie_on_both_flanks) {
  annulus::test::Verification record("Line of action of the papers' stage",
                                     "tangents of base circles, gearing law, outlines of the gears");
  for (const auto& pair : {GearPair(paper_planet(), paper_sun(), paper_centre_distance),
                           GearPair(paper_planet(), paper_ring(), paper_centre_distance)}) {
    const auto line = action_line(pair);
    const auto stand = pair_places(pair);
    const Eigen::Vector2d centre(pair.centre_distance(), 0);
    const double rb = pair.pinion().base_radius(), rw = pair.wheel().base_radius();
    record.at_most("distance of the line of action from the planet's base circle", "m",
                   std::abs((line.tangent - centre).norm() - rb), 1e-15, "rounding");
    BOOST_TEST(std::abs((line.tangent - centre).dot(line.along)) < 1e-15);
    record.at_most("distance of the line of action from the wheel's base circle", "m",
                   std::abs(std::abs(annulus::test::cross(line.tangent, line.along)) - rw), 1e-12, "rounding");
    // Pitch point: centre distance parted as the numbers of teeth.
    const double ratio = static_cast<double>(pair.wheel().teeth()) / pair.pinion().teeth();
    const double pitch = pair.centre_distance() * ratio / (pair.internal() ? ratio - 1 : ratio + 1);
    const Eigen::Vector2d c = line.tangent + pair.roll_length_pitch() * line.along;
    record.at_most("distance from the pitch point", "m", (c - Eigen::Vector2d(pitch, 0)).norm(), 1e-12, "rounding");
    const auto planet = whole(pair.pinion(), centre, stand.pinion, fine);
    const auto wheel = whole(pair.wheel(), {0, 0}, stand.wheel, fine);
    // One base pitch further the next pair touches.
    for (const int k : {-1, 0, 1}) {
      const double roll = pair.roll_length_pitch() + k * pair.pinion().base_pitch();
      if (roll < pair.roll_length_low() || roll > pair.roll_length_high()) continue;
      const Eigen::Vector2d p = line.tangent + roll * line.along;
      record.at_most("distance of contacts from the planet's outline", "m", annulus::test::distance(planet, p),
                     5 * fine, "sagitta of the outlines' chords");
      record.at_most("distance of contacts from the wheel's outline", "m", annulus::test::distance(wheel, p), 5 * fine,
                     "sagitta of the outlines' chords");
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::geometry::test
