#include "geometry/gear.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gears.h"
#include "geometry/profile.h"
#include "tests/verification_record.h"

namespace annulus::geometry::test {

BOOST_AUTO_TEST_SUITE(gear)

BOOST_AUTO_TEST_CASE(base_tangent_lengths_of_a_published_pair) {
  annulus::test::Verification record("Base tangent lengths of a published pair",
                                     "printed values of a profile-shifted pair, "
                                     "m = 1.75 mm");
  GearParameters p = plain_gear(GearKind::external, 21, 0.4380);
  p.module = 1.75 * units::mm;
  // Half of the last printed digit (0.05 um), and the printed x may be off by 5e-5: 2 * 5e-5 m sin(alpha) = 0.06 um.
  const double printed = 0.11e-3;  // mm
  const char* digits = "half of the last digit of the length and of the profile shift";
  record.near("21 teeth, over 3 teeth", "mm", Gear(p).base_tangent_length(3) / units::mm, 13.9546, printed, digits);
  p.teeth = 43;
  p.profile_shift = 0.0426;
  record.near("43 teeth, over 5 teeth", "mm", Gear(p).base_tangent_length(5) / units::mm, 24.3530, printed, digits);
}

// Worked example of the span measurement of helical gears [KHK]: module 3 mm, 20 deg, 24
// teeth, helix angle 25 deg, x = 0.4, five teeth: 42.0085 mm.
BOOST_AUTO_TEST_CASE(base_tangent_length_of_a_published_helical_gear) {
  annulus::test::Verification record("Base tangent length of a published helical gear",
                                     "KHK, gear technical reference: worked example of the span measurement");
  auto p = helical(plain_gear(GearKind::external, 24, 0.4), 25 * units::deg);
  p.module = 3 * units::mm;
  record.near("24 teeth, over 5 teeth", "mm", Gear(p).base_tangent_length(5) / units::mm, 42.0085, 0.05e-3,
              "half of the last digit");
}

// Independent of the formula: W_k is the distance of two parallel tangent planes, that is the base tooth thickness
// (external) or base space width (internal) and k - 1 base pitches, normal to the teeth on the base cylinder.
BOOST_AUTO_TEST_CASE(base_tangent_length_agrees_with_the_tooth_on_the_base_circle) {
  annulus::test::Verification record("Base tangent length of spur and helical, external and internal gears",
                                     "distance of two tangent planes: base tooth thickness and base pitches");
  for (const auto& [kind, teeth, x] : {std::tuple{GearKind::external, 55, 0.7361}, {GearKind::internal, 162, 0.1516}}) {
    for (const double beta : {0.0, 18.0, -31.0}) {
      const Gear g(helical(paper_gear(kind, teeth, x), beta * units::deg));
      const double tooth = g.tooth_thickness(g.base_radius());
      const double width = kind == GearKind::external ? tooth : g.base_pitch() - tooth;
      record.close(std::to_string(teeth) + " teeth, over 4", "m", g.base_tangent_length(4),
                   (width + 3 * g.base_pitch()) * std::cos(g.base_helix_angle()), 1e-13, "rounding");
    }
  }
}

BOOST_AUTO_TEST_CASE(normal_and_transverse_sections_of_helical_gears) {
  annulus::test::Verification record("Normal and transverse section of helical gears", "ISO 21771");
  const auto rounding = boost::test_tools::tolerance(1e-14);
  const double m = 2 * units::mm;
  const double alpha = 20 * units::deg;
  const double x = 0.25;
  for (const auto kind : {GearKind::external, GearKind::internal}) {
    const double sign = kind == GearKind::external ? 1 : -1;
    for (const double beta : {12 * units::deg, -30 * units::deg}) {
      const Gear g(helical(plain_gear(kind, 60, x), beta));
      // What the two sections share, ISO 21771: the normal base pitch, the normal tooth thickness, the heights.
      record.close("sine of the base helix angle", "", std::sin(g.base_helix_angle()), std::sin(beta) * std::cos(alpha),
                   1e-14, "rounding");
      BOOST_TEST(
          std::cos(g.base_helix_angle()) * std::cos(g.transverse_pressure_angle()) == std::cos(beta) * std::cos(alpha),
          rounding);
      record.close("normal base pitch", "m", g.base_pitch() * std::cos(g.base_helix_angle()),
                   std::numbers::pi * m * std::cos(alpha), 1e-14, "rounding");
      record.close("normal tooth thickness", "m", g.tooth_thickness(g.reference_radius()) * std::cos(beta),
                   m * (std::numbers::pi / 2 + sign * 2 * x * std::tan(alpha)), 1e-14, "rounding");
      BOOST_TEST(g.reference_radius() == 60 * m / (2 * std::cos(beta)), rounding);
      BOOST_TEST(g.tip_radius() == g.reference_radius() + sign * m * (1 + sign * x), rounding);
      BOOST_TEST(g.root_radius() == g.reference_radius() - sign * m * (1.25 - sign * x), rounding);
      BOOST_TEST(g.helix_angle_at(g.reference_radius()) == beta, rounding);
      // The hand changes no transverse section.
      const Gear mirror(helical(plain_gear(kind, 60, x), -beta));
      BOOST_TEST(mirror.form_radius() == g.form_radius());
      BOOST_TEST(mirror.tooth_half_angle(mirror.tip_radius()) == g.tooth_half_angle(g.tip_radius()));
    }
  }
}

BOOST_AUTO_TEST_CASE(derived_dimensions_follow_the_sign_rule) {
  annulus::test::Verification record("Radii and tooth thickness of external and internal gears", "ISO 21771, by hand");
  const double rounding = 1e-14;
  const Gear external(plain_gear(GearKind::external, 30, 0.25));
  record.close("external: tip radius", "m", external.tip_radius(), 32.5 * units::mm, rounding, "rounding");
  record.close("external: root radius", "m", external.root_radius(), 28.0 * units::mm, rounding, "rounding");
  const Gear internal(plain_gear(GearKind::internal, 80, 0.25));
  record.close("internal: tip radius", "m", internal.tip_radius(), 78.5 * units::mm, rounding, "rounding");
  record.close("internal: root radius", "m", internal.root_radius(), 83.0 * units::mm, rounding, "rounding");
  // A positive shift makes the external tooth thicker and the internal one thinner by the same amount.
  const double half_pitch = std::numbers::pi * units::mm;
  const double gain = 2 * 0.25 * 2 * units::mm * std::tan(20 * units::deg);
  record.close("external: tooth thickness", "m", external.tooth_thickness(external.reference_radius()),
               half_pitch + gain, rounding, "rounding");
  record.close("internal: tooth thickness", "m", internal.tooth_thickness(internal.reference_radius()),
               half_pitch - gain, rounding, "rounding");
}

BOOST_AUTO_TEST_CASE(inverse_involute_inverts) {
  for (const double angle : {1e-4, 0.01, 0.3, 0.8, 1.2, 1.5}) {
    // d angle = d inv / tan^2; inv itself is the difference tan - angle, which carries the rounding of tan.
    const double error = 8e-16 * std::tan(angle) / std::pow(std::tan(angle), 2);
    BOOST_TEST(std::abs(inverse_involute(involute(angle)) - angle) <= error + 4e-16 * angle);
  }
  BOOST_TEST(inverse_involute(0) == 0);
}

BOOST_AUTO_TEST_CASE(impossible_gears_are_refused_with_the_reason) {
  const auto refuse = [](const GearParameters& p, const std::string& part) {
    check_refused([&] { (void)Gear(p); }, part);
  };
  auto p = plain_gear(GearKind::external, 14, -0.8);
  refuse(p, "undercut");
  p.profile_shift = 0.3;
  BOOST_CHECK_NO_THROW(Gear{p});
  p.profile_shift = 1.0;
  p.teeth = 9;
  refuse(p, "pointed");
  p = plain_gear(GearKind::internal, 24);
  refuse(p, "base circle");
  p = plain_gear(GearKind::external, 30);
  p.root_diameter = 66 * units::mm;
  refuse(p, "wrong side");
  p = plain_gear(GearKind::external, 30);
  p.root_diameter = 46 * units::mm;
  refuse(p, "rack");
  p = plain_gear(GearKind::internal, 80);
  p.root_diameter = 176 * units::mm;
  refuse(p, "too narrow at the root diameter");
  p = plain_gear(GearKind::external, 30);
  p.tip_diameter = 57 * units::mm;
  refuse(p, "usable flank");
  p = plain_gear(GearKind::external, 30);
  p.tip_relief = 10 * units::um;
  refuse(p, "tip relief length");
  p.tip_relief_length = 30 * units::mm;
  refuse(p, "longer than its flank");
  p = plain_gear(GearKind::external, 30);
  p.module = std::numeric_limits<double>::quiet_NaN();
  refuse(p, "module");
  p = plain_gear(GearKind::external, 30);
  p.face_width = 0;
  refuse(p, "face width");
  p = plain_gear(GearKind::external, 4);
  refuse(p, "teeth");
  refuse(helical(plain_gear(GearKind::external, 30), -46 * units::deg), "helix angle");
  p = plain_gear(GearKind::external, 30);
  p.tip_chamfer = 1.5 * units::mm;
  refuse(p, "leaves no tip");
  p.tip_chamfer = -1 * units::um;
  refuse(p, "negative tip chamfer");
}

// The rack that reaches beyond the start of the involute takes some of it away.
BOOST_AUTO_TEST_CASE(undercut_starts_at_the_limit_of_the_generating_rack) {
  for (const double beta : {0.0, 20 * units::deg}) {
    auto p = helical(plain_gear(GearKind::external, 12), beta);
    // The straight rack flank ends at the depth 1.25 - x - rho (1 - sin alpha_n) modules and must stay above r sin^2
    // alpha_t.
    const double transverse = std::atan(std::tan(p.pressure_angle) / std::cos(beta));
    const double limit = 1.25 - p.root_fillet_factor * (1 - std::sin(p.pressure_angle)) -
                         p.teeth / (2 * std::cos(beta)) * std::pow(std::sin(transverse), 2);
    p.profile_shift = limit + 1e-6;
    BOOST_TEST(!Gear(p).undercut());
    BOOST_TEST(Gear(p).form_radius() > Gear(p).base_radius());
    double before = Gear(p).base_radius();
    for (const double less : {1e-3, 0.1, 0.3}) {
      p.profile_shift = limit - less;
      const Gear gear(p);
      BOOST_TEST(gear.undercut());
      BOOST_TEST(gear.form_radius() > before);
      before = gear.form_radius();
    }
    p.profile_shift = limit - 0.8;
    check_refused([&] { (void)Gear(p); }, "undercut");
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(generation)

/// The rounded tooth of the generating rack: every point within `radius` of a wedge with flat bottom. Rack coordinates
/// in the normal section: x along the pitch line from the tooth's centre, y outwards. The rack is a cylinder along its
/// teeth: a point of the transverse section at x has the distance of the point at x cos(beta) in the normal section.
struct RackTooth {
  double radius, corner_x, corner_y, alpha;
  /// Of the protuberance: how far its corner lies further out, and the angle of its flank.
  double further = 0, ramp = 0;

  RackTooth(const GearParameters& p, double pitch_radius, double root_radius)
      : radius(p.root_fillet_factor * p.module),
        corner_y(root_radius + radius - pitch_radius),
        alpha(p.pressure_angle) {
    // The flank of the wedge is the rack flank moved inwards by the radius; on the datum line the rack tooth is pi m
    // / 2.
    const double datum = p.profile_shift * p.module;
    corner_x = std::numbers::pi * p.module / 4 - (datum - corner_y) * std::tan(alpha) - radius / std::cos(alpha);
    further = p.protuberance / std::cos(alpha);
    ramp = p.protuberance_angle;
  }
  /// Signed distance, negative inside the rack tooth (near its surface, outside of the wedge).
  [[nodiscard]] double distance(double x, double y) const {
    const double main = distance(std::abs(x) - corner_x, y - corner_y, alpha);
    return further == 0 ? main : std::min(main, distance(std::abs(x) - corner_x - further, y - corner_y, ramp));
  }
  /// From the wedge with its corner at the origin.
  [[nodiscard]] double distance(double dx, double dy, double angle) const {
    const double across = dx * std::cos(angle) - dy * std::sin(angle);
    const double along = dx * std::sin(angle) + dy * std::cos(angle);
    if (along > 0) return across - radius;
    if (dx < 0) return -dy - radius;
    return std::hypot(dx, dy) - radius;
  }
};

/// Smallest distance between a gear point and the rack tooth while the rack rolls through.
double generated_gap(const RackTooth& rack, double pitch_radius, double helix_angle, const Eigen::Vector2d& p,
                     double space_angle) {
  const auto gap = [&](double phi) {
    const double c = std::cos(space_angle + phi);
    const double s = std::sin(space_angle + phi);
    return rack.distance((-p.x() * s + p.y() * c + pitch_radius * phi) * std::cos(helix_angle),
                         p.x() * c + p.y() * s - pitch_radius);
  };
  constexpr int samples = 4000;
  constexpr double range = 0.6;  // rad: the rack tooth has left the gear on both sides
  const double step = 2 * range / samples;
  double best = 0;
  double least = gap(0);
  for (int i = 0; i <= samples; ++i) {
    const double phi = -range + i * step;
    if (gap(phi) < least) {
      least = gap(phi);
      best = phi;
    }
  }
  double a = best - step;
  double b = best + step;
  for (int i = 0; i < 80; ++i) {  // ternary search in the bracket
    const double l = a + (b - a) / 3;
    const double r = b - (b - a) / 3;
    (gap(l) < gap(r) ? b : a) = gap(l) < gap(r) ? r : l;
  }
  return std::min(least, gap(0.5 * (a + b)));
}

// Flank, fillet and root of an external gear are exactly what the rolling rack leaves: it touches every point and cuts
// into none.
BOOST_AUTO_TEST_CASE(external_outline_is_the_envelope_of_the_rack) {
  annulus::test::Verification record("Outline of generated external gears: fillet and flank",
                                     "envelope of the rolling rack, searched numerically");
  for (const auto& [teeth, x, beta] : {std::tuple{19, 0.0, 0.0},
                                       {17, 0.6, 0.0},
                                       {40, -0.4, 0.0},
                                       {150, 0.9, 0.0},
                                       {19, 0.0, 15.0},
                                       {17, 0.6, -30.0},
                                       {40, -0.4, 30.0},
                                       {150, 0.9, 42.0},
                                       {14, 0.0, 0.0},       // undercut
                                       {17, -0.2, 0.0},      // likewise
                                       {12, 0.05, 20.0}}) {  // likewise
    const auto p = helical(plain_gear(GearKind::external, teeth, x), beta * units::deg);
    const Gear g(p);
    const ToothProfile profile(g);
    const RackTooth rack(p, g.reference_radius(), g.root_radius());
    const double space = g.pitch_angle() / 2;
    const double tolerance = 1e-9 * p.module;  // a minimum found by comparing values is flat to sqrt(eps)^2 * size
    for (int i = 0; i <= 20; ++i) {
      const double t = i / 20.0;
      const double gap = generated_gap(rack, g.reference_radius(), p.helix_angle, profile.fillet_point(t), space);
      const auto name = std::to_string(teeth) + " teeth";
      record.near("gap between rack and fillet over module, " + name, "", gap / p.module, 0, tolerance / p.module,
                  "minimum found by comparing values");
      const double roll = profile.roll_length_form() + t * (profile.roll_length_tip() - profile.roll_length_form());
      const double flank_gap =
          generated_gap(rack, g.reference_radius(), p.helix_angle, profile.flank_point(roll), space);
      record.near("gap between rack and flank over module, " + name, "", flank_gap / p.module, 0, tolerance / p.module,
                  "minimum found by comparing values");
    }
  }
}

BOOST_AUTO_TEST_CASE(internal_fillet_is_the_tangent_arc) {
  annulus::test::Verification record("Fillet of an internal gear", "circle through three of its points");
  const auto p = plain_gear(GearKind::internal, 80, 0.2);
  const Gear g(p);
  const ToothProfile profile(g);
  // Curvature from three points of the arc: circumscribed circle.
  const Eigen::Vector2d a = profile.fillet_point(0);
  const Eigen::Vector2d b = profile.fillet_point(0.5);
  const Eigen::Vector2d c = profile.fillet_point(1);
  const double twice_area = std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
  const double radius = (b - a).norm() * (c - b).norm() * (a - c).norm() / (2 * twice_area);
  record.close("radius", "m", radius, p.root_fillet_factor * p.module, 1e-11, "rounding, differences of 1e-3");
}

// With a protuberance, that of the tool: flank, ramp and fillet together. Fillets end in the root circle as all do.
BOOST_AUTO_TEST_CASE(a_protuberance_leaves_its_envelope) {
  annulus::test::Verification record("Outline of external gears from a rack with a protuberance",
                                     "envelope of the rolling rack, searched numerically");
  for (const auto& [teeth, x, beta, modules, ramp] : {std::tuple{25, 0.2, 0.0, 0.02, 10.0},
                                                      {60, -0.1, 0.0, 0.05, 8.0},
                                                      {25, 0.3, 20.0, 0.03, 12.0},
                                                      {25, 0.2, 0.0, 0.002, 4.0},     // the corner alone
                                                      {14, 0.0, 0.0, 0.02, 10.0}}) {  // undercut as well
    auto p = helical(plain_gear(GearKind::external, teeth, x), beta * units::deg);
    const Gear without(p);
    p.protuberance = modules * p.module;
    p.protuberance_angle = ramp * units::deg;
    const Gear g(p);
    BOOST_TEST(g.form_radius() > without.form_radius());
    BOOST_TEST(g.undercut() == without.undercut());
    const ToothProfile profile(g);
    const RackTooth rack(p, g.reference_radius(), g.root_radius());
    const double space = g.pitch_angle() / 2;
    const auto name = fmt::format("{} teeth, {} modules", teeth, modules);
    for (int i = 0; i <= 20; ++i) {
      const double t = i / 20.0;
      const double roll = profile.roll_length_form() + t * (profile.roll_length_tip() - profile.roll_length_form());
      for (const auto& point : {profile.fillet_point(t), profile.flank_point(roll)})
        record.near("gap between rack and outline over module, " + name, "",
                    generated_gap(rack, g.reference_radius(), p.helix_angle, point, space) / p.module, 0, 1e-9,
                    "minimum found by comparing values");
    }
    const double rounding = 1e-11 * g.tip_radius();  // of the crossing of two curves
    record.at_most("distance from the involute's end", "m",
                   (profile.fillet_point(0) - profile.flank_point(profile.roll_length_form())).norm(), rounding,
                   "rounding");
    record.near("end of the fillet less root radius", "m", profile.fillet_point(1).norm() - g.root_radius(), 0,
                rounding, "rounding");
    // Points find their place on the curve again.
    for (const double t : {0.1, 0.3, 0.6, 0.9}) {
      const Eigen::Vector2d on = profile.fillet_point(t),
                            normal(-profile.fillet_tangent(t).y(), profile.fillet_tangent(t).x());
      const Eigen::Vector2d back = profile.project(Boundary::leading_fillet, on + 1e-6 * normal, 0);
      BOOST_TEST((back - on).norm() < 1e-10);
    }
  }
  auto p = plain_gear(GearKind::external, 30);
  p.protuberance = 0.05 * p.module;
  check_refused([&] { (void)Gear(p); }, "protuberance angle");
  p.protuberance_angle = 25 * units::deg;
  check_refused([&] { (void)Gear(p); }, "below the pressure angle");
  p.protuberance_angle = 18 * units::deg;
  p.protuberance = 0.8 * p.module;
  check_refused([&] { (void)Gear(p); }, "protuberance");
  p.protuberance = 1e-9 * p.module;
  BOOST_CHECK_NO_THROW(Gear{p});
  p = plain_gear(GearKind::internal, 80);
  p.protuberance = 0.05 * p.module;
  check_refused([&] { (void)Gear(p); }, "only external gears");
}

// Both kinds: the fillet starts on the involute with its tangent and ends on the root circle with its tangent.
BOOST_AUTO_TEST_CASE(fillets_join_smoothly) {
  annulus::test::Verification record("Fillets between involute and root circle", "common point and common tangent");
  auto full = plain_gear(GearKind::external, 30, 0.1);
  full.root_fillet_factor = 2;  // limited to the full root rounding
  auto full_internal = plain_gear(GearKind::internal, 80, 0.1);
  full_internal.root_fillet_factor = 2;
  for (const auto& p : {plain_gear(GearKind::external, 25, 0.3), plain_gear(GearKind::internal, 60, -0.2), full,
                        full_internal, helical(full, 25 * units::deg), helical(full_internal, -25 * units::deg)}) {
    const Gear g(p);
    const ToothProfile profile(g);
    const double form = profile.roll_length_form();
    const double rounding = 1e-13 * g.tip_radius();
    record.at_most("distance from the involute's end", "m",
                   (profile.fillet_point(0) - profile.flank_point(form)).norm(), rounding, "rounding");
    record.near("fillet's tangent against the involute's normal", "",
                profile.fillet_tangent(0).dot(profile.flank_normal(form)), 0, 1e-12, "rounding");
    record.near("end of the fillet less root radius", "m", profile.fillet_point(1).norm() - g.root_radius(), 0,
                rounding, "rounding");
    record.near("fillet's tangent against the root circle's normal", "",
                profile.fillet_tangent(1).dot(profile.fillet_point(1).normalized()), 0, 1e-12, "rounding");
    BOOST_TEST(std::abs(g.form_radius() - profile.fillet_point(0).norm()) < rounding);
    // Half the root land stays 0.02 modules wide on the rack, a little less on the smaller root circle.
    const Eigen::Vector2d end = profile.fillet_point(1);
    const double land = (g.pitch_angle() / 2 - std::atan2(end.y(), end.x())) * g.root_radius();
    BOOST_TEST(land >= 0.018 * p.module);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::geometry::test
