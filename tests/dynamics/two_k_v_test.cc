#include "dynamics/systems/two_k_v/two_k_v.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/errors.h"
#include "core/floating_point.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/systems/two_k_v/two_k_v_modes.h"
#include "dynamics/time_integration/integrate.h"
#include "tests/dynamics/two_k_v_stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(two_k_v)

using namespace annulus::dynamics;

TwoKVStage free_reducer(double crank_angle) {
  auto stage = stages::reducer();
  stage.output_support = 0;
  stage.crank_angle = crank_angle;
  return stage;
}

Eigen::MatrixXd stiffness_of(const TwoKVStage& stage) {
  const auto system = assemble(stage);
  return stiffness_with_meshes(system, mesh_stiffness(stage));
}

/// V of [QiFangLi2004, eq. (6)], corrected, with all base values, q = [th_i, th_s, th_p1, th_p2, th_h1, th_h2, th_a1,
/// th_a2, th_o, X_p1, X_p2, X_a1, X_a2].
double potential(const Eigen::VectorXd& q, double crank_angle) {
  const double pi = std::numbers::pi, alpha = 20 * pi / 180, m = 1e-3, a = 0.9e-3;
  const double r_bs = m * 10 / 2 * std::cos(alpha), r_bp = m * 34 / 2 * std::cos(alpha), r_c = m * 44 / 2;
  const auto square = [](double x) { return x * x; };
  double v = 0.5 * 536 * square(q[0] - q[1]);
  for (int i = 0; i < 2; ++i) {
    v += 0.5 * 1.4e8 * square(r_bs * q[1] + r_bp * q[2 + i] - q[9 + i] * std::cos(alpha));
    v += 0.5 * 3141 * square(q[2 + i] - q[4 + i]);
    v += 0.5 * 1.5e8 * square(q[9 + i] - r_c * q[8]);
    const Eigen::Vector2d t(-std::sin(pi * (i + 1)), std::cos(pi * (i + 1)));
    for (int j = 0; j < 2; ++j) {
      const double turned = crank_angle + pi * (j + 1);
      const Eigen::Vector2d direction(-std::sin(turned), std::cos(turned));
      v += 0.5 * 1.5e8 * ((q[11 + j] - a * q[4 + i]) * direction + (r_c * q[6 + j] - q[9 + i]) * t).squaredNorm();
    }
  }
  for (int j = 0; j < 2; ++j) v += 0.5 * 7.5e8 * square(q[11 + j] + a * 29 * q[6 + j]);
  return v;
}

// Dampers of single parts are in the ratio of their damping ratios.
BOOST_AUTO_TEST_CASE(damping_of_single_parts) {
  auto stage = stages::reducer();
  stage.input_support = 20;
  stage.output_support = 1e5;
  stage.support_damping_ratio = 0.05;
  auto own = stage;
  own.input_damping_ratio = 0.1;
  own.crank_shaft_damping_ratio = 0.15;
  own.crank_bearing_damping_ratio = 0.2;
  own.arc_bearing_damping_ratio = 0.25;
  own.output_damping_ratio = 0.3;
  const auto usual = assemble(stage), changed = assemble(own);
  int compared = 0;
  for (std::size_t i = 0; i < usual.springs().size(); ++i) {
    const auto &a = usual.springs()[i], &b = changed.springs()[i];
    const double times = a.name.starts_with("input")    ? 2
                         : a.name.ends_with("_shaft")   ? 3
                         : a.name.ends_with("_bearing") ? 4
                                                        : 6;
    BOOST_TEST(std::abs(b.damping - times * a.damping) <= 1e-12 * b.damping, a.name);
    ++compared;
  }
  BOOST_TEST(compared == 2 + 2 + 2 + 1);
  for (std::size_t m = 0; m < usual.meshes().size(); ++m) {
    const auto &a = usual.meshes()[m], &b = changed.meshes()[m];
    const double times = a.name.starts_with("crank") ? 5 : 1;
    BOOST_TEST(std::abs(b.damping - times * a.damping) <= 1e-12 * b.damping, a.name);
  }
}

