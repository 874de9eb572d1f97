#include "dynamics/systems/planetary/planetary_stage.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/errors.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/system/lumped_system.h"
#include "geometry/planetary.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(planetary_stage)

using namespace annulus::dynamics;

/// Sets the coordinates named body_x and body_y to a vector given in the carrier frame, turned by -angle.
void displace(const LumpedSystem& system, Eigen::VectorXd& q, const std::string& body, double amount, double direction,
              double angle) {
  q[system.find(body + "_x")] += amount * std::cos(direction - angle);
  q[system.find(body + "_y")] += amount * std::sin(direction - angle);
}

BOOST_AUTO_TEST_CASE(base_scene_agrees_with_the_printed_numbers) {
  annulus::test::Verification record("Operating point of the planetary stage of the ring paper",
                                     "gear and stage data of Hu et al. 2021 (docs/ring_types.md), calculated by hand");
  const auto stage = stages::ring_paper();
  const char* digits = "half of the last digit";
  record.near("working pressure angle of the sun mesh", "deg", stage.sun_working_angle / annulus::units::deg, 25.905,
              5e-4, digits);
  record.near("working pressure angle of the ring mesh", "deg", stage.ring_working_angle / annulus::units::deg, 20.860,
              5e-4, digits);
  record.near("mesh frequency", "Hz", stage.mesh_frequency(), 696.1, 0.05, digits);
  record.near("mean mesh force", "N", stage.mean_mesh_force(), 59.46e3, 5, digits);
  record.near("torque of the sun", "N m", stage.sun_torque, 25048, 0.5, digits);
  record.near("torque of the carrier", "N m", stage.carrier_torque(), 25048 * 210.0 / 48, 2.2, digits);
  BOOST_TEST(stage.error_period() == 55);
}

