#include <Eigen/Core>
#include <Eigen/Geometry>
#include <boost/math/tools/toms748_solve.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/units.h"
#include "dynamics/modes/modal_energy.h"
#include "dynamics/spatial/bearing_laws.h"
#include "dynamics/steady_state/periodic_response.h"
#include "tests/verification_record.h"

/// Bearings that act by their whole law in a lumped system.
BOOST_AUTO_TEST_SUITE(bearing_laws)

using namespace annulus::dynamics;
using Stiffness = LinearBearing::Stiffness;
namespace units = annulus::units;

namespace {

StageBearing ball_row() {
  StageBearing b;
  b.name = "balls";
  b.body = {StageBody::Kind::sun};
  b.row = RollingRow{.element = RollingRow::Element::ball,
                     .count = 14,
                     .diameter = 0.02,
                     .pitch_diameter = 0.12,
                     .contact_angle = 25 * units::deg,
                     .clearance = 8e-6};
  return b;
}

/// Five coordinates of unit mass in a bearing.
struct Held {
  LumpedSystem system;
  std::vector<LinearForm> motion;
};
Held held(const LinearBearing& bearing, double length) {
  LumpedSystemBuilder builder;
  Held result;
  for (const auto* name : {"x", "y", "z", "about_x", "about_y"}) {
    result.motion.push_back(builder.add_dof(name));
    builder.add_mass(result.motion.back(), 1);
  }
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < i; ++j) {  // k (a + b)^2 / 2 and -k a^2 / 2, -k b^2 / 2
      const double k = bearing.stiffness(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      builder.add_spring(result.motion[i] + result.motion[j], k, 0);
      builder.add_spring(result.motion[i], -k, 0);
      builder.add_spring(result.motion[j], -k, 0);
    }
  for (std::size_t i = 0; i < 5; ++i)
    builder.add_spring(result.motion[i], bearing.stiffness(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)),
                       0);
  add_bearing_law(builder, bearing, result.motion, length);
  result.system = builder.build();
  return result;
}

}  // namespace

// Whatever stiffness serves modes and dampers: the forces are those of the law, in its axes, and belong to the energy.
BOOST_AUTO_TEST_CASE(forces_are_those_of_the_law) {
  annulus::test::Verification record("Law of a bearing in a lumped system", "the law itself; derivative of the energy");
  const double axes = 0.4;
  LinearBearing bearing;
  bearing.name = "balls";
  bearing.body = {StageBody::Kind::sun};
  bearing.stiffness =
      Stiffness::Constant(1e5) + Stiffness(Eigen::Vector<double, 5>(2e8, 3e8, 1e8, 2e5, 4e5).asDiagonal());
  bearing.preload.setConstant(100);
  give_law(bearing, ball_row(), axes);
  SpaceSupports supports;
  supports.bearings = {bearing};
  BOOST_TEST(beside_law(supports, 0).preload.isZero(0));
  const auto [system, motion] = held(bearing, 0.05);
  Eigen::Vector<double, 10> y = Eigen::Vector<double, 10>::Zero();
  y.head<5>() << 25e-6, -12e-6, 30e-6, 2e-4, -1e-4;
  auto workspace = system.workspace();
  Eigen::Vector<double, 10> rate;
  system.rhs(0, y.data(), rate.data(), workspace);
  Stiffness turn = Stiffness::Identity();
  turn.topLeftCorner<2, 2>() = turn.bottomRightCorner<2, 2>() = Eigen::Rotation2Dd(-axes).toRotationMatrix();
  const auto law = law_of(*ball_row().row, Motions::in_space);
  const Eigen::Vector<double, 5> expected = turn.transpose() * law->at(turn * y.head<5>()).force;
  record.at_most("forces over the largest", "", (rate.tail<5>() + expected).cwiseAbs().maxCoeff() / expected.norm(),
                 1e-9, "rounding");
  const Eigen::VectorXd beyond = beyond_stiffness(bearing, y.head<5>());
  record.at_most("forces from the motion alone, over the largest", "",
                 (beyond - bearing.stiffness * y.head<5>() + expected).cwiseAbs().maxCoeff() / expected.norm(), 1e-9,
                 "rounding");
  for (Eigen::Index i = 0; i < 5; ++i) {
    const double step = i < 3 ? 1e-9 : 1e-8;
    Eigen::Vector<double, 10> up = y, down = y;
    up[i] += step;
    down[i] -= step;
    const double slope =
        (system.energy(0, up.data(), workspace) - system.energy(0, down.data(), workspace)) / (2 * step);
    record.near("derivative of the energy over the force", "", slope / expected[i], 1, 1e-5, "central differences");
  }
  Eigen::MatrixXd jacobian(10, 10);
  system.jacobian(0, y.data(), jacobian, workspace);
  for (Eigen::Index i = 0; i < 5; ++i) {
    const double step = i < 3 ? 1e-9 : 1e-8;
    Eigen::Vector<double, 10> up = y, down = y, above, below;
    up[i] += step;
    down[i] -= step;
    system.rhs(0, up.data(), above.data(), workspace);
    system.rhs(0, down.data(), below.data(), workspace);
    const Eigen::Vector<double, 5> column = (above - below).tail<5>() / (2 * step);
    record.at_most("tangent against differences of the forces, over its largest entry", "",
                   (column - jacobian.block<5, 1>(5, i)).norm() / column.norm(), 1e-5, "central differences");
  }
}

