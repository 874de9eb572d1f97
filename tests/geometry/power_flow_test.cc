#include "geometry/power_flow.h"

#include <boost/test/unit_test.hpp>

#include "core/errors.h"

BOOST_AUTO_TEST_SUITE(power_flow)

using namespace annulus::geometry;

constexpr StageMember members[] = {StageMember::sun, StageMember::carrier, StageMember::ring};
constexpr double rounding = 1e-14;

// Ratios of textbooks for 24 and 72 teeth: reducer 1 + z_r/z_s, solar 1 + z_s/z_r, star -z_r/z_s.
BOOST_AUTO_TEST_CASE(ratios_of_the_three_ways_to_hold_a_member) {
  const auto close = boost::test_tools::tolerance(rounding);
  const auto reducer = member_speeds(24, 72, {StageMember::ring, 0}, {StageMember::sun, 100});
  BOOST_TEST(reducer[StageMember::carrier] == 25.0, close);
  const auto solar = member_speeds(24, 72, {StageMember::ring, 100}, {StageMember::sun, 0});
  BOOST_TEST(solar[StageMember::carrier] == 75.0, close);
  const auto star = member_speeds(24, 72, {StageMember::carrier, 0}, {StageMember::sun, 90});
  BOOST_TEST(star[StageMember::ring] == -30.0, close);
  BOOST_CHECK_THROW((void)member_speeds(24, 72, {StageMember::ring, 0}, {StageMember::ring, 1}),
                    annulus::GeometryError);
}

// Whatever turns: torques are in equilibrium, nothing is lost, and turning all members alike changes no relative speed.
BOOST_AUTO_TEST_CASE(torques_and_powers_add_up_to_nothing) {
  for (const auto given : members) {
    PowerFlow flow{member_speeds(19, 56, {StageMember::sun, 47.3}, {StageMember::ring, -11.9}),
                   member_torques(19, 56, given, 1234.5)};
    BOOST_TEST(flow.torque[given] == 1234.5, boost::test_tools::tolerance(rounding));
    double torque = 0, power = 0, size = 0;
    for (const auto member : members) {
      torque += flow.torque[member];
      power += flow.power(member);
      size = std::max(size, std::abs(flow.power(member)));
    }
    BOOST_TEST(std::abs(torque) <= rounding * 1e4);
    BOOST_TEST(std::abs(power) <= 10 * rounding * size);
  }
  const auto turned = member_speeds(19, 56, {StageMember::sun, 47.3 + 5}, {StageMember::ring, -11.9 + 5}),
             before = member_speeds(19, 56, {StageMember::sun, 47.3}, {StageMember::ring, -11.9});
  BOOST_TEST(turned[StageMember::carrier] == before[StageMember::carrier] + 5, boost::test_tools::tolerance(rounding));
}

BOOST_AUTO_TEST_SUITE_END()