BOOST_AUTO_TEST_CASE(kinematics_come_from_the_gears) {
  const auto gear = [](annulus::geometry::GearKind kind, int teeth, double shift) {
    annulus::geometry::GearParameters p;
    p.kind = kind;
    p.teeth = teeth;
    p.module = 3.8e-3;
    p.pressure_angle = 22.5 * annulus::units::deg;
    p.profile_shift = shift;
    p.face_width = 0.088;
    return annulus::geometry::Gear(p);
  };
  using annulus::geometry::GearKind;
  const annulus::geometry::PlanetarySet set(gear(GearKind::external, 48, 0.7608), gear(GearKind::external, 55, 0.7361),
                                            gear(GearKind::internal, 162, 0.1516), 0.201, 5);
  const auto expected = stages::ring_paper();
  auto stage = expected;
  stage.sun_teeth = stage.planet_teeth = stage.ring_teeth = 0;
  for (auto* list : {&stage.planet_angles, &stage.sun_phase_lag, &stage.ring_phase_lag, &stage.ring_tooth_offset})
    list->assign(3, -1);  // to be replaced
  for (auto* value : {&stage.sun.radius, &stage.planet.radius, &stage.ring.radius, &stage.carrier.radius,
                      &stage.sun_working_angle, &stage.ring_working_angle})
    *value = 0;
  set_kinematics(stage, set);
  BOOST_CHECK_NO_THROW(stage.check());
  BOOST_TEST(stage.sun_teeth == 48);
  BOOST_TEST(stage.planet_teeth == 55);
  BOOST_TEST(stage.ring_teeth == 162);
  const double rounding = 1e-14;
  BOOST_TEST(std::abs(stage.sun.radius - expected.sun.radius) <= rounding);
  BOOST_TEST(std::abs(stage.planet.radius - expected.planet.radius) <= rounding);
  BOOST_TEST(std::abs(stage.ring.radius - expected.ring.radius) <= rounding);
  BOOST_TEST(stage.carrier.radius == 0.201);
  BOOST_TEST(std::abs(stage.sun_working_angle - expected.sun_working_angle) <= rounding);
  BOOST_TEST(std::abs(stage.ring_working_angle - expected.ring_working_angle) <= rounding);
  for (int n = 0; n < 5; ++n) {
    BOOST_TEST(std::abs(stage.planet_angles[n] - expected.planet_angles[n]) <= rounding);
    BOOST_TEST(stage.sun_phase_lag[n] == set.sun_phase_lag(n));
    BOOST_TEST(stage.ring_phase_lag[n] == set.ring_phase_lag(n));
    BOOST_TEST(stage.ring_tooth_offset[n] == set.ring_tooth_offset(n));
    // At time 0 planet n reads the ring n z_r / N teeth further than planet 0.
    const auto place = [&](int i) { return stage.ring_tooth_offset[i] - stage.ring_phase_lag[i]; };
    BOOST_TEST(std::abs(place(n) - place(0) - 162.0 * n / 5) <= 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(error_period_is_the_common_period) {
  auto stage = stages::ring_paper();
  for (auto& e : stage.planet_errors) e.eccentricity = {};
  BOOST_TEST(stage.error_period() == 1);  // pin position errors of planets stand still in the carrier frame
  stage.sun.errors.eccentricity.amount = 1e-6;
  BOOST_TEST(stage.error_period() == 48);
  stage.ring.errors.position.amount = 1e-6;
  BOOST_TEST(stage.error_period() == 16 * 3 * 27);  // lcm(48, 162)
  stage.sun.errors = {};
  stage.ring.errors = {};
  stage.ring_mesh = TableStiffness{annulus::PeriodicCurve(std::vector<double>(27 * 2, 1e9), 2),
                                   annulus::PeriodicCurve({1e9}, 1), annulus::PeriodicCurve({0.0}, 1), 0};
  BOOST_TEST(stage.error_period() == 27);
}

// The statement behind every sign of e: displacing a toothing acts on delta as displacing the body does.
BOOST_AUTO_TEST_CASE(errors_act_like_displacements_of_their_body) {
  const double wr = 1e-5;  // any amount; the relation is linear
  for (const double time : {0.0, 0.013, 1.7}) {
    for (int kind = 0; kind < 8; ++kind) {
      auto stage = stages::ring_paper();
      stage.planet_errors.assign(5, {});
      const double c = stage.carrier_speed, th = 0.7;
      BodyErrors errors;
      (kind % 2 ? errors.position : errors.eccentricity) = {wr, th};
      if (kind < 2) stage.planet_errors[3] = errors;
      if (kind / 2 == 1) stage.sun.errors = errors;
      if (kind / 2 == 2) stage.ring.errors = errors;
      if (kind / 2 == 3) stage.carrier.errors = errors;
      const auto system = assemble(stage);
      Eigen::VectorXd q = Eigen::VectorXd::Zero(system.dofs());
      const double phi = stage.planet_angles[3];
      // Directions seen from the carrier: the planet turns at -(z_r/z_p) Omega, the sun at (z_r/z_s) Omega, the ring
      // and the housing at -Omega.
      switch (kind) {
        case 0:
          displace(system, q, "planet4", wr, phi + th - c * 162 / 55 * time, phi);
          break;
        case 1:
          displace(system, q, "planet4", wr, th, phi);
          break;
        case 2:
          displace(system, q, "sun", wr, th + c * 162 / 48 * time, 0);
          break;
        case 3:
          displace(system, q, "sun", wr, th - c * time, 0);
          break;
        case 4:
        case 5:
          displace(system, q, "ring", wr, th - c * time, 0);
          break;
        default:
          for (int n = 0; n < 5; ++n)
            displace(system, q, "planet" + std::to_string(n + 1), wr, th - (kind == 7 ? c * time : 0.0),
                     stage.planet_angles[n]);
      }
      for (int n = 0; n < 5; ++n) {
        // Rounding of angles up to 200 rad.
        BOOST_TEST(std::abs(system.mesh_vector(n).dot(q) + sun_mesh_error(stage, n, time).value) <= 1e-12 * wr);
        BOOST_TEST(std::abs(system.mesh_vector(5 + n).dot(q) + ring_mesh_error(stage, n, time).value) <= 1e-12 * wr);
      }
      const bool sun_only = kind / 2 == 1, ring_only = kind / 2 == 2;
      BOOST_TEST((std::abs(sun_mesh_error(stage, 3, time).value) > 1e-8) == !ring_only);
      BOOST_TEST((std::abs(ring_mesh_error(stage, 3, time).value) > 1e-8) == !sun_only);
    }
  }
}

BOOST_AUTO_TEST_CASE(error_rates_are_derivatives) {
  auto stage = stages::ring_paper();
  stage.sun.errors = {{2e-5, 0.3}, {1e-5, 1.1}};
  stage.ring.errors = {{3e-5, -0.4}, {2e-5, 2.0}};
  stage.carrier.errors = {{1e-5, 0.2}, {4e-5, -1.0}};
  const auto system = assemble(stage);
  auto workspace = system.workspace();
  for (int n = 0; n < 5; ++n)
    for (const double t : {0.0, 0.37}) {
      const double h = 1e-5;  // difference error h^2 w^3/6 e = 1e-10 x 8e5/6 x 1e-4 at w = 91 rad/s, rounding 1e-15
      const auto sun = sun_mesh_error(stage, n, t), ring = ring_mesh_error(stage, n, t);
      const double sun_rate = (sun_mesh_error(stage, n, t + h).value - sun_mesh_error(stage, n, t - h).value) / (2 * h);
      const double ring_rate =
          (ring_mesh_error(stage, n, t + h).value - ring_mesh_error(stage, n, t - h).value) / (2 * h);
      BOOST_TEST(std::abs(sun.rate - sun_rate) <= 5e-9);
      BOOST_TEST(std::abs(ring.rate - ring_rate) <= 5e-9);
      BOOST_TEST(std::abs(sun.rate) > 1e-5);
      // The assembled system evaluates the same errors by shared sines.
      system.evaluate_excitation(t, workspace);
      BOOST_TEST(std::abs(workspace.error[n] - sun.value) <= 1e-18);
      BOOST_TEST(std::abs(workspace.error_rate[5 + n] - ring.rate) <= 1e-16);
    }
}

BOOST_AUTO_TEST_CASE(rigid_rotation_costs_nothing_at_any_speed) {
  for (const double speed : {0.0, 27.0, 500.0}) {
    auto stage = stages::ring_paper();
    stage.carrier_speed = speed;
    stage.sun_torque = 0;
    const auto system = assemble(stage);
    Eigen::VectorXd turn = Eigen::VectorXd::Zero(system.dofs());
    const double cs = std::cos(stage.sun_working_angle), cr = std::cos(stage.ring_working_angle);
    turn[system.find("carrier_u")] = 1;
    turn[system.find("sun_u")] = cs + cr;
    for (int n = 1; n <= 5; ++n) {
      turn[system.find("planet" + std::to_string(n) + "_y")] = 1;
      turn[system.find("planet" + std::to_string(n) + "_u")] = -cr;
    }
    for (int m = 0; m < 10; ++m) BOOST_TEST(std::abs(system.mesh_vector(m).dot(turn)) <= 1e-15);
    // Forces, not only their work, vanish; stiffnesses are 1e9 N/m, so 1e-15 of that.
    BOOST_TEST((system.stiffness() * turn).cwiseAbs().maxCoeff() <= 1e-6);
    BOOST_TEST((system.rotating_stiffness() * turn).cwiseAbs().maxCoeff() <= 1e-15 * 5 * 8.51 * speed * speed);
  }
}

BOOST_AUTO_TEST_CASE(load_is_balanced_and_agrees_with_the_tooth_ratio) {
  const auto stage = stages::ring_paper();
  const auto system = assemble(stage);
  const double carrier = -system.load()[system.find("carrier_u")] * stage.carrier.radius;
  BOOST_TEST(std::abs(carrier / stage.carrier_torque() - 1) <= 1e-14);
  BOOST_TEST(system.load().cwiseAbs().sum() ==
             std::abs(system.load()[system.find("sun_u")]) + std::abs(system.load()[system.find("carrier_u")]));
}

BOOST_AUTO_TEST_CASE(mesh_damping_follows_its_formula) {
  auto stage = stages::ring_paper();
  const auto expected = [](double k, double r1, double i1, double r2, double i2) {
    return 2 * 0.07 * std::sqrt(k * i1 * i2 / (i1 * r2 * r2 + i2 * r1 * r1));  // (31), (34)
  };
  const auto system = assemble(stage);
  const auto& p = stage.planet;
  BOOST_TEST(std::abs(system.meshes()[0].damping /
                          expected(1.364e9, stage.sun.radius, stage.sun.inertia, p.radius, p.inertia) -
                      1) <= 1e-14);
  BOOST_TEST(std::abs(system.meshes()[9].damping /
                          expected(1.87e9, stage.ring.radius, stage.ring.inertia, p.radius, p.inertia) -
                      1) <= 1e-14);
  stage.ring.torsional_support = rigid;  // then only the planet's inertia is left
  const double alone = 2 * 0.07 * std::sqrt(1.87e9 * p.inertia) / p.radius;
  BOOST_TEST(std::abs(assemble(stage).meshes()[9].damping / alone - 1) <= 1e-14);
}

BOOST_AUTO_TEST_CASE(supports_and_bearings_are_damped_by_their_ratio) {
  const auto stage = stages::ring_paper();
  const auto system = assemble(stage);
  const auto diagonal = [&](const std::string& name) {
    const int i = system.find(name);
    return system.damping()(i, i);
  };
  BOOST_TEST(std::abs(diagonal("sun_x") / (2 * 0.03 * std::sqrt(1e7 * 66)) - 1) <= 1e-14);
  BOOST_TEST(std::abs(diagonal("planet3_y") / (2 * 0.03 * std::sqrt(1e9 * 8.51)) - 1) <= 1e-14);
  BOOST_TEST(diagonal("sun_u") == 0.0);
  const double ring_mass = stage.ring.inertia / std::pow(stage.ring.radius, 2);
  BOOST_TEST(std::abs(diagonal("ring_u") / (2 * 0.03 * std::sqrt(1e10 * ring_mass)) - 1) <= 1e-14);
  // The dampers to the housing couple x and y through the speed, the planet bearings do not.
  const int x = system.find("sun_x"), y = system.find("sun_y");
  BOOST_TEST(std::abs(system.rotating_stiffness()(x, y) + stage.carrier_speed * diagonal("sun_x")) <= 1e-9);
  BOOST_TEST(system.rotating_stiffness()(system.find("planet1_x"), system.find("planet1_y")) == 0.0);
}

BOOST_AUTO_TEST_CASE(rigid_supports_drop_their_dofs) {
  auto stage = stages::ring_paper();
  BOOST_TEST(assemble(stage).dofs() == 9 + 15);
  stage.ring.support = stage.ring.torsional_support = rigid;
  BOOST_TEST(assemble(stage).find("ring_x") == -1);
  BOOST_TEST(assemble(stage).dofs() == 6 + 15);
  stage.planet_bearings.clear();
  BOOST_TEST(assemble(stage).dofs() == 6 + 5);
  stage.sun.support = stage.carrier.support = rigid;
  const auto torsional = assemble(stage);
  BOOST_TEST((torsional.names() == std::vector<std::string>{"sun_u", "carrier_u", "planet1_u", "planet2_u", "planet3_u",
                                                            "planet4_u", "planet5_u"}));
  // The planets ride on the carrier: their mass turns with it.
  const int c = torsional.find("carrier_u");
  const double alone = stage.carrier.inertia / (stage.carrier.radius * stage.carrier.radius);
  BOOST_TEST(std::abs(torsional.mass()(c, c) - alone - 5 * stage.planet.mass) <= 1e-12);
}

BOOST_AUTO_TEST_CASE(planets_on_unequal_bearings_share_as_the_stiffness_of_their_paths) {
  annulus::test::Verification record(
      "Load sharing of planets on unequal bearings, all axes held",
      "springs in series: two meshes, the bearing along the tangent with lever cos a_s + cos a_r and along the radius "
      "with sin a_s - sin a_r");
  auto stage = stages::ring_paper();
  stage.planet_errors.clear();
  stage.sun_mesh = ConstantStiffness{1.4e9};
  stage.ring_mesh = ConstantStiffness{1.9e9};
  stage.sun.support = stage.ring.support = stage.carrier.support = stage.ring.torsional_support = rigid;
  stage.planet_bearings = {{1e9, 2e9}, {3e8, 2e9}, {1e9, 4e8}, {rigid, 1e9}, {5e8, rigid}};
  const double as = stage.sun_working_angle, ar = stage.ring_working_angle;
  const double tangential = std::pow(std::cos(as) + std::cos(ar), 2), radial = std::pow(std::sin(as) - std::sin(ar), 2);
  std::vector<double> path;
  double all = 0;
  for (const auto& bearing : stage.planet_bearings) {
    path.push_back(1 / (1 / 1.4e9 + 1 / 1.9e9 + tangential / bearing.tangential + radial / bearing.radial));
    all += path.back();
  }
  const auto system = assemble(stage);
  BOOST_TEST(system.find("planet4_x") == -1);
  BOOST_TEST(system.find("planet5_y") == -1);
  auto workspace = system.workspace();
  (void)StaticSolver(system).solve(0, workspace);
  double off = 0;
  for (std::size_t n = 0; n < path.size(); ++n)
    for (const auto mesh : {n, n + path.size()})
      off = std::max(off, std::abs(workspace.force[mesh] / (5 * stage.mean_mesh_force() * path[n] / all) - 1));
  record.at_most("largest difference of a mesh force, relative", "", off, 1e-9, "rounding of equilibrium and meshes");
  BOOST_TEST(path[1] / path[2] > 1.2);  // unequal indeed
}

BOOST_AUTO_TEST_CASE(contradictions_are_refused) {
  const auto refused = [](const auto& change) {
    auto stage = stages::ring_paper();
    change(stage);
    try {
      stage.check();
    } catch (const annulus::InputError&) {
      return true;
    }
    return false;
  };
  BOOST_TEST(!refused([](auto&) {}));
  BOOST_TEST(refused([](auto& s) { s.sun.mass = 0; }));
  BOOST_TEST(refused([](auto& s) { s.planet.inertia = NAN; }));
  BOOST_TEST(refused([](auto& s) { s.sun.support = -1; }));
  BOOST_TEST(refused([](auto& s) { s.planet_errors.pop_back(); }));
  BOOST_TEST(refused([](auto& s) { s.planet_bearings = {{1e9, 1e9}, {1e9, 1e9}}; }));
  BOOST_TEST(refused([](auto& s) { s.planet_bearings = {{1e9, 0}}; }));
  BOOST_TEST(refused([](auto& s) { s.ring_phase_lag.push_back(0); }));
  BOOST_TEST(refused([](auto& s) { s.planet_angles.clear(); }));
  BOOST_TEST(refused([](auto& s) { s.sun_half_backlash = -1e-6; }));
  BOOST_TEST(refused([](auto& s) { s.ring_half_backlash = -1e-6; }));
  BOOST_TEST(refused([](auto& s) { s.sun_teeth = 0; }));
  BOOST_TEST(refused([](auto& s) { s.carrier.radius *= 1.01; }));  // torque ratio against the teeth
  BOOST_TEST(refused([](auto& s) { s.sun.torsional_support = rigid; }));
  BOOST_TEST(refused([](auto& s) { s.sun_mesh = ConstantStiffness{0}; }));
}

BOOST_AUTO_TEST_SUITE_END()