BOOST_AUTO_TEST_CASE(ratio_follows_from_the_teeth) {
  annulus::test::Verification record("Kinematics of the published 2K-V reducer",
                                     "Willis for the sun against the carrier; pins met by the turning eccentric");
  const auto stage = stages::reducer();
  record.near("ratio", "", stage.ratio(), 103.0, 0, "exact");
  record.near("crank frequency: 30 turns per turn of the output", "Hz", stage.crank_frequency(), 15, 1e-12, "rounding");
  BOOST_TEST(std::abs(stage.sun_mesh_frequency() - 510) <= 1e-10);
  BOOST_TEST(std::abs(stage.arc_mesh_frequency() - 435) <= 1e-10);
  // Willis for the sun against the carrier, and pins met by the turning eccentric: the same frequencies another way.
  const double turns = 0.5;
  record.near("mesh frequency of the sun", "Hz", stage.sun_mesh_frequency(), 10 * (103 - 1) * turns, 1e-10, "rounding");
  record.near("mesh frequency of the arc gears", "Hz", stage.arc_mesh_frequency(), 30 * 29 * turns, 1e-10, "rounding");
}

BOOST_AUTO_TEST_CASE(motion_without_deformation_costs_nothing) {
  annulus::test::Verification record("Motion of 2K-V reducers without deformation", "kinematics: it costs no energy");
  for (const auto& [sun, planet, arc, cranks, gears] :
       {std::tuple{10, 34, 29, 2, 2}, std::tuple{12, 30, 39, 3, 2}, std::tuple{9, 41, 18, 3, 3}}) {
    for (const double angle : {0.0, 0.7, 2.9, -4.0}) {
      auto stage = free_reducer(angle);
      stage.sun_teeth = sun;
      stage.planet_teeth = planet;
      stage.arc_teeth = arc;
      stage.pins = arc + 1;
      stage.cranks = cranks;
      stage.arc_gears = gears;
      const auto system = assemble(stage);
      const Eigen::VectorXd motion = rigid_motion(stage, system);
      const Eigen::MatrixXd k = stiffness_of(stage);
      // Rounding of the largest terms, k (103 r_bs)^2 and the like.
      record.at_most("largest force over largest stiffness x motion", "",
                     (k * motion).cwiseAbs().maxCoeff() / (k.cwiseAbs().maxCoeff() * motion.cwiseAbs().maxCoeff()),
                     1e-13, "rounding of the largest terms");
      BOOST_TEST(system.dofs() == 3 + 3 * cranks + 2 * gears);
      BOOST_TEST((k - k.transpose()).cwiseAbs().maxCoeff() <= 1e-15 * k.cwiseAbs().maxCoeff());
      const auto found = annulus::dynamics::modes(stage);
      BOOST_TEST(found.modes[0].frequency == 0.0);
      BOOST_TEST(found.modes[1].frequency > 100.0);
      // The load is in balance: it does no work on this motion.
      BOOST_TEST(std::abs(system.load().dot(motion)) <= 1e-13 * 58);
    }
  }
}

