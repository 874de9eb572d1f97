#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/errors.h"
#include "dynamics/systems/planetary/response.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(quasi_static_load_sharing)

using namespace annulus::dynamics;

PlanetaryStage all_centres_held() {
  auto stage = stages::ring_paper();
  stage.sun.support = stage.ring.support = stage.carrier.support = rigid;
  stage.ring.torsional_support = rigid;
  stage.sun_mesh = ConstantStiffness{1.364e9};
  stage.ring_mesh = ConstantStiffness{1.87e9};
  return stage;
}

// With all centres held each planet is a spring between the turning sun and carrier:
//   F_n = F_bar + K (eps_bar - eps_n), eps = e_s + e_r,
//   1/K = 1/k_sp + 1/k_rp + [(cos a_s + cos a_r)^2 + (sin a_s - sin a_r)^2]/k_p.
BOOST_AUTO_TEST_CASE(all_centres_held_closed_form) {
  annulus::test::Verification record("Quasi-static load sharing with all centres held",
                                     "closed form: F_n = F + K (mean error - error_n), 1/K = 1/k_sp + 1/k_rp + [(cos "
                                     "a_s + cos a_r)^2 + (sin a_s - sin "
                                     "a_r)^2]/k_p");
  const auto stage = all_centres_held();
  const double as = stage.sun_working_angle, ar = stage.ring_working_angle;
  const double lever = std::pow(std::cos(as) + std::cos(ar), 2) + std::pow(std::sin(as) - std::sin(ar), 2);
  const double path = 1 / (1 / 1.364e9 + 1 / 1.87e9 + lever / 1e9);
  const double mean = stage.mean_mesh_force();
  const int per_cycle = 4;
  const auto found = quasi_static(stage, per_cycle);
  BOOST_REQUIRE(found.sun_force.cols() == 55 * per_cycle);
  double sharing = 0;
  annulus::test::RecordedPlot plot{"Sun mesh forces", "mesh cycles", "kN", {}};
  for (int n = 0; n < 5; ++n) plot.curves.push_back({"planet " + std::to_string(n + 1), {}, {}, {}});
  for (int i = 0; i < found.sun_force.cols(); ++i) {
    const double t = i / (per_cycle * stage.mesh_frequency());
    Eigen::VectorXd error(5);
    for (int n = 0; n < 5; ++n) error[n] = sun_mesh_error(stage, n, t).value + ring_mesh_error(stage, n, t).value;
    const Eigen::VectorXd force = mean + path * (error.mean() - error.array());
    sharing = std::max(sharing, 1 + path * (error.mean() - error.minCoeff()) / mean);
    // A direct solve; condition (1e10 against 1e9, rigid motion held) leaves far better than 1e-10.
    for (int n = 0; n < 5; ++n) {
      const char* origin = "condition of a direct solve";
      record.near("sun mesh force", "N", found.sun_force(n, i), force[n], 1e-10 * mean, origin);
      record.near("ring mesh force", "N", found.ring_force(n, i), force[n], 1e-10 * mean, origin);
      if (i % 4 > 0) continue;
      plot.curves[n].x.push_back(static_cast<double>(i) / per_cycle);
      plot.curves[n].computed.push_back(found.sun_force(n, i) * 1e-3);
      plot.curves[n].reference.push_back(force[n] * 1e-3);
    }
  }
  record.near("load sharing coefficient", "", load_sharing_instantaneous(found.sun_force), sharing, 1e-10,
              "condition of a direct solve");
  record.plot(plot);
  BOOST_TEST(sharing > 1.1);  // these errors matter
}

BOOST_AUTO_TEST_CASE(a_floating_sun_shares_equally_among_three_planets) {
  annulus::test::Verification record("A floating sun between three planets with errors",
                                     "statics: three forces at equal angles that balance a torque are equal");
  auto stage = all_centres_held();
  stage.planet_angles = {0, 2 * std::numbers::pi / 3, 4 * std::numbers::pi / 3};
  stage.planet_errors.resize(3);
  stage.sun_phase_lag = stage.ring_phase_lag = stage.ring_tooth_offset = {};
  BOOST_TEST(load_sharing_instantaneous(quasi_static(stage, 2).sun_force) > 1.05);
  stage.sun.support = 0;
  const auto found = quasi_static(stage, 2);
  // Three forces in equilibrium with a torque, at equal angles: equal whatever the errors. Rounding of the solve.
  record.near("load sharing coefficient, sun meshes", "", load_sharing_instantaneous(found.sun_force), 1, 1e-10,
              "rounding of the solve");
  record.near("load sharing coefficient, ring meshes", "", load_sharing_instantaneous(found.ring_force), 1, 1e-10,
              "rounding of the solve");
}