// A force that turns carries a body around in a clearance, on a circle on which spring, damper and inertia balance it.
BOOST_AUTO_TEST_CASE(whirl_in_a_clearance) {
  annulus::test::Verification record("Whirl in a bearing with clearance", "circle of a steady whirl in closed form");
  constexpr double k = 4e8, play = 30e-6, mass = 120, damping = 5e4, force = 8e3;
  StageBearing stop;
  stop.name = "stop";
  stop.body = {StageBody::Kind::sun};
  stop.x = stop.y = k;
  stop.play = play;
  stop.load_zone = false;
  LinearBearing bearing;
  bearing.name = stop.name;
  bearing.body = stop.body;
  bearing.stiffness(0, 0) = bearing.stiffness(1, 1) = 0.4 * k;
  give_law(bearing, stop);
  for (const double speed : {100.0, 400.0, 1200.0}) {
    LumpedSystemBuilder builder;
    const std::vector<LinearForm> motion{builder.add_dof("x"), builder.add_dof("y"), {}, {}, {}};
    for (const std::size_t i : {0U, 1U}) {
      builder.add_mass(motion[i], mass);
      builder.add_spring(motion[i], 0.4 * k, damping);
    }
    add_bearing_law(builder, bearing, motion, 1);
    builder.add_harmonic_load(motion[0], speed, force, 0);
    builder.add_harmonic_load(motion[1], speed, 0, force);
    const auto system = builder.build();
    BOOST_TEST(system.meshes().size() == 2U);  // along the axis and about it there is nothing
    // Modes have their energy in the springs.
    const auto tangents = mean_stiffnesses(system);
    const auto energy = modal_energy(system, tangents, modes(system, tangents));
    BOOST_TEST((energy.strain.colwise().sum().array() - 1).abs().maxCoeff() <= 1e-12);
    for (const auto& element : energy.elements) BOOST_TEST(element.find("law") == std::string::npos);
    PeriodicOptions options;
    options.tolerance = 1e-10;
    const auto found = periodic_response(system, 2 * std::numbers::pi / speed, 1, options);
    BOOST_TEST_REQUIRE(found.converged, found.trouble);
    const auto excess = [&](double r) {
      const double secant = k * (1 - play / r) - mass * speed * speed;
      return r * std::hypot(secant, damping * speed) - force;
    };
    std::uintmax_t iterations = 100;
    const auto [low, high] =
        boost::math::tools::toms748_solve(excess, play, 1.0, boost::math::tools::eps_tolerance<double>(45), iterations);
    for (Eigen::Index t = 0; t < found.displacement.cols(); ++t)
      record.close("radius of the whirl", "m", found.displacement.col(t).norm(), (low + high) / 2, 1e-6,
                   "1e-7 of the stiffness within the clearance");
  }
}

BOOST_AUTO_TEST_SUITE_END()
