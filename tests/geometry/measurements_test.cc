#include "geometry/measurements.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "gears.h"
#include "geometry/profile.h"
#include "tests/verification_record.h"

namespace annulus::geometry::test {

namespace {

std::vector<Gear> measured_gears() {
  std::vector<Gear> list;
  for (const double beta : {0.0, 17.0})
    for (const auto& [kind, teeth, x] : {std::tuple{GearKind::external, 24, 0.3},
                                         {GearKind::external, 37, -0.2},
                                         {GearKind::internal, 96, 0.25},
                                         {GearKind::internal, 81, 0.0}})
      list.emplace_back(helical(plain_gear(kind, teeth, x), beta * units::deg));
  return list;
}

std::string name_of(const Gear& gear) {
  return std::string(gear.kind() == GearKind::external ? "external" : "internal") + ", " +
         std::to_string(gear.teeth()) + " teeth" + (gear.helix_angle() != 0 ? ", helical" : "");
}

/// The smallest value of a function with a single minimum between two places.
template <class Function>
double smallest(const Function& f, double low, double high) {
  return boost::math::tools::brent_find_minima(f, low, high, 52).second;
}

/// Distance of a point in the middle plane of a space from the nearest flank beside it, of a body whose sections turn
/// along the axis; `radius`: of the point.
double distance_to_flank(const Gear& gear, double radius) {
  const ToothProfile profile(gear);
  const double half_pitch = gear.pitch_angle() / 2;
  const double side = profile.flank_point(profile.roll_length_form()).y() > 0 ? 1 : -1;  // of the leading flank
  const Eigen::Vector2d centre(radius * std::cos(half_pitch), side * radius * std::sin(half_pitch));
  const double low = std::min(profile.roll_length_form(), profile.roll_length_tip()),
               high = std::max(profile.roll_length_form(), profile.roll_length_tip());
  const auto at = [&](double z) {
    const Eigen::Rotation2Dd turn(profile.twist() * z);
    const auto from = [&](double roll) { return (turn * profile.flank_point(roll) - centre).norm(); };
    return std::hypot(smallest(from, low, high), z);
  };
  return gear.helix_angle() == 0 ? at(0) : smallest(at, -gear.parameters().module, gear.parameters().module);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(measurements)

// Independent of the formula: a pin at this dimension touches the flanks of the tooth as it is meshed.
BOOST_AUTO_TEST_CASE(pins_touch_the_flanks) {
  annulus::test::Verification record("Dimension over and between pins, and balls of helical gears",
                                     "distance of the ball's centre to the involute flanks, by minimisation");
  for (const auto& gear : measured_gears()) {
    const double sign = gear.kind() == GearKind::external ? 1 : -1, usual = usual_pin_diameter(gear);
    for (const double pin : {usual, 0.95 * usual, 1.05 * usual}) {
      const double across = dimension_over_pins(gear, pin) - sign * pin;
      const double off = gear.teeth() % 2 == 0 ? 1 : std::cos(gear.pitch_angle() / 4);
      record.near("distance to the flank, " + name_of(gear), "mm",
                  distance_to_flank(gear, across / (2 * off)) / units::mm, pin / 2 / units::mm, 1e-6,
                  "minimum of a function of values of 1e-16: its place to 1e-8");
    }
  }
}

BOOST_AUTO_TEST_CASE(usual_pins_touch_where_the_space_is_half_a_pitch_wide) {
  for (const auto& gear : measured_gears()) {
    const double radius = gear.reference_radius() + gear.parameters().profile_shift * gear.parameters().module;
    // The flank's normal through the centre of the pin, back by its radius.
    const double sign = gear.kind() == GearKind::external ? 1 : -1, pin = usual_pin_diameter(gear);
    const double off = gear.teeth() % 2 == 0 ? 1 : std::cos(gear.pitch_angle() / 4);
    const double centre = (dimension_over_pins(gear, pin) - sign * pin) / (2 * off);
    const double roll = std::sqrt(centre * centre - gear.base_radius() * gear.base_radius()) -
                        sign * pin / (2 * std::cos(gear.base_helix_angle()));
    BOOST_TEST(std::hypot(gear.base_radius(), roll) == radius, boost::test_tools::tolerance(1e-12));
  }
  check_refused([] { (void)dimension_over_pins(paper_sun(), 0.1 * units::mm); }, "do not touch the flanks");
  check_refused([] { (void)dimension_over_pins(paper_sun(), 30 * units::mm); }, "do not touch the flanks");
}

BOOST_AUTO_TEST_CASE(profile_shifts_follow_from_what_is_measured) {
  annulus::test::Verification record("Profile shifts from measured dimensions",
                                     "dimensions of gears of known profile shift");
  for (const auto& gear : measured_gears()) {
    auto p = gear.parameters();
    p.profile_shift = 7;  // not read
    const double x = gear.parameters().profile_shift, pin = usual_pin_diameter(gear);
    const auto check = [&](const char* from, double found) {
      record.near(from, "modules", found, x, 1e-11, "rounding");
    };
    check("from the span", shift_from_span(p, 4, gear.base_tangent_length(4)));
    check("from the dimension over pins", shift_from_pins(p, pin, dimension_over_pins(gear, pin)));
    check("from the tip diameter", shift_from_tip_diameter(p, 2 * gear.tip_radius()));
    check("from the root diameter", shift_from_root_diameter(p, 2 * gear.root_radius()));
  }
}

// The pair finds its backlash from the tooth thicknesses on the working pitch circles.
BOOST_AUTO_TEST_CASE(shifts_from_a_centre_distance_leave_the_wanted_backlash) {
  annulus::test::Verification record("Profile shifts from the centre distance",
                                     "normal backlash of the pair with them");
  for (const bool internal : {false, true})
    for (const double beta : {0.0, 12.0})
      for (const double backlash : {0.0, 80e-6}) {
        const double angle = beta * units::deg;
        const auto pinion = helical(plain_gear(GearKind::external, 25, 0.35), angle);
        auto wheel = internal ? helical(plain_gear(GearKind::internal, 79), angle)
                              : helical(plain_gear(GearKind::external, 31), -angle);
        const double distance = (internal ? 54.4 : 56.9) * units::mm / std::cos(angle);
        const double both = shifts_from_centre_distance(pinion, wheel, distance, backlash);
        wheel.profile_shift = internal ? both + pinion.profile_shift : both - pinion.profile_shift;
        if (internal) wheel.tip_diameter = 2 * Gear(wheel).tip_radius() + 0.6 * units::mm;
        const GearPair pair{Gear(pinion), Gear(wheel), distance};
        record.near("normal backlash", "µm", pair.normal_backlash() / units::um, backlash / units::um, 1e-8,
                    "rounding of involutes");
      }
  check_refused(
      [] {
        const auto gear = plain_gear(GearKind::external, 25);
        (void)shifts_from_centre_distance(gear, gear, 40 * units::mm, 0);
      },
      "no working pressure angle");
}

// Independent of the formula: lengths along both flanks while the contact moves on a little.
BOOST_AUTO_TEST_CASE(flanks_slide_by_the_difference_of_their_lengths) {
  annulus::test::Verification record("Specific sliding of an external and an internal pair",
                                     "lengths of both flanks passed by the contact, from their points");
  for (const auto& pair : {GearPair(paper_planet(), paper_sun(), paper_centre_distance),
                           GearPair(paper_planet(), paper_ring(), paper_centre_distance)}) {
    const ToothProfile pinion(pair.pinion()), wheel(pair.wheel());
    const auto found = specific_sliding(pair);
    const auto passed = [](const ToothProfile& p, double from, double to) {
      return (p.flank_point(to) - p.flank_point(from)).norm();
    };
    for (const auto& [roll, own, mate] : {std::tuple{pair.roll_length_low(), found.pinion_at_root, found.wheel_at_tip},
                                          {pair.roll_length_high(), found.pinion_at_tip, found.wheel_at_root}}) {
      constexpr double step = 1e-8;  // m
      const double low = roll - step, high = roll + step;
      const double of_pinion = passed(pinion, low, high),
                   of_wheel = passed(wheel, pair.wheel_roll_length(low), pair.wheel_roll_length(high));
      record.near("of the first gear", "", own, 1 - of_wheel / of_pinion, 1e-6, "chords of 20 nm to 1e-16 m");
      record.near("of the second gear", "", mate, 1 - of_pinion / of_wheel, 1e-6, "chords of 20 nm to 1e-16 m");
    }
  }
}

BOOST_AUTO_TEST_CASE(usual_spans_touch_the_middle_of_the_flank) {
  for (const auto& gear : measured_gears()) {
    const int k = usual_span_teeth(gear);
    const double half = gear.base_tangent_length(k) * std::cos(gear.base_helix_angle()) / 2;
    const double touch = std::hypot(gear.base_radius(), half);
    BOOST_TEST(touch > std::min(gear.tip_radius(), gear.form_radius()));
    BOOST_TEST(touch < std::max(gear.tip_radius(), gear.form_radius()));
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::geometry::test