// Equilibrium of the sun alone: three forces along lines of action turned with their planets, sum F_n exp(i phi_n) = 0,
// whatever errors and stiffness.
BOOST_AUTO_TEST_CASE(a_floating_sun_shares_among_three_unequally_spaced_planets_by_their_angles) {
  annulus::test::Verification record("A floating sun between three unequally spaced planets with errors",
                                     "statics: F_1 : F_2 : F_3 = sin(phi_3 - phi_2) : sin(phi_1 - phi_3) : sin(phi_2 - "
                                     "phi_1)");
  auto stage = all_centres_held();
  const std::vector<double> phi = {0, 100 * annulus::units::deg, 220 * annulus::units::deg};
  stage.planet_angles = phi;
  stage.planet_errors.resize(3);
  stage.sun_phase_lag = stage.ring_phase_lag = stage.ring_tooth_offset = {};
  stage.sun.support = 0;
  const auto found = quasi_static(stage, 2);
  const Eigen::Vector3d share(std::sin(phi[2] - phi[1]), std::sin(phi[0] - phi[2]), std::sin(phi[1] - phi[0]));
  const double all = stage.sun_torque / stage.sun.radius;
  for (Eigen::Index i = 0; i < found.sun_force.cols(); ++i)
    for (Eigen::Index n = 0; n < 3; ++n)
      record.near("sun mesh force of planet " + std::to_string(n + 1), "N", found.sun_force(n, i),
                  all * share[n] / share.sum(), 1e-10 * all, "condition of a direct solve");
}

BOOST_AUTO_TEST_CASE(forces_balance_in_every_position) {
  annulus::test::Verification record("Balance of the mesh forces in every position", "statics: torques in equilibrium");
  const auto stage = stages::ring_paper();
  const auto found = quasi_static(stage, 3);
  for (int i = 0; i < found.sun_force.cols(); ++i) {
    record.near("torque of the sun mesh forces over the load", "",
                found.sun_force.col(i).sum() * stage.sun.radius / stage.sun_torque, 1, 1e-10, "rounding of the solve");
    // No torque on a planet: both its meshes carry the same.
    record.at_most("sun mesh against ring mesh force of a planet, over the mean force", "",
                   (found.sun_force.col(i) - found.ring_force.col(i)).cwiseAbs().maxCoeff() / stage.mean_mesh_force(),
                   1e-10, "rounding of the solve");
  }
}

BOOST_AUTO_TEST_CASE(light_load_leaves_planets_idle) {
  annulus::test::Verification record("A light load beside large errors",
                                     "nobody pulls, and the rest carries the torque");
  auto stage = all_centres_held();
  stage.sun_torque *= 0.02;
  stage.set_half_backlash(200e-6);  // more than the errors: no back touches
  const auto found = quasi_static(stage, 2);
  int idle = 0;
  for (int i = 0; i < found.sun_force.cols(); ++i) {
    // Not the closed form any more: nobody pulls, the rest carries the torque. An idle planet is kept in place by a
    // billionth of the stiffness: 1.9e9 x 1e-9 x 2e-4 m = 4e-4 N.
    record.at_least("least force of a planet", "N", found.sun_force.col(i).minCoeff(), -1e-3,
                    "a billionth of the stiffness keeps idle planets in place");
    record.at_most("sum of the forces over the load - 1", "",
                   std::abs(found.sun_force.col(i).sum() / (5 * stage.mean_mesh_force()) - 1), 1e-6,
                   "rounding of the solve");
    idle += static_cast<int>((found.sun_force.col(i).array() < 1e-3).count());
  }
  BOOST_TEST(idle > 100);
}

BOOST_AUTO_TEST_CASE(an_unbalanced_load_is_refused) {
  auto stage = stages::ring_paper();
  stage.ring.torsional_support = 0;
  BOOST_CHECK_THROW((void)quasi_static(stage), annulus::InputError);
  stage = stages::ring_paper();
  stage.carrier_speed = 0;
  BOOST_CHECK_THROW((void)quasi_static(stage), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
