#include "fem/contact/flank_contact.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <optional>

#include "core/errors.h"
#include "ring_paper.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(flank_geometry)

using annulus::fem::FlankContact;
using annulus::geometry::Gear;
using annulus::geometry::GearPair;
using annulus::tests::ring_paper_pair;

// Round-off: positions of 0.3 m carry 4e-17 m, the Newton iteration stops at 1e-13 of a base radius of 0.3 m.
constexpr double exact = 1e-13;

/// Calls f(flanks, contact roll) at positions spread over the whole path of contact of both meshes.
template <typename F>
void along_the_paths(const F& f) {
  for (const bool internal : {true, false}) {
    const FlankContact flanks(ring_paper_pair(internal));
    const double low = flanks.pair().roll_length_low(), high = flanks.pair().roll_length_high();
    for (int i = 0; i <= 40; ++i) f(flanks, low + (high - low) * i / 40);
  }
}

/// Arc length on the planet flank from roll a to roll b.
double arc(const FlankContact& flanks, double a, double b) {
  return (b * b - a * a) / (2 * flanks.pair().pinion().base_radius());
}

BOOST_AUTO_TEST_CASE(the_two_gears_turn_in_the_ratio_of_their_teeth) {
  for (const bool internal : {true, false}) {
    const FlankContact flanks(ring_paper_pair(internal));
    const auto& pair = flanks.pair();
    const double from = pair.roll_length_low(), to = pair.roll_length_high();
    const double planet = flanks.pinion_tooth_angle(to) - flanks.pinion_tooth_angle(from);
    const double wheel = flanks.wheel_tooth_angle(to) - flanks.wheel_tooth_angle(from);
    BOOST_TEST(planet == (to - from) / pair.pinion().base_radius(), boost::test_tools::tolerance(1e-12));
    const double ratio = static_cast<double>(pair.pinion().teeth()) / pair.wheel().teeth() * (internal ? 1 : -1);
    BOOST_TEST(wheel == ratio * planet, boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(neighbouring_teeth_touch_one_base_pitch_apart) {
  for (const bool internal : {true, false}) {
    const FlankContact flanks(ring_paper_pair(internal));
    const auto& pair = flanks.pair();
    const double roll = pair.roll_length_pitch(), next = roll + pair.pinion().base_pitch();
    BOOST_TEST(flanks.pinion_tooth_angle(next) - flanks.pinion_tooth_angle(roll) == pair.pinion().pitch_angle(),
               boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(the_matched_point_lies_on_the_wheel_flank_at_the_stated_gap) {
  along_the_paths([](const FlankContact& flanks, double contact) {
    const auto domain = flanks.domain(contact);
    BOOST_TEST_REQUIRE(!domain.empty());
    for (int i = 0; i <= 20; ++i) {
      const double roll = domain.low + (domain.high - domain.low) * i / 20;
      const auto match = flanks.match(roll, contact);
      // In the frame of the solve: planet at (a, 0), wheel at the origin.
      const Eigen::Rotation2Dd planet(flanks.pinion_tooth_angle(contact));
      const Eigen::Vector2d point = planet * flanks.pinion().flank_point(roll) +
                                    Eigen::Vector2d(flanks.pair().centre_distance(), 0) +
                                    match.gap * (planet * flanks.pinion().flank_normal(roll));
      Eigen::Vector2d own = Eigen::Rotation2Dd(-flanks.wheel_tooth_angle(contact)) * point;
      if (flanks.pair().internal()) own.y() = -own.y();  // the ring's trailing flank
      BOOST_TEST((own - flanks.wheel().flank_point(match.wheel_roll)).norm() < exact);
      BOOST_TEST((own - flanks.wheel().project(annulus::geometry::Boundary::leading_flank, own, 0)).norm() < 1e-12);
    }
  });
}

BOOST_AUTO_TEST_CASE(rigid_conjugate_rotation_leaves_the_smallest_gap_zero) {
  annulus::test::Verification record("Conjugate rotation of rigid involutes", "law of gearing: the gap stays zero");
  along_the_paths([&](const FlankContact& flanks, double contact) {
    record.near("smallest gap", "m", flanks.smallest_gap(contact), 0, exact, "rounding");
    BOOST_TEST(std::abs(flanks.match(contact, contact).wheel_roll - flanks.pair().wheel_roll_length(contact)) < exact);
    // Round-off again: the gap is flat at its minimum, so that the place is only known to sqrt(round-off / curvature).
    BOOST_TEST(std::abs(flanks.nearest_roll(contact, flanks.domain(contact)) - contact) < 1e-6);
  });
}

BOOST_AUTO_TEST_CASE(the_gap_is_nowhere_negative) {
  double largest = 0;
  along_the_paths([&](const FlankContact& flanks, double contact) {
    const auto domain = flanks.domain(contact);
    for (int i = 0; i <= 200; ++i) {
      const double gap = flanks.match(domain.low + (domain.high - domain.low) * i / 200, contact).gap;
      BOOST_TEST_REQUIRE(gap > -exact);
      largest = std::max(largest, gap);
    }
  });
  BOOST_TEST(largest > 1e-5);  // the flanks do part
}

BOOST_AUTO_TEST_CASE(the_gap_opens_with_the_relative_curvature) {
  annulus::test::Verification record("Gap between two involute flanks beside their contact",
                                     "radii of curvature of involutes are their roll lengths");
  along_the_paths([&](const FlankContact& flanks, double contact) {
    // Radii of curvature of involutes are their roll lengths: a convex planet in a concave ring, or against a sun.
    const double wheel_radius = flanks.pair().wheel_roll_length(contact);
    const double curvature = 1 / contact + (flanks.pair().internal() ? -1 : 1) / wheel_radius;
    record.close("relative curvature", "1/m", flanks.pair().relative_curvature(contact), curvature, 1e-14, "rounding");
    const double step = 0.02 * contact;
    double opening = 0;
    for (const double side : {-1.0, 1.0}) {
      const double s = arc(flanks, contact, contact + side * step);
      opening += flanks.match(contact + side * step, contact).gap / (s * s / 2) / 2;
    }
    // The mean of both sides leaves a relative error of order (step / roll)^2 x a factor of the radii's ratio.
    record.close("curvature of the gap", "1/m", opening, curvature, 0.005, "steps of 2 % of the roll length");
  });
}

BOOST_AUTO_TEST_CASE(beyond_the_path_the_flanks_do_not_touch) {
  for (const bool internal : {true, false}) {
    const FlankContact flanks(ring_paper_pair(internal));
    const double low = flanks.pair().roll_length_low(), high = flanks.pair().roll_length_high();
    double before = 0, after = 0;
    for (const double share : {0.02, 0.1, 0.3}) {
      const double distance = share * flanks.pair().pinion().base_pitch();
      const double gap_low = flanks.smallest_gap(low - distance), gap_high = flanks.smallest_gap(high + distance);
      BOOST_TEST(gap_low > before);
      BOOST_TEST(gap_high > after);
      before = gap_low;
      after = gap_high;
    }
  }
}

BOOST_AUTO_TEST_CASE(nothing_is_nearer_than_the_nearest_point_within_and_beyond_the_path) {
  for (const bool internal : {true, false}) {
    const FlankContact flanks(ring_paper_pair(internal));
    const double low = flanks.pair().roll_length_low(), high = flanks.pair().roll_length_high();
    const double beyond = flanks.pair().pinion().base_pitch();
    int clipped = 0;
    for (int i = 0; i <= 60; ++i) {
      const double contact = low - beyond + (high - low + 2 * beyond) * i / 60;
      const auto domain = flanks.domain(contact);
      if (contact <= 0 || domain.empty()) continue;
      const double nearest = flanks.nearest_roll(contact, domain), least = flanks.match(nearest, contact).gap;
      clipped += nearest != contact;
      for (int k = 0; k <= 100; ++k)
        BOOST_TEST(flanks.match(domain.low + (domain.high - domain.low) * k / 100, contact).gap > least - exact);
    }
    BOOST_TEST(clipped > 0);
  }
}

BOOST_AUTO_TEST_CASE(the_domain_ends_at_the_tip_edges) {
  along_the_paths([](const FlankContact& flanks, double contact) {
    const auto domain = flanks.domain(contact);
    const double wheel_tip = flanks.wheel().roll_length_tip(), planet_tip = flanks.pinion().roll_length_tip();
    BOOST_TEST(domain.low <= contact + exact);
    BOOST_TEST(domain.high >= contact - exact);
    BOOST_TEST(domain.low >= flanks.pinion().roll_length_form());
    BOOST_TEST(domain.high <= planet_tip);
    // At either end one of the two gears has its tip or form circle.
    const auto ends_properly = [&](double end) {
      const double wheel = flanks.match(end, contact).wheel_roll;
      const double off = std::min({std::abs(end - planet_tip), std::abs(end - flanks.pinion().roll_length_form()),
                                   std::abs(wheel - wheel_tip), std::abs(wheel - flanks.wheel().roll_length_form())});
      return off < 1e-11;  // the bracketing root finder stops at 2^-50 of the roll length, the map stretches it little
    };
    BOOST_TEST(ends_properly(domain.low));
    BOOST_TEST(ends_properly(domain.high));
  });
  // At the two ends of the path the contact itself is at a tip edge.
  for (const bool internal : {true, false}) {
    const FlankContact flanks(ring_paper_pair(internal));
    const auto first = flanks.domain(flanks.pair().roll_length_low());
    const auto last = flanks.domain(flanks.pair().roll_length_high());
    BOOST_TEST(first.low == flanks.pair().roll_length_low(), boost::test_tools::tolerance(1e-10));
    BOOST_TEST(last.high == flanks.pair().roll_length_high(), boost::test_tools::tolerance(1e-10));
  }
}

BOOST_AUTO_TEST_CASE(flanks_that_do_not_face_each_other_have_no_domain) {
  const FlankContact flanks(ring_paper_pair(false));
  BOOST_TEST(flanks.domain(flanks.pair().roll_length_high() + 3 * flanks.pair().pinion().base_pitch()).empty());
}

BOOST_AUTO_TEST_CASE(small_gears_are_matched_at_every_position_that_a_solve_looks_at) {
  // One base pitch beyond either end of the path the normal of a planet point may miss a small wheel's involute.
  int pairs = 0, contacts = 0;
  for (const bool internal : {false, true})
    for (const int planet_teeth : {14, 17, 25, 60})
      for (const int wheel_teeth : {14, 17, 30, 80})
        for (const double shift : {0.0, 0.3, 0.6}) {
          if (internal && wheel_teeth < planet_teeth + 8) continue;
          const double angle = 20 * M_PI / 180;
          const auto kind = internal ? annulus::geometry::GearKind::internal : annulus::geometry::GearKind::external;
          const annulus::geometry::GearParameters planet{
              annulus::geometry::GearKind::external, planet_teeth, 3e-3, angle, shift, 0.03};
          const annulus::geometry::GearParameters wheel{kind, wheel_teeth, 3e-3, angle, shift, 0.03};
          // Backlash-free centre distance, a micrometre more.
          const double teeth = internal ? wheel_teeth - planet_teeth : wheel_teeth + planet_teeth;
          const double shifts = internal ? 0 : 2 * shift;
          const double working = annulus::geometry::inverse_involute(annulus::geometry::involute(angle) +
                                                                     2 * std::tan(angle) * shifts / teeth);
          const double distance = 3e-3 / 2 * teeth * std::cos(angle) / std::cos(working) + (internal ? -1e-6 : 1e-6);
          std::optional<FlankContact> flanks;
          try {
            flanks.emplace(GearPair(Gear(planet), Gear(wheel), distance));
          } catch (const annulus::GeometryError&) {
            continue;  // gears or pairs that cannot exist
          }
          ++pairs;
          const double pitch = flanks->pair().pinion().base_pitch();
          const double low = flanks->pair().roll_length_low() - pitch;
          const double high = flanks->pair().roll_length_high() + pitch;
          for (int i = 0; i <= 12; ++i) {
            const double contact = low + (high - low) * i / 12;
            if (contact <= 0 || flanks->domain(contact).empty()) continue;
            BOOST_TEST(flanks->smallest_gap(contact) > -exact);
            ++contacts;
          }
        }
  BOOST_TEST(pairs > 30);
  BOOST_TEST(contacts > 10 * pairs / 2);
}

BOOST_AUTO_TEST_CASE(tip_relief_opens_the_gap_by_what_was_removed) {
  annulus::test::Verification record("Gap of flanks with tip relief", "what was removed: linear over its length");
  for (const bool on_planet : {true, false}) {
    auto planet = annulus::tests::ring_paper_planet();
    auto ring = annulus::tests::ring_paper_ring();
    auto& relieved = on_planet ? planet : ring;
    relieved.tip_relief = 20e-6;
    relieved.tip_relief_length = 3e-3;
    const FlankContact flanks(GearPair(Gear(planet), Gear(ring), 0.201));
    const auto& pair = flanks.pair();
    // The planet's tip meets the end of the path, the ring's tip its start.
    const double tip = on_planet ? pair.roll_length_high() : pair.roll_length_low();
    const double inwards = on_planet ? -1 : 1;
    for (const double before_tip : {0.0, 1e-3, 1.5e-3, 2.9e-3, 3e-3, 4e-3}) {
      const double roll = tip + inwards * before_tip;
      const double removed = 20e-6 * std::max(0.0, 1 - before_tip / 3e-3);
      record.near("gap", "m", flanks.match(roll, roll).gap, removed, 1e-12, "rounding of radii of 0.3 m");
    }
    BOOST_TEST(std::abs(flanks.smallest_gap(tip + inwards * 4e-3)) < exact);
    // At the tip a place with less relief is nearer, but none is without gap.
    const double at_tip = flanks.smallest_gap(tip);
    BOOST_TEST(at_tip > 1e-6);
    BOOST_TEST(at_tip < 20e-6);
  }
}

BOOST_AUTO_TEST_CASE(what_is_removed_normal_to_helical_flanks_is_longer_in_their_section) {
  auto problem = annulus::tests::with_helix(annulus::tests::sun_mesh(2), 0.35);
  auto planet = problem.pair.pinion().parameters();
  const FlankContact plain(problem.pair);
  planet.tip_relief = 20e-6;
  planet.tip_relief_length = 3e-3;
  const FlankContact relieved(GearPair(Gear(planet), problem.pair.wheel(), problem.pair.centre_distance()));
  const double tip = plain.pair().roll_length_high();
  BOOST_TEST(std::abs(plain.match(tip, tip).gap) < exact);
  const double factor = std::cos(plain.pair().pinion().base_helix_angle());
  BOOST_TEST(factor < 0.96);
  BOOST_TEST(std::abs(factor * relieved.match(tip, tip).gap - 20e-6) < 1e-12);
}

BOOST_AUTO_TEST_SUITE_END()
