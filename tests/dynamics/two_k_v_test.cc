#include "dynamics/two_k_v.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/errors.h"
#include "dynamics/integrate.h"
#include "dynamics/static_solver.h"
#include "dynamics/two_k_v_modes.h"
#include "dynamics/two_k_v_sensitivity.h"
#include "tests/dynamics/two_k_v_stages.h"

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

/// V of models.md D with all base values, q = [th_i, th_s, th_p1, th_p2, th_h1, th_h2, th_a1, th_a2, th_o, X_p1, X_p2,
/// X_a1, X_a2].
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

BOOST_AUTO_TEST_CASE(ratio_follows_from_the_teeth) {
  const auto stage = stages::reducer();
  BOOST_TEST(stage.ratio() == 103.0);
  BOOST_TEST(std::abs(stage.crank_frequency() - 15) <= 1e-12);  // 30 turns of the crank per turn of the output
  BOOST_TEST(std::abs(stage.sun_mesh_frequency() - 510) <= 1e-10);
  BOOST_TEST(std::abs(stage.arc_mesh_frequency() - 435) <= 1e-10);
  // Willis for the sun against the carrier, and pins met by the turning eccentric: the same frequencies another way.
  const double turns = 0.5;
  BOOST_TEST(std::abs(stage.sun_mesh_frequency() - 10 * (103 - 1) * turns) <= 1e-10);
  BOOST_TEST(std::abs(stage.arc_mesh_frequency() - 30 * 29 * turns) <= 1e-10);
}

BOOST_AUTO_TEST_CASE(motion_without_deformation_costs_nothing) {
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
      BOOST_TEST((k * motion).cwiseAbs().maxCoeff() <= 1e-13 * k.cwiseAbs().maxCoeff() * motion.cwiseAbs().maxCoeff());
      BOOST_TEST(system.freedoms() == 3 + 3 * cranks + 2 * gears);
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
  for (const double angle : {0.0, 0.4, 1.9, 5.0}) {
    const auto stage = free_reducer(angle);
    const auto system = assemble(stage);
    const Eigen::VectorXd radii = freedom_radii(stage, system);
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
        BOOST_TEST(std::abs(k(i, j) - hessian) <= 1e-13 * (at(1, 1) + at(1, -1) + 1));
      }
  }
}

BOOST_AUTO_TEST_CASE(turning_vectors_agree_with_the_frozen_ones) {
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
      BOOST_TEST((moving.mesh_vector(m, time) - frozen.mesh_vector(m)).cwiseAbs().maxCoeff() <= 1e-13);
      BOOST_TEST(std::abs(workspace.stiffness[m] - at_position[m]) <= 1e-11 * at_position[m]);
    }
  }
}

// Where teeth and pins really are, from the absolute angles of the bodies at the crank angle: the output at -Theta/z_b,
// the sun at the ratio times that, the eccentricity of gear j at Theta_j past the carrier.
BOOST_AUTO_TEST_CASE(mesh_phases_follow_the_bodies) {
  auto stage = free_reducer(0.9);
  stage.sun_teeth = 9;
  stage.cranks = stage.arc_gears = 3;
  const auto system = assemble(stage);
  const double two_pi = 2 * std::numbers::pi, output = -0.9 / 30, sun = stage.ratio() * output;
  const auto whole = [](double cycles) { return std::abs(cycles - std::round(cycles)); };
  for (int i = 0; i < 3; ++i) {
    const double phi = two_pi * (i + 1) / 3;
    BOOST_TEST(whole(system.meshes()[i].phase_offset - 9 * (sun - output - phi) / two_pi) <= 1e-12);
    const double eccentric = output + 0.9 + phi;  // towards the pitch point, in the housing
    BOOST_TEST(whole(system.meshes()[3 + i].phase_offset + 30 * eccentric / two_pi) <= 1e-12);
  }
}

// Half a turn exchanges the two arc gears: the frequencies have half the period.
BOOST_AUTO_TEST_CASE(frequencies_repeat_after_half_a_turn) {
  const auto found = modes_over_crank(stages::reducer(), 8, FrozenStiffness::mean);
  for (int i = 0; i < 4; ++i)
    BOOST_TEST((found.frequency.col(i) - found.frequency.col(i + 4)).cwiseAbs().maxCoeff() <=
               1e-9 * found.frequency.maxCoeff());
  // In the first mode both cranks move alike, and sum t_i = 0 takes the angle out of the energy.
  BOOST_TEST(found.frequency.row(0).maxCoeff() - found.frequency.row(0).minCoeff() <= 1e-9 * found.frequency(0, 0));
}

// The published first frequency, with the assumed inertias and stiffnesses: 1 % for their digits.
BOOST_AUTO_TEST_CASE(first_frequency_of_the_paper) {
  const auto stage = stages::reducer();
  BOOST_TEST(std::abs(first_frequency(stage) - 131) <= 1.31);
  const auto found = annulus::dynamics::modes(stage);
  const auto energy = annulus::dynamics::modal_energy(stage, found);
  for (Eigen::Index m = 0; m < energy.strain.cols(); ++m) {
    BOOST_TEST(std::abs(energy.strain.col(m).sum() - 1) <= 1e-12);
    BOOST_TEST(std::abs(energy.kinetic.col(m).sum() - 1) <= 1e-12);
  }
  BOOST_TEST_MESSAGE(mode_name(energy, 0));
  BOOST_TEST(mode_name(energy, 0).starts_with("input on "));
}

