#include "geometry/gear_pair.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gears.h"
#include "geometry/profile.h"
#include "tests/verification_record.h"

namespace annulus::geometry::test {

BOOST_AUTO_TEST_SUITE(gear_pair)

BOOST_AUTO_TEST_CASE(ring_paper_pairs) {
  annulus::test::Verification record("Meshes of the ring paper",
                                     "gear data of Hu et al. 2021, calculated by hand (docs/ring_types.md)");
  const GearPair sun(paper_planet(), paper_sun(), paper_centre_distance);
  const GearPair ring(paper_planet(), paper_ring(), paper_centre_distance);
  // Half of the last printed digit.
  record.near("working pressure angle, sun and planet", "deg", sun.working_pressure_angle() / units::deg, 25.905148,
              5e-7, "half of the last digit");
  record.near("working pressure angle, planet and ring", "deg", ring.working_pressure_angle() / units::deg, 20.860323,
              5e-7, "half of the last digit");
  // The printed shifts leave about 0.3 um (the last of four digits of x changes it by 0.3 um).
  const char* digits = "the last of four digits of a profile shift changes it by 0.3 um";
  record.near("normal backlash, sun and planet", "um", sun.normal_backlash() / units::um, 0.3, 0.1, digits);
  record.near("normal backlash, planet and ring", "um", ring.normal_backlash() / units::um, 0.3, 0.1, digits);
}

// Independent of the tooth thicknesses: normal backlash from the profile shifts and the involute function alone,
// j = 2 r_b (...) in the form of ISO 21771: m cos(a) [ (z2 +- z1)(inv a_w - inv a) -+ 2 (x2 +- x1) tan a ].
BOOST_AUTO_TEST_CASE(backlash_agrees_with_the_profile_shift_sum) {
  annulus::test::Verification record("Normal backlash of external and internal pairs",
                                     "ISO 21771: profile shift sum and the involute function alone");
  const auto inv = [](double a) { return std::tan(a) - a; };
  const double alpha = 20 * units::deg;
  const double m = 2 * units::mm;
  const GearPair external(Gear(plain_gear(GearKind::external, 24, 0.2)), Gear(plain_gear(GearKind::external, 31, 0.1)),
                          55.8 * units::mm);
  double expected =
      m * std::cos(alpha) * (55 * (inv(external.working_pressure_angle()) - inv(alpha)) - 2 * 0.3 * std::tan(alpha));
  record.close("external, 24 and 31 teeth", "m", external.normal_backlash(), expected, 1e-10, "cancellation of 1e-3 m");
  const GearPair internal(Gear(plain_gear(GearKind::external, 24, 0.1)), Gear(plain_gear(GearKind::internal, 75, 0.4)),
                          51.3 * units::mm);
  expected =
      m * std::cos(alpha) * (2 * 0.3 * std::tan(alpha) - 51 * (inv(internal.working_pressure_angle()) - inv(alpha)));
  record.close("internal, 24 and 75 teeth", "m", internal.normal_backlash(), expected, 1e-10, "cancellation of 1e-3 m");
  BOOST_TEST(internal.normal_backlash() > 0);
}

// A worked profile shift calculation after ISO 21771:2007 (equations 62 and 63): m_n = 3.5 mm, 20 deg, 31 and 30 teeth,
// helix angle 21 deg (from the printed reference centre distance), working centre distance 116.5 mm.
// Of the basic rack, whose root lies a quarter of a module below the tip of the mate, unless the centres move apart.
BOOST_AUTO_TEST_CASE(tips_clear_roots_by_a_quarter_of_a_module) {
  const double m = 2 * units::mm, apart = 0.1 * units::mm;
  const auto close = boost::test_tools::tolerance(1e-9);
  for (const double more : {0.0, apart}) {
    const GearPair external(Gear(plain_gear(GearKind::external, 24)), Gear(plain_gear(GearKind::external, 31)),
                            55 * units::mm + more);
    BOOST_TEST(external.tip_clearance().pinion_tip == 0.25 * m + more, close);
    BOOST_TEST(external.tip_clearance().wheel_tip == 0.25 * m + more, close);
  }
}

BOOST_AUTO_TEST_CASE(published_helical_pair) {
  annulus::test::Verification record("Published helical pair",
                                     "worked profile shift calculation after ISO 21771:2007, "
                                     "equations 62 and 63");
  const double beta = 21 * units::deg;
  const auto gear = [&](int teeth, double x, double hand) {
    auto p = helical(plain_gear(GearKind::external, teeth, x), hand * beta);
    p.module = 3.5 * units::mm;
    return Gear(p);
  };
  const double x = 0.2910;
  const auto pair = [&](double shift_sum) {
    return GearPair(gear(31, x, 1), gear(30, shift_sum - x, -1), 116.5 * units::mm);
  };
  const GearPair tight = pair(0.651877131252);
  const char* digits = "printed digits";
  record.near("transverse pressure angle", "deg", tight.pinion().transverse_pressure_angle() / units::deg,
              21.2990642859, 1e-10, digits);
  record.near("working pressure angle", "deg", tight.working_pressure_angle() / units::deg, 23.8707609654, 1e-10,
              digits);
  record.near("reference centre distance", "mm",
              (tight.pinion().reference_radius() + tight.wheel().reference_radius()) / units::mm, 114.3447280708, 1e-10,
              digits);
  record.near("normal backlash with the printed profile shift sum", "mm", tight.normal_backlash() / units::mm, 0, 1e-11,
              digits);
  // 0.03 mm normal backlash; a unit in the last digit of the printed shift changes it by 2 m sin(alpha) 1e-9 = 2.4e-9
  // mm.
  record.near("normal backlash with the shift sum printed for 0.03 mm", "mm",
              pair(0.639346541).normal_backlash() / units::mm, 0.03, 2e-9, "last printed digit of the profile shift");
}

BOOST_AUTO_TEST_CASE(helical_pairs) {
  annulus::test::Verification record("Overlap of helical pairs", "ISO 21771: face width over axial pitch");
  const double beta = 20 * units::deg;
  const auto sun = helical(plain_gear(GearKind::external, 31, 0.1), -beta);
  auto planet = helical(plain_gear(GearKind::external, 24, 0.2), beta);
  const auto ring = helical(plain_gear(GearKind::internal, 75, 0.4), beta);
  const GearPair external(Gear(planet), Gear(sun), 59.3 * units::mm);
  const GearPair internal(Gear(planet), Gear(ring), 54.5 * units::mm);
  for (const auto& pair : {external, internal}) {
    // Face width over axial pitch, the height in which a tooth trace advances by a pitch.
    const double axial_pitch = pair.pinion().pitch_angle() / ToothProfile(pair.pinion()).twist();
    record.close("overlap ratio", "", pair.overlap_ratio(), 20 * units::mm / axial_pitch, 1e-13, "rounding");
    BOOST_TEST(pair.total_contact_ratio() == pair.contact_ratio() + pair.overlap_ratio());
    // The line of contact in the plane of action: both sections advance by the same length per metre of z.
    const double side = pair.internal() ? 1 : -1;
    BOOST_TEST(ToothProfile(pair.pinion()).twist() * pair.pinion().base_radius() ==
                   side * ToothProfile(pair.wheel()).twist() * pair.wheel().base_radius(),
               boost::test_tools::tolerance(1e-13));
  }
  // The common face counts.
  planet.face_width = 5 * units::mm;
  BOOST_TEST(GearPair(Gear(planet), Gear(sun), 59.3 * units::mm).overlap_ratio() == external.overlap_ratio() / 4,
             boost::test_tools::tolerance(1e-13));
  BOOST_TEST(GearPair(paper_planet(), paper_sun(), paper_centre_distance).overlap_ratio() == 0);

  const auto refuse = [&](const GearParameters& wheel, double centre_distance) {
    check_refused([&] { (void)GearPair(Gear(planet), Gear(wheel), centre_distance); }, "hand");
  };
  refuse(helical(sun, beta), 59.3 * units::mm);
  refuse(helical(sun, -19 * units::deg), 59.3 * units::mm);
  refuse(helical(sun, 0), 59.3 * units::mm);
  refuse(helical(ring, -beta), 54.5 * units::mm);
}

BOOST_AUTO_TEST_CASE(faces_overlap) {
  auto planet = plain_gear(GearKind::external, 24, 0.2), sun = plain_gear(GearKind::external, 30, 0.1);
  const auto face_of = [&] { return GearPair(Gear(planet), Gear(sun), 54.9 * units::mm).common_face(); };
  const auto same = [](double a, double b) { return std::abs(a - b) < 1e-15; };
  planet.face_width = 20 * units::mm;
  sun.face_width = 26 * units::mm;
  auto face = face_of();
  BOOST_TEST((same(face.width, 0.02) && face.pinion.total() == 0));
  BOOST_TEST((same(face.wheel.below, 3e-3) && same(face.wheel.above, 3e-3)));
  sun.axial_offset = 5 * units::mm;  // from -8 to 18 mm against -10 to 10 mm
  face = face_of();
  BOOST_TEST((same(face.width, 0.018) && same(face.pinion.below, 2e-3) && face.pinion.above == 0));
  BOOST_TEST((face.wheel.below == 0 && same(face.wheel.above, 8e-3)));
  sun.axial_offset = -24 * units::mm;
  check_refused([&] { (void)face_of(); }, "24.0000 mm apart along the axis");
}

BOOST_AUTO_TEST_CASE(path_of_contact) {
  annulus::test::Verification record("Path of contact and contact ratio",
                                     "textbook: 2 (sqrt(ra^2 - rb^2) - r sin a) / (pi m cos a); rigid geometry");
  // Textbook: two equal standard gears, contact ratio 2 (sqrt(ra^2 - rb^2) - r sin a) / (pi m cos a).
  const Gear g(plain_gear(GearKind::external, 40));
  const GearPair pair(g, g, 80 * units::mm);
  const double rb = 40 * std::cos(20 * units::deg);
  const double expected =
      2 * (std::sqrt(42.0 * 42.0 - rb * rb) - 40 * std::sin(20 * units::deg)) / (2 * std::numbers::pi * rb / 40);
  record.close("contact ratio of two equal standard gears, 40 teeth", "", pair.contact_ratio(), expected, 1e-12,
               "rounding");
  // A point of contact is one point: both roll lengths give the same place on the line of centres and its distance.
  for (const GearPair& mesh : {GearPair(paper_planet(), paper_sun(), paper_centre_distance),
                               GearPair(paper_planet(), paper_ring(), paper_centre_distance)}) {
    const double rho = mesh.roll_length_low() + 1 * units::mm;
    const double aw = mesh.working_pressure_angle();
    const double sign = mesh.internal() ? -1 : 1;
    // Seen from the planet's centre: tangent point at the angle aw from the line of centres, contact along the line.
    const double rp = mesh.pinion().base_radius();
    const Eigen::Vector2d contact(rp * std::cos(aw) + rho * std::sin(aw), rp * std::sin(aw) - rho * std::cos(aw));
    const Eigen::Vector2d wheel_centre(sign * mesh.centre_distance(), 0);
    const double wheel_radius = std::hypot(mesh.wheel().base_radius(), mesh.wheel_roll_length(rho));
    record.close("point of contact seen from both gears", "m", (contact - wheel_centre).norm(), wheel_radius, 1e-12,
                 "rounding");
  }
}

BOOST_AUTO_TEST_CASE(back_flanks_follow_by_the_tooth_thickness) {
  annulus::test::Verification record("Phase at which back flanks touch at the pitch point",
                                     "a pitch holds one tooth of each gear and the backlash; turned outlines");
  for (const GearPair& mesh : {GearPair(paper_planet(), paper_sun(), paper_centre_distance),
                               GearPair(paper_planet(), paper_ring(), paper_centre_distance)}) {
    const GearRole other = mesh.driver() == GearRole::pinion ? GearRole::wheel : GearRole::pinion;
    const GearPair reversed(mesh.pinion(), mesh.wheel(), mesh.centre_distance(), other);
    const double backlash = mesh.normal_backlash() / mesh.pinion().base_pitch();
    record.near("phases with either gear driving, and the backlash", "mesh cycles",
                mesh.back_flank_phase() + reversed.back_flank_phase() + backlash, 1, 1e-12, "rounding");
    // The leading flank of the planet's outline turns by this phase until the trailing one is where it was.
    const ToothProfile planet(mesh.pinion());
    const double radius = mesh.pinion().base_radius() / std::cos(mesh.working_pressure_angle());
    const Eigen::Vector2d flank = planet.flank_point(planet.roll_length_at(radius));
    const double thickness = 2 * std::abs(std::atan2(flank.y(), flank.x())) / mesh.pinion().pitch_angle();
    const GearPair driving(mesh.pinion(), mesh.wheel(), mesh.centre_distance(), GearRole::pinion);
    record.near("phase of a driving planet", "mesh cycles", driving.back_flank_phase(), thickness, 1e-12, "rounding");
  }
}

BOOST_AUTO_TEST_CASE(impossible_pairs_are_refused_with_the_reason) {
  const auto refuse = [](const GearParameters& p, const GearParameters& w, double a, const std::string& part) {
    const Gear planet(p);
    const Gear wheel(w);
    check_refused([&] { (void)GearPair(planet, wheel, a); }, part);
  };
  auto planet = plain_gear(GearKind::external, 24, 0.2);
  auto sun = plain_gear(GearKind::external, 31, 0.1);
  BOOST_CHECK_NO_THROW(GearPair(Gear(planet), Gear(sun), 55.8 * units::mm));
  refuse(planet, sun, 51 * units::mm, "no working pressure angle");
  refuse(planet, sun, 55.3 * units::mm, "backlash");
  refuse(planet, sun, 58.9 * units::mm, "contact ratio");
  auto other = sun;
  other.module = 2.1 * units::mm;
  refuse(planet, other, 55.8 * units::mm, "modules");
  // Shallow roots raise the form circles above the start of contact.
  auto shallow = planet;
  shallow.root_diameter = 45.0 * units::mm;
  refuse(shallow, sun, 55.8 * units::mm, "touches the planet");
  shallow = sun;
  shallow.root_diameter = 58.8 * units::mm;
  refuse(planet, shallow, 55.8 * units::mm, "touches the sun");

  auto ring = plain_gear(GearKind::internal, 75, 0.4);
  BOOST_CHECK_NO_THROW(GearPair(Gear(planet), Gear(ring), 51.2 * units::mm));
  refuse(ring, planet, 51.2 * units::mm, "external");
  refuse(plain_gear(GearKind::external, 80), ring, 51.2 * units::mm, "more teeth");
  // The tip of a ring with few teeth reaches beyond the tangent point on the base circle of a small planet.
  refuse(plain_gear(GearKind::external, 18), plain_gear(GearKind::internal, 50), 32 * units::mm,
         "involute interference");
}

// The message names the tip diameter at which contact starts at the form circle: 0.1 um to either side decides (the
// printed value is rounded to that).
BOOST_AUTO_TEST_CASE(tip_interference_names_the_cure) {
  const Gear planet(plain_gear(GearKind::external, 25));
  auto ring = plain_gear(GearKind::internal, 80);
  std::string message;
  try {
    (void)GearPair(planet, Gear(ring), 55 * units::mm);
  } catch (const GeometryError& e) {
    message = e.what();
  }
  const std::string before = "that tip diameter to ";
  BOOST_REQUIRE(message.find(before) != std::string::npos);
  const double named = std::stod(message.substr(message.find(before) + before.size())) * units::mm;
  ring.tip_diameter = named + 0.1 * units::um;
  BOOST_CHECK_NO_THROW(GearPair(planet, Gear(ring), 55 * units::mm));
  ring.tip_diameter = named - 0.1 * units::um;
  check_refused([&] { (void)GearPair(planet, Gear(ring), 55 * units::mm); }, "tip interference");
}

BOOST_AUTO_TEST_CASE(tips_of_internal_gears_with_few_teeth_difference_foul) {
  // A well-known rule for 20 deg full-depth teeth: about ten teeth difference are needed.
  const auto pair = [](int difference) {
    auto planet = plain_gear(GearKind::external, 60, 0.0);
    auto ring = plain_gear(GearKind::internal, 60 + difference, 0.0);
    ring.tip_diameter = ring.module * (ring.teeth - 1.6);  // short: no contact below the planet's form circle
    return GearPair(Gear(planet), Gear(ring), difference * units::mm);
  };
  BOOST_CHECK_NO_THROW(pair(12));
  check_refused([&] { (void)pair(4); }, "tips interfere");
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(mating)

/// Half the angle of material at a radius from the outline itself: involute, fillet (searched), nothing beyond the tip.
double outline_half_angle(const ToothProfile& profile, double radius) {
  const Gear& g = profile.gear();
  const double sign = g.kind() == GearKind::external ? 1 : -1;
  if (sign * (radius - g.tip_radius()) > 0) return 0;
  if (sign * (radius - g.root_radius()) <= 0) return g.pitch_angle() / 2;
  if (sign * (radius - g.form_radius()) >= 0) {
    const Eigen::Vector2d p = profile.flank_point(profile.roll_length_at(radius));
    return std::atan2(p.y(), p.x());
  }
  double low = 0;
  double high = 1;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * (low + high);
    (sign * (profile.fillet_point(t).norm() - radius) > 0 ? low : high) = t;
  }
  const Eigen::Vector2d p = profile.fillet_point(0.5 * (low + high));
  return std::atan2(p.y(), p.x());
}

/// How deep a point lies inside a gear turned by `angle` about `centre`, measured along the circle; negative outside.
double depth_inside(const ToothProfile& profile, const Eigen::Vector2d& centre, double angle,
                    const Eigen::Vector2d& q) {
  const Eigen::Vector2d d = q - centre;
  const double pitch = profile.gear().pitch_angle();
  const double from_tooth = std::remainder(std::atan2(d.y(), d.x()) - angle, pitch);
  const double half = outline_half_angle(profile, d.norm());
  return half == 0 ? -1 : (half - std::abs(from_tooth)) * d.norm();
}

// Turn a pair through one pitch with the drive flanks in contact: no point of the planet's outline enters the wheel,
// and the drive flanks keep touching (the gap stays zero: involutes are conjugate).
BOOST_AUTO_TEST_CASE(gears_turn_in_contact_without_overlap) {
  annulus::test::Verification record("Pairs of outlines turned in contact through a pitch",
                                     "conjugate flanks touch and never enter each other");
  struct Case {
    Gear planet, wheel;
    double a;
  };
  const std::vector<Case> cases{
      {paper_planet(), paper_sun(), paper_centre_distance},
      {paper_planet(), paper_ring(), paper_centre_distance},
      {Gear(plain_gear(GearKind::external, 24, 0.2)), Gear(plain_gear(GearKind::external, 31, 0.1)), 55.8 * units::mm},
      {Gear(plain_gear(GearKind::external, 24, 0.2)), Gear(plain_gear(GearKind::internal, 75, 0.4)), 51.2 * units::mm},
      {Gear(helical(plain_gear(GearKind::external, 24, 0.2), 20 * units::deg)),
       Gear(helical(plain_gear(GearKind::external, 31, 0.1), -20 * units::deg)), 59.3 * units::mm},
      {Gear(helical(plain_gear(GearKind::external, 24, 0.2), 20 * units::deg)),
       Gear(helical(plain_gear(GearKind::internal, 75, 0.4), 20 * units::deg)), 54.5 * units::mm}};
  for (const auto& [planet, wheel, a] : cases) {
    const GearPair pair(planet, wheel, a);
    const ToothProfile p(planet);
    const ToothProfile w(wheel);
    const double cosine = std::cos(pair.working_pressure_angle());
    // Wheel at the origin, planet at (a, 0). The planet's leading flank stands at the pitch point; in the sun mesh it
    // touches the sun's leading flank, in the ring mesh the trailing flank of the ring tooth ahead.
    const double planet_start =
        (pair.internal() ? 0 : std::numbers::pi) - planet.tooth_half_angle(planet.base_radius() / cosine);
    const double wheel_half = wheel.tooth_half_angle(wheel.base_radius() / cosine);
    const double wheel_start = pair.internal() ? wheel_half : -wheel_half;
    const double wheel_turn = (pair.internal() ? 1.0 : -1.0) * planet.teeth() / wheel.teeth();
    double deepest = -1;
    for (int step = 0; step < 24; ++step) {
      const double turn = planet.pitch_angle() * step / 24;
      double deepest_here = -1;
      for (int tooth = -4; tooth <= 4; ++tooth) {
        const double angle = planet_start + turn + tooth * planet.pitch_angle();
        const auto probe = [&, a = a](const Eigen::Vector2d& local) {
          const double c = std::cos(angle);
          const double s = std::sin(angle);
          const Eigen::Vector2d q(a + c * local.x() - s * local.y(), s * local.x() + c * local.y());
          deepest_here = std::max(deepest_here, depth_inside(w, {0, 0}, wheel_start + wheel_turn * turn, q));
        };
        for (int i = 0; i <= 200; ++i) {
          const double roll = p.roll_length_form() + (p.roll_length_tip() - p.roll_length_form()) * i / 200;
          for (const auto& local : {p.flank_point(roll), p.fillet_point(i / 200.0)}) {
            probe(local);
            probe({local.x(), -local.y()});
          }
        }
      }
      // Sampled at 0.05 modules: the chord of the curvature radii of some ten modules is below 1e-4 modules.
      BOOST_TEST(deepest_here > -2e-4 * planet.parameters().module);
      deepest = std::max(deepest, deepest_here);
    }
    record.at_most("deepest point of the planet inside the wheel", "m", deepest, 1e-12,
                   "rounding of the angles x radius");
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::geometry::test
