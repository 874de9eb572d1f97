#include <Eigen/Core>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "dynamics/modes/modes.h"
#include "dynamics/systems/planetary/response.h"
#include "tests/dynamics/lumped_stages.h"
#include "tests/verification_record.h"

/// Rings in mounts beside their axis.
BOOST_AUTO_TEST_SUITE(mounts)

using namespace annulus::dynamics;
using namespace stages::lumped_in_space;
namespace units = annulus::units;

constexpr double radius = stages::mounts_radius, radial = stages::mounts_radial, axial = stages::mounts_axial,
                 place = stages::mounts_place;

SpatialStage stage_in_mounts(int count, double helix = 7.5 * units::deg) {
  auto s = stages::reliability_stage(helix);
  add_all_bearings(s);
  stages::put_ring_in_mounts(s, count);
  return s;
}

// Two mounts bear the torque of the ring as a pair of forces, on a lever of their distance, whatever else they bear.
BOOST_AUTO_TEST_CASE(torque_of_the_ring_in_two_mounts) {
  annulus::test::Verification record("Ring in two mounts", "pair of forces");
  auto s = stage_in_mounts(2);
  s.gravity = {2, -9.5, 1};
  s.weights = {{{Kind::ring}, 509, 0.02}};
  for (const double cycle : {0.0, 31.0, 77.0}) {
    const auto turn = statics(s, {cycle});
    const auto& p = turn.positions.front();
    const auto &right = p.bearings[9], &left = p.bearings[10];
    const double torque = -(s.plane.sun_torque + p.carrier_torque);
    record.close("torque of the housing on the ring", "N m", p.ring_torque, torque, 1e-9,
                 "residual of the equilibrium");
    record.close("difference of the forces times half their distance", "N m",
                 radius * (right.force.y() - left.force.y()), torque, 1e-9, "residual of the equilibrium");
    record.close("rotation of the ring", "rad", p.bodies[1].rotation.z(), -torque / (2 * radial * radius * radius),
                 1e-9, "residual of the equilibrium");
    BOOST_TEST(std::abs(right.force.z() - left.force.z()) > 1);
  }
}

// Four mounts hold as a bearing on the axis and a support of the rotation do.
BOOST_AUTO_TEST_CASE(four_mounts_as_one_bearing) {
  annulus::test::Verification record("Ring in four mounts, small motions", "one bearing and a torsional support");
  auto s = stage_in_mounts(4), on_axis = s;
  on_axis.bearings.resize(9);
  auto one = stages::bearing("trunnions", {Kind::ring}, {}, place, 4 * radial, 4 * axial, 2 * axial * radius * radius);
  on_axis.bearings.push_back(one);
  on_axis.plane.ring.torsional_support = 4 * radial * radius * radius / std::pow(s.plane.ring.radius, 2);
  const auto a = annulus::dynamics::modes(assemble(lumped(s))), b = annulus::dynamics::modes(assemble(lumped(on_axis)));
  BOOST_TEST_REQUIRE(a.modes.size() == b.modes.size());
  for (std::size_t i = 0; i < a.modes.size(); ++i)
    if (b.modes[i].frequency > 0)
      record.close("natural frequencies", "Hz", a.modes[i].frequency, b.modes[i].frequency, 1e-9, "rounding");
  const auto found = solved(lumped(s)), expected = solved(lumped(on_axis));
  for (std::size_t m = 0; m < 6; ++m)
    record.close("mesh forces at rest", "N", found.force[m], expected.force[m], 1e-9, "residual of the equilibrium");
}

// Mounts on one side of the face, or two in place of four, tilt the ring under its weight.
BOOST_AUTO_TEST_CASE(mounts_depend_on_the_angle_of_the_carrier) {
  BOOST_TEST(stage_in_mounts(2).depends_on_carrier_angle());
  BOOST_TEST(stage_in_mounts(2).ring_turns_in_mounts());
  auto s = stage_in_mounts(1);
  BOOST_TEST(!s.reasons_for_space().empty());
  s.bearings.pop_back();
  BOOST_TEST(!s.ring_turns_in_mounts());
}

BOOST_AUTO_TEST_SUITE_END()