/// Everything stiff but what `keep` sets. 1e5 leaves an error of the order of the compliances' ratio.
TwoKVStage stiff_reducer(double factor) {
  auto stage = stages::reducer();
  stage.input_shaft *= factor;
  stage.crank_shaft *= factor;
  stage.crank_bearing *= factor;
  stage.arc_bearing *= factor;
  stage.sun_mesh = ConstantStiffness{1.4e8 * factor};
  stage.arc_mesh = ConstantStiffness{7.5e8 * factor};
  return stage;
}

BOOST_AUTO_TEST_CASE(one_freedom_limits) {
  const double two_pi = 2 * std::numbers::pi;
  auto shaft = stiff_reducer(1e6);
  shaft.input_shaft = 536;  // the input on its shaft, all else held with the output
  const double expected_shaft = std::sqrt(536 / 8.405e-6) / two_pi;
  BOOST_TEST(std::abs(first_frequency(shaft) - expected_shaft) <= 1e-4 * expected_shaft);

  auto bearing = stiff_reducer(1e6);
  bearing.crank_bearing = 1.5e8;  // the whole train moves as one against the output in the crank bearings
  const double r_c = 22e-3;
  const double inertia = 103 * 103 * (8.405e-6 + 9.2e-8) + 2 * 29 * 29 * (1.03e-5 + 4.6e-7) + 2 * 0.1083 * r_c * r_c +
                         2 * 1.8e-4 + 2 * 0.24 * std::pow(0.9e-3 * 29, 2);
  const double expected_bearing = std::sqrt(2 * 1.5e8 * r_c * r_c / inertia) / two_pi;
  BOOST_TEST(std::abs(first_frequency(bearing) - expected_bearing) <= 1e-4 * expected_bearing);

  auto support = stiff_reducer(1e6);
  support.output_support = 2e4;  // the whole reducer on the spring of the output
  const double expected_support = std::sqrt(2e4 / (inertia + 4.5e-4)) / two_pi;
  BOOST_TEST(std::abs(first_frequency(support) - expected_support) <= 1e-4 * expected_support);
}

// With rigid arc gear bearings the torques and forces of all elements follow from the ratio alone, so that the
// compliances add up; and the condensed stiffnesses of both ends differ by ratio^2.
BOOST_AUTO_TEST_CASE(torsional_stiffness_is_the_series_of_compliances) {
  auto stage = stages::reducer();
  stage.arc_bearing *= 1e7;
  const double r_bs = stage.sun_base_radius(), r_bp = stage.planet_base_radius(), r_c = 22e-3;
  const double sun_force = 1 / (103 * 2 * r_bs), arc_force = (1 - 1.0 / 103) / (2 * 0.9e-3 * 30);
  const double compliance = 1 / (103.0 * 103 * 536) + 2 * sun_force * sun_force / 1.4e8 +
                            2 * std::pow(sun_force * r_bp, 2) / 3141 + 2 * std::pow(1 / (2 * r_c), 2) / 1.5e8 +
                            2 * arc_force * arc_force / 7.5e8;
  const auto found = torsional_stiffness(stage, 6);
  for (int i = 0; i < 6; ++i) BOOST_TEST(std::abs(found.from_output[i] * compliance - 1) <= 1e-5);
  const auto base = torsional_stiffness(stages::reducer(), 6);
  for (int i = 0; i < 6; ++i)
    BOOST_TEST(std::abs(base.from_output[i] - 103 * 103 * base.from_input[i]) <= 1e-9 * base.from_output[i]);
}

