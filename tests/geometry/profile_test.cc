#include "geometry/profile.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "gears.h"

namespace annulus::geometry::test {

namespace {

Eigen::Vector2d mirror(const Eigen::Vector2d& p) { return {p.x(), -p.y()}; }

}  // namespace

BOOST_AUTO_TEST_SUITE(profile)

BOOST_AUTO_TEST_CASE(flank_points_have_the_tooth_thickness_and_their_normal_touches_the_base_circle) {
  for (const Gear& g : {paper_planet(), paper_ring()}) {
    const ToothProfile profile(g);
    for (const double roll : {profile.roll_length_form(), 40 * units::mm, profile.roll_length_tip()}) {
      const Eigen::Vector2d p = profile.flank_point(roll);
      const Eigen::Vector2d n = profile.flank_normal(roll);
      const double r = std::hypot(g.base_radius(), roll);
      BOOST_TEST(p.norm() == r, boost::test_tools::tolerance(1e-14));
      BOOST_TEST(std::atan2(p.y(), p.x()) == g.tooth_half_angle(r),
                 boost::test_tools::tolerance(1e-11));  // cancellation
      BOOST_TEST(std::abs(p.x() * n.y() - p.y() * n.x()) == g.base_radius(), boost::test_tools::tolerance(1e-14));
      // Normal to the curve, by a central difference (error step^2 / curvature radius^2), and out of the material.
      const double step = 1e-6 * roll;
      const Eigen::Vector2d d = (profile.flank_point(roll + step) - profile.flank_point(roll - step)).normalized();
      BOOST_TEST(std::abs(d.dot(n)) < 1e-8);
      const Eigen::Vector2d outside = p + 1e-4 * n;
      BOOST_TEST(std::atan2(outside.y(), outside.x()) > g.tooth_half_angle(outside.norm()));
    }
  }
}

BOOST_AUTO_TEST_CASE(modifications_add_up) {
  auto p = paper_gear(GearKind::external, 55, 0.7361);
  p.tip_relief = 20 * units::um;
  p.tip_relief_length = 4 * units::mm;
  p.profile_crowning = 6 * units::um;
  auto q = paper_gear(GearKind::internal, 162, 0.1516);
  q.tip_relief = p.tip_relief;
  q.tip_relief_length = p.tip_relief_length;
  q.profile_crowning = p.profile_crowning;
  for (const auto& parameters : {p, q}) {
    const ToothProfile profile{Gear(parameters)};
    const double tip = profile.roll_length_tip();
    const double form = profile.roll_length_form();
    const double inwards = form > tip ? 1 : -1;  // from tip to root
    const auto um = [&](double roll) { return profile.modification(roll) / units::um; };
    const double rounding = 1e-9;
    BOOST_TEST(std::abs(um(tip) - 26) < rounding);
    BOOST_TEST(std::abs(um(form) - 6) < rounding);
    BOOST_TEST(std::abs(um(0.5 * (tip + form))) < rounding);
    const double half_relief = tip + inwards * 2 * units::mm;
    const double u = (half_relief - form) / (tip - form);
    BOOST_TEST(std::abs(um(half_relief) - (10 + 6 * (2 * u - 1) * (2 * u - 1))) < rounding);
    BOOST_TEST(std::abs(um(tip - inwards * units::mm) - 26) < rounding);
  }
}

BOOST_AUTO_TEST_CASE(profile_slopes_run_from_one_end_of_the_flank_to_the_other) {
  for (const auto kind : {GearKind::external, GearKind::internal}) {
    auto p = kind == GearKind::external ? paper_gear(kind, 55, 0.7361) : paper_gear(kind, 162, 0.1516);
    p.tip_chamfer = 0.5 * units::mm;
    const auto um = [&](double slope, double u) {
      p.profile_slope = slope * units::um;
      const ToothProfile profile{Gear(p)};
      const double tip = profile.roll_length_tip(), form = profile.roll_length_form();
      // The flank ends at the chamfer.
      BOOST_TEST(std::hypot(profile.gear().base_radius(), tip) == profile.gear().tip_form_radius(),
                 boost::test_tools::tolerance(1e-14));
      return profile.modification(form + u * (tip - form)) / units::um;
    };
    const double rounding = 1e-9;
    BOOST_TEST(std::abs(um(9, 1) - 9) < rounding);
    BOOST_TEST(std::abs(um(9, 0)) < rounding);
    BOOST_TEST(std::abs(um(9, 1.0 / 3) - 3) < rounding);
    BOOST_TEST(std::abs(um(-9, 0) - 9) < rounding);
    BOOST_TEST(std::abs(um(-9, 1.0 / 3) - 6) < rounding);
  }
}

BOOST_AUTO_TEST_CASE(lead_modifications_add_up) {
  auto p = paper_gear(GearKind::internal, 162, 0.1516);  // face width 88 mm
  p.lead_crowning = 8 * units::um;
  const auto um = [&p](double z_mm) { return ToothProfile(Gear(p)).lead_modification(z_mm * units::mm) / units::um; };
  const double rounding = 1e-12;
  BOOST_TEST(std::abs(um(0) - 8) < rounding);
  BOOST_TEST(std::abs(um(44)) < rounding);
  BOOST_TEST(std::abs(um(22) - 2) < rounding);  // half way from the middle: a quarter
  BOOST_TEST(std::abs(um(88) - 8) < rounding);
  p.lead_slope = 12 * units::um;
  BOOST_TEST(std::abs(um(0) - 8) < rounding);
  BOOST_TEST(std::abs(um(66) - (2 + 9)) < rounding);
  BOOST_TEST(std::abs(um(88) - 20) < rounding);
  BOOST_TEST(std::abs(um(90) - 20) < rounding);
  p.lead_slope = -12 * units::um;
  BOOST_TEST(std::abs(um(0) - 20) < rounding);
  BOOST_TEST(std::abs(um(66) - (2 + 3)) < rounding);
  BOOST_TEST(std::abs(um(88) - 8) < rounding);
  p.lead_crowning = -1 * units::um;
  check_refused([&] { (void)Gear(p); }, "lead crowning");
}

// The surface swept by the twisted section is the involute helicoid of the right hand: its normal leans out of the
// transverse section by the base helix angle and its trace on the reference cylinder by the helix angle.
BOOST_AUTO_TEST_CASE(twisted_sections_make_helical_flanks) {
  for (const auto kind : {GearKind::external, GearKind::internal}) {
    for (const double beta : {20 * units::deg, -12 * units::deg}) {
      const Gear g(helical(paper_gear(kind, 60, 0.1), beta));
      const ToothProfile profile(g);
      const auto surface = [&](double roll, double z) -> Eigen::Vector3d {
        const Eigen::Vector2d p = Eigen::Rotation2Dd(profile.twist() * z) * profile.flank_point(roll);
        return {p.x(), p.y(), z};
      };
      const double roll = profile.roll_length_at(g.reference_radius());
      const double z = 10 * units::mm;
      const double step = 1e-7;  // m; central differences, errors (step / 0.1 m)^2 and rounding 1e-17 / step
      const Eigen::Vector3d along = (surface(roll, z + step) - surface(roll, z - step)) / (2 * step);
      const Eigen::Vector3d up = (surface(roll + step, z) - surface(roll - step, z)) / (2 * step);
      const Eigen::Vector3d normal = along.cross(up).normalized();
      BOOST_TEST(std::abs(std::abs(normal.z()) - std::sin(std::abs(g.base_helix_angle()))) < 1e-8);
      // Right hand: the trace climbs counter-clockwise.
      const Eigen::Vector3d at = surface(roll, z);
      const Eigen::Vector3d around = Eigen::Vector3d::UnitZ().cross(at).normalized();
      BOOST_TEST(std::abs(std::atan2(along.dot(around), along.z()) - beta) < 1e-8);

      const Eigen::Vector3d off = at + 0.01 * g.parameters().module * Eigen::Vector3d(normal.x(), normal.y(), 0);
      const Eigen::Vector3d found = profile.project_solid(Boundary::leading_flank, off, 0);
      BOOST_TEST((found - at).norm() < 1e-12);
      BOOST_TEST((profile.project_solid(Boundary::end_high, off, 0) - off).norm() < 1e-16);  // turned back and forth
    }
  }
}

BOOST_AUTO_TEST_CASE(projection_is_exact_idempotent_and_mirrored) {
  const double rounding = 1e-14;  // m; coordinates of 0.3 m carry 5e-17
  auto few_teeth = plain_gear(GearKind::external, 18);
  for (const Gear& g : {paper_sun(), paper_planet(), paper_ring(), Gear(few_teeth)}) {
    const ToothProfile profile(g);
    const double off = 0.02 * g.parameters().module;
    for (int i = 0; i <= 16; ++i) {
      const double t = i / 16.0;
      const double roll = profile.roll_length_form() + t * (profile.roll_length_tip() - profile.roll_length_form());
      const Eigen::Vector2d flank = profile.flank_point(roll);
      const Eigen::Vector2d flank_normal = profile.flank_normal(roll);
      const Eigen::Vector2d fillet = profile.fillet_point(t);
      const Eigen::Vector2d tangent = profile.fillet_tangent(t);
      const Eigen::Vector2d fillet_normal(tangent.y(), -tangent.x());
      for (const double distance : {-off, 0.0, off}) {
        // A point on the normal comes back to its foot, which makes it the nearest one.
        const auto check = [&](Boundary leading, Boundary trailing, const Eigen::Vector2d& foot,
                               const Eigen::Vector2d& n) {
          const Eigen::Vector2d q = foot + distance * n;
          const Eigen::Vector2d found = profile.project(leading, q, 0);
          BOOST_TEST((found - foot).norm() < 1e-12);  // conditioning: the base circle is near where the roll is short
          BOOST_TEST((profile.project(leading, found, 0) - found).norm() < 1e-13);
          BOOST_TEST((profile.project(trailing, mirror(q), 0) - mirror(found)).norm() < rounding);
        };
        check(Boundary::leading_flank, Boundary::trailing_flank, flank, flank_normal);
        check(Boundary::leading_fillet, Boundary::trailing_fillet, fillet, fillet_normal);
      }
    }
    // Beyond the ends of flank and fillet: the end points.
    const Eigen::Vector2d tip = profile.flank_point(profile.roll_length_tip());
    const Eigen::Vector2d root = profile.fillet_point(1);
    const Eigen::Vector2d outwards = (tip - profile.flank_point(profile.roll_length_form())).normalized();
    BOOST_TEST((profile.project(Boundary::leading_flank, tip + off * outwards, 0) - tip).norm() < rounding);
    BOOST_TEST((profile.project(Boundary::leading_fillet, root + off * profile.fillet_tangent(1), 0) - root).norm() <
               rounding);
  }
}

BOOST_AUTO_TEST_CASE(circles_and_free_boundaries) {
  const Gear g = paper_ring();
  const ToothProfile profile(g);
  const Eigen::Vector2d q(0.31, 0.004);
  const double support = 0.3318;
  const double rounding = 1e-15;
  BOOST_TEST((profile.project(Boundary::tip, q, support) - q.normalized() * g.tip_radius()).norm() < rounding);
  BOOST_TEST((profile.project(Boundary::root, q, support) - q.normalized() * g.root_radius()).norm() < rounding);
  BOOST_TEST((profile.project(Boundary::support, q, support) - q.normalized() * support).norm() < rounding);
  const double outside = 0.325;
  BOOST_TEST((profile.project(Boundary::outside, q, support, outside) - q.normalized() * outside).norm() < rounding);
  BOOST_CHECK_THROW((void)profile.project(Boundary::outside, q, support), InternalError);
  for (const auto b : {Boundary::none, Boundary::side_low, Boundary::side_high, Boundary::end_low, Boundary::end_high,
                       Boundary::inner, Boundary::flange_face}) {
    BOOST_TEST((profile.project(b, q, support) - q).norm() == 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::geometry::test