BOOST_AUTO_TEST_CASE(stiffness_is_the_hessian_of_the_potential) {
  annulus::test::Verification record("Stiffness matrix of the 2K-V reducer",
                                     "second differences of the potential energy, written down apart from the code");
  for (const double angle : {0.0, 0.4, 1.9, 5.0}) {
    const auto stage = free_reducer(angle);
    const auto system = assemble(stage);
    const Eigen::VectorXd radii = dof_radii(stage, system);
    const Eigen::MatrixXd k = radii.asDiagonal() * stiffness_of(stage) * radii.asDiagonal();
    BOOST_REQUIRE(k.rows() == 13);
    for (int i = 0; i < 13; ++i)
      for (int j = 0; j < 13; ++j) {
        const auto at = [&](double x, double y) {
          Eigen::VectorXd q = Eigen::VectorXd::Zero(13);
          q[i] += x;
          q[j] += y;
          return potential(q, angle);
        };
        // V is quadratic: differences of any step are exact but for rounding.
        const double hessian = (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / 4;
        record.near("entry of the matrix, rotations in rad", "N m", k(i, j), hessian,
                    1e-13 * (at(1, 1) + at(1, -1) + 1), "rounding: the potential is quadratic");
      }
  }
}

BOOST_AUTO_TEST_CASE(turning_vectors_agree_with_the_frozen_ones) {
  annulus::test::Verification record("Mesh vectors that turn with the crank",
                                     "the stage assembled anew at the crank angle of the instant");
  auto stage = free_reducer(0.3);
  stage.sun_mesh = HarmonicStiffness{1.4e8, 0.2, 0.1};
  stage.arc_mesh = HarmonicStiffness{7.5e8, 0.1, 0};
  const auto moving = assemble(stage);
  auto workspace = moving.workspace();
  for (const double time : {0.0, 0.004, 0.02, 0.0663}) {
    auto frozen_stage = stage;
    frozen_stage.crank_angle += stage.crank_rate() * time;
    const auto frozen = assemble(frozen_stage);
    moving.evaluate_excitation(time, workspace);
    const Eigen::VectorXd at_position = mesh_stiffness(frozen_stage, FrozenStiffness::at_position);
    for (int m = 0; m < 12; ++m) {
      record.at_most("mesh vectors, largest difference", "",
                     (moving.mesh_vector(m, time) - frozen.mesh_vector(m)).cwiseAbs().maxCoeff(), 1e-13, "rounding");
      record.close("stiffness of a mesh", "N/m", workspace.stiffness[m], at_position[m], 1e-11,
                   "rounding of the phase");
    }
  }
}

// Where teeth and pins really are, from the absolute angles of the bodies at the crank angle: the output at -Theta/z_b,
// the sun at the ratio times that, the eccentricity of gear j at Theta_j past the carrier.
BOOST_AUTO_TEST_CASE(mesh_phases_follow_the_bodies) {
  annulus::test::Verification record("Mesh phases of a 2K-V reducer",
                                     "places of teeth and pins from the absolute angles of the bodies");
  auto stage = free_reducer(0.9);
  stage.sun_teeth = 9;
  stage.cranks = stage.arc_gears = 3;
  const auto system = assemble(stage);
  const double two_pi = 2 * std::numbers::pi, output = -0.9 / 30, sun = stage.ratio() * output;
  const auto whole = [](double cycles) { return std::abs(cycles - std::round(cycles)); };
  for (int i = 0; i < 3; ++i) {
    const double phi = two_pi * (i + 1) / 3;
    record.at_most("sun mesh, difference to a whole number", "mesh cycles",
                   whole(system.meshes()[i].phase_offset - 9 * (sun - output - phi) / two_pi), 1e-12, "rounding");
    const double eccentric = output + 0.9 + phi;  // towards the pitch point, in the housing
    record.at_most("arc mesh, difference to a whole number", "mesh cycles",
                   whole(system.meshes()[3 + i].phase_offset + 30 * eccentric / two_pi), 1e-12, "rounding");
  }
}

BOOST_AUTO_TEST_CASE(static_equilibrium) {
  annulus::test::Verification record("Static equilibrium of the 2K-V reducer under 58 N m",
                                     "statics: forces from the ratio; wind-up = torque over torsional stiffness");
  const auto held = stages::reducer();
  const auto system = assemble(held);
  StaticSolver solver(system);
  auto workspace = system.workspace();
  const Eigen::VectorXd radii = dof_radii(held, system);
  const double stiffness = torsional_stiffness(held, 1).from_input[0];
  for (const double time : {0.0, 0.01, 0.033}) {
    const Eigen::VectorXd q = solver.solve(time, workspace);
    double reaction = 0;  // of the crank bearings on the held carrier
    for (const char* name : {"planet1_x", "planet2_x"}) reaction += 1.5e8 * q[system.find(name)] * 22e-3;
    record.near("torque of the crank bearings", "N m", reaction, 58, 1e-9 * 58, "rounding of the solve");
    for (int m = 0; m < 2; ++m) {
      record.near("sun mesh force", "N", workspace.force[m], held.mean_sun_mesh_force(),
                  1e-9 * held.mean_sun_mesh_force(), "rounding of the solve");
      record.near("arc mesh force", "N", workspace.force[2 + m], held.mean_arc_mesh_force(),
                  1e-9 * held.mean_arc_mesh_force(), "rounding of the solve");
    }
    const double wind_up = q[0] / radii[0];
    record.near("wind-up of the input", "rad", wind_up, 58.0 / 103 / stiffness, 1e-9 * wind_up,
                "rounding of the solve");
  }
  // Free at both ends: the same forces.
  auto both_free = held;
  both_free.output_support = 0;
  const auto free_system = assemble(both_free);
  StaticSolver free_solver(free_system);
  auto free_workspace = free_system.workspace();
  (void)free_solver.solve(0.01, free_workspace);
  BOOST_TEST(std::abs(free_workspace.force[2] - held.mean_arc_mesh_force()) <= 1e-9 * held.mean_arc_mesh_force());
}

// Without speed the vectors stand still and nothing supplies energy: it stays. With the crank turning, the prescribed
// turn of the directions does work, b'(t)^T q F: the energy changes by just what power() books.
BOOST_AUTO_TEST_CASE(energy_of_free_vibration) {
  annulus::test::Verification record("Free vibration of the 2K-V reducer, standing and turning",
                                     "first law: change of energy = work of the turning vectors");
  for (const double speed : {0.0, 30.0}) {  // rad/s of the output; 30: a crank turn in 7 ms
    auto stage = stages::reducer();
    stage.output_torque = 0;
    stage.output_speed = speed;
    const auto system = assemble(stage);
    SystemState state;
    state.q = Eigen::VectorXd::Zero(system.dofs());
    state.v = state.q;
    for (int i = 0; i < system.dofs(); ++i) state.v[i] = 1e-2 * std::cos(3.0 * i);
    auto workspace = system.workspace();
    const auto energy = [&] {
      Eigen::VectorXd y(2 * system.dofs());
      y << state.q, state.v;
      return system.energy(state.time, y.data(), workspace);
    };
    IntegratorOptions options;
    options.relative_tolerance = 1e-9;
    options.absolute_tolerance = 1e-15;
    options.method = Integrator::arkode_explicit;
    const double before = energy();
    integrate(system, state, 5e-3, options, workspace, {.energy = EnergyTracking::on});
    const double after = energy();
    // The integrator's error over some 150 periods of the highest mode, and of the energies that follow its steps.
    record.near("change of energy over the energy", "", (after - before) / before, state.supplied / before, 2e-6,
                "integrator over 150 periods of the highest mode");
    BOOST_TEST(state.dissipated == 0.0);
    if (speed == 0)
      BOOST_TEST(state.supplied == 0.0);
    else
      BOOST_TEST(std::abs(after - before) > 1e-4 * before);
  }
}

BOOST_AUTO_TEST_CASE(bad_input_is_refused) {
  const annulus::UntrappedFloatingPoint untrapped;  // values that are no numbers
  const auto refused = [](auto change) {
    auto stage = stages::reducer();
    change(stage);
    BOOST_CHECK_THROW((void)assemble(stage), annulus::InputError);
  };
  refused([](auto& s) { s.pins = 29; });
  refused([](auto& s) { s.sun_teeth = 0; });
  refused([](auto& s) { s.cranks = 0; });
  refused([](auto& s) { s.module = 0; });
  refused([](auto& s) { s.eccentricity = -1e-3; });
  refused([](auto& s) { s.pressure_angle = 2; });
  refused([](auto& s) { s.crank_inertia = 0; });
  refused([](auto& s) { s.arc_bearing = std::nan(""); });
  refused([](auto& s) { s.arc_mesh = ConstantStiffness{0}; });
  refused([](auto& s) { s.output_support = -1; });
  refused([](auto& s) { s.mesh_damping_ratio = rigid; });
  refused([](auto& s) { s.arc_half_backlash = -1e-6; });
  refused([](auto& s) { s.output_speed = -1; });
}

BOOST_AUTO_TEST_SUITE_END()