BOOST_AUTO_TEST_CASE(static_equilibrium) {
  const auto held = stages::reducer();
  const auto system = assemble(held);
  StaticSolver solver(system);
  auto workspace = system.workspace();
  const Eigen::VectorXd radii = freedom_radii(held, system);
  const double stiffness = torsional_stiffness(held, 1).from_input[0];
  for (const double time : {0.0, 0.01, 0.033}) {
    const Eigen::VectorXd q = solver.solve(time, workspace);
    double reaction = 0;  // of the crank bearings on the held carrier
    for (const char* name : {"planet1_x", "planet2_x"}) reaction += 1.5e8 * q[system.find(name)] * 22e-3;
    BOOST_TEST(std::abs(reaction - 58) <= 1e-9 * 58);
    for (int m = 0; m < 2; ++m) {
      BOOST_TEST(std::abs(workspace.force[m] - held.mean_sun_mesh_force()) <= 1e-9 * held.mean_sun_mesh_force());
      BOOST_TEST(std::abs(workspace.force[2 + m] - held.mean_arc_mesh_force()) <= 1e-9 * held.mean_arc_mesh_force());
    }
    const double wind_up = q[0] / radii[0];
    BOOST_TEST(std::abs(wind_up - 58.0 / 103 / stiffness) <= 1e-9 * wind_up);
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

BOOST_AUTO_TEST_CASE(sensitivities) {
  auto stage = stages::reducer();
  stage.crank_angle = 0.8;
  stage.output_support = 1e5;
  double stiffnesses = 0, inertias = 0, before = 1e9;
  const auto found = first_frequency_sensitivities(stage);
  BOOST_TEST(found.size() == frequency_inputs(stage).size());
  for (const auto& s : found) {
    const double step = 1e-4;
    const double difference =
        std::log(first_frequency(stage, s.input, 1 + step) / first_frequency(stage, s.input, 1 - step)) / (2 * step);
    // Second order in the step, and rounding of the eigenvalue (1e-16 of the highest square, 4e-9 of the first one).
    BOOST_TEST(std::abs(s.value - difference) <= 1e-6);
    BOOST_TEST(std::abs(s.value) <= before);
    before = std::abs(s.value);
    if (!s.exact) continue;
    if (s.value > 0)
      stiffnesses += s.value;
    else
      inertias += s.value;
  }
  BOOST_TEST(std::abs(stiffnesses - 0.5) <= 1e-10);
  BOOST_TEST(std::abs(inertias + 0.5) <= 1e-10);
  BOOST_CHECK_THROW((void)scaled(stage, "input_support", 2), annulus::InputError);
  BOOST_CHECK_THROW((void)scaled(stage, "mass", 2), annulus::InputError);
}

BOOST_AUTO_TEST_CASE(band_of_an_input) {
  const auto stage = stages::reducer();
  const auto band = band_of_input(stage, "input_inertia", 131, 0.05);
  BOOST_REQUIRE((band.low && band.high));
  BOOST_TEST(std::abs(first_frequency(stage, "input_inertia", *band.low) - 131 * 1.05) <= 1e-6);
  BOOST_TEST(std::abs(first_frequency(stage, "input_inertia", *band.high) - 131 * 0.95) <= 1e-6);
  // A stiffness that matters little: from some factor on the frequency stays inside the band.
  const auto shaft = band_of_input(stage, "crank_shaft", 131, 0.05);
  BOOST_TEST(shaft.low.has_value());
  BOOST_TEST(!shaft.high.has_value());
  // Not monotone over all factors: the crossings nearest to the base value bound it.
  const auto eccentricity = band_of_input(stage, "eccentricity", 131, 0.05);
  BOOST_REQUIRE((eccentricity.low && eccentricity.high));
  BOOST_TEST(*eccentricity.low < 1.0);
  BOOST_TEST(*eccentricity.high > 1.0);
  BOOST_CHECK_THROW((void)band_of_input(stage, "input_inertia", 0, 0.05), annulus::InputError);
}

// Without speed the vectors stand still and nothing supplies energy: it stays. With the crank turning, the prescribed
// turn of the directions does work, b'(t)^T q F: the energy changes by just what power() books.
BOOST_AUTO_TEST_CASE(energy_of_free_vibration) {
  for (const double speed : {0.0, 30.0}) {  // rad/s of the output; 30: a crank turn in 7 ms
    auto stage = stages::reducer();
    stage.output_torque = 0;
    stage.output_speed = speed;
    const auto system = assemble(stage);
    SystemState state;
    state.q = Eigen::VectorXd::Zero(system.freedoms());
    state.v = state.q;
    for (int i = 0; i < system.freedoms(); ++i) state.v[i] = 1e-2 * std::cos(3.0 * i);
    auto workspace = system.workspace();
    const auto energy = [&] {
      Eigen::VectorXd y(2 * system.freedoms());
      y << state.q, state.v;
      return system.energy(state.time, y.data(), workspace);
    };
    IntegratorOptions options;
    options.relative_tolerance = 1e-9;
    options.absolute_tolerance = 1e-15;
    options.method = Integrator::arkode_explicit;
    const double before = energy();
    integrate(system, state, 5e-3, options, workspace, 0, {}, true);
    const double after = energy();
    // The integrator's error over some 150 periods of the highest mode, and of the energies that follow its steps.
    BOOST_TEST(std::abs(after - before - state.supplied) <= 2e-6 * before);
    BOOST_TEST(state.dissipated == 0.0);
    if (speed == 0)
      BOOST_TEST(state.supplied == 0.0);
    else
      BOOST_TEST(std::abs(after - before) > 1e-4 * before);
  }
}

// The promise is a millisecond for all modes of a position; a fourteenth of it is measured (release build).
BOOST_AUTO_TEST_CASE(modes_take_less_than_a_millisecond) {
  double best = 1;
  for (int run = 0; run < 5; ++run) {
    const auto start = std::chrono::steady_clock::now();
    (void)modes_over_crank(stages::reducer(), 36);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / 36);
  }
  BOOST_TEST_MESSAGE(best);
  BOOST_TEST(best < 1e-3);
}

BOOST_AUTO_TEST_CASE(bad_input_is_refused) {
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
