#include <Eigen/Core>
#include <Eigen/Dense>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/errors.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/systems/planetary/stage_statics.h"
#include "tests/dynamics/spatial_stages.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(spatial_stage)

using namespace annulus::dynamics;
namespace units = annulus::units;
using Eigen::Vector3d;
using Kind = StageBody::Kind;
using stages::bearing;

constexpr double pi = std::numbers::pi;

/// Two rows per planet, two carrier bearings, a spline that centres the sun beside the face.
void add_all_bearings(SpatialStage& s) {
  for (int n = 0; n < s.planets(); ++n) {
    const StageBody planet{Kind::planet, n};
    s.bearings.push_back(bearing("upwind row", planet, {Kind::carrier}, -0.06, 2e9, 1e9));
    s.bearings.push_back(bearing("downwind row", planet, {Kind::carrier}, 0.07, 2.5e9));
  }
  s.bearings.push_back(bearing("upwind", {Kind::carrier}, {}, -0.35, 3e9, 1e9, 1e7));
  s.bearings.push_back(bearing("downwind", {Kind::carrier}, {}, 0.3, 2e9));
  s.bearings.push_back(bearing("spline", {Kind::sun}, {}, 0.7, 5e7, 3e8, 2e5));
}

StaticTurn at_once(const SpatialStage& s, std::vector<double> cycles = {0.0}) {
  StaticSchedule schedule;
  schedule.cycles = std::move(cycles);
  return solve_turn(s, schedule, 1);
}

// Spur teeth without moments: the plane model, whose equilibrium has another formulation (rigid motions fixed by the
// mass, contact states held). Bodies then have three degrees of freedom each.
BOOST_AUTO_TEST_CASE(spur_stage_is_that_of_the_plane) {
  annulus::test::Verification record("Stage in space without moments", "plane model in equilibrium");
  SpatialStage s;
  s.plane = stages::ring_paper();
  for (auto* errors : {&s.plane.sun.errors, &s.plane.ring.errors, &s.plane.carrier.errors})
    *errors = {{20e-6, 0.4}, {30e-6, 1.1}};
  const auto face = [](const MeshExcitation& excitation) {
    StageFace f;
    f.law = [excitation](double phase, StageFace::Flank) {
      const auto& h = std::get<HarmonicStiffness>(excitation);
      const double k = h.mean * (1 + h.ripple * std::cos(2 * pi * (phase - h.phase_shift)));
      return std::make_shared<EvenFace>(k, std::vector<double>{-0.044, 0.044}, std::vector<double>{0, 0});
    };
    return f;
  };
  s.sun_face = face(s.plane.sun_mesh);
  s.ring_face = face(s.plane.ring_mesh);
  s.planet_working_radius_sun = 0.201 * 55 / (48 + 55);
  s.planet_working_radius_ring = 0.201 * 55 / (162 - 55);
  BOOST_TEST(s.reasons_for_space().empty());
  const auto system = assemble(s.plane);
  for (const double cycles : {0.0, 7.3, 88.7, 121.25}) {
    const auto turn = at_once(s, {cycles});
    StaticSolver solver(system);
    auto workspace = system.workspace();
    const double time = cycles / s.plane.mesh_frequency();
    const Eigen::VectorXd start = Eigen::VectorXd::Zero(system.dofs());
    system.detect_contact(time, start.data(), workspace);
    (void)solver.solve(time, workspace);
    for (std::size_t n = 0; n < 5; ++n) {
      record.close("mesh forces of five planets, floating sun, all errors", "N", turn.positions[0].sun_meshes[n].force,
                   workspace.force[n], 1e-8, "residual of the equilibria");
      record.close("mesh forces of five planets, floating sun, all errors", "N", turn.positions[0].ring_meshes[n].force,
                   workspace.force[5 + n], 1e-8, "residual of the equilibria");
    }
    BOOST_TEST(turn.positions[0].residual_relative <= 1e-11);
  }
}

// A rigid rotation with the ratio of the gears, and any common motion of all bodies, deflects nothing.
BOOST_AUTO_TEST_CASE(rigid_motions_deflect_nothing) {
  annulus::test::Verification record("Meshes in space", "kinematics of rigid bodies");
  for (const double helix : {0.0, 7.5 * units::deg, -20 * units::deg}) {
    auto s = stages::reliability_stage(helix);
    add_all_bearings(s);
    const auto made = assemble(s, 0.3);
    const auto& m = made.mechanism;
    Eigen::VectorXd turn = Eigen::VectorXd::Zero(6 * m.bodies());
    // Carrier and ring stand still: the planets turn backwards.
    const double angle = 1e-3;
    turn[5] = angle;
    for (int n = 0; n < 3; ++n) turn[6 * (3 + n) + 5] = -angle * 21 / 39;
    turn[6 + 5] = -angle * 21 / 99;
    double worst = 0;
    for (const auto& mesh : made.meshes)
      worst = std::max(worst, m.deflection(mesh.driving, turn).cwiseAbs().maxCoeff() / (angle * s.plane.sun.radius));
    const Vector3d shift(3e-4, -2e-4, 1e-4), tilt(2e-4, 5e-4, -3e-4);
    Eigen::VectorXd common(6 * m.bodies());
    for (int b = 0; b < m.bodies(); ++b) common.segment<6>(6 * b) << shift + tilt.cross(m.body(b).reference), tilt;
    for (const auto& mesh : made.meshes)
      worst = std::max(worst, m.deflection(mesh.driving, common).cwiseAbs().maxCoeff() / shift.norm());
    record.at_most("deflection over the motion, three helix angles", "", worst, 1e-12, "rounding");
  }
}

// Forces and moments on the whole stage from without, in a stage where everything gives way and is loaded.
BOOST_AUTO_TEST_CASE(reactions_balance_the_loads) {
  annulus::test::Verification record("Reactions of a stage in space", "equilibrium of the whole stage");
  auto s = stages::reliability_stage(7.5 * units::deg);
  add_all_bearings(s);
  s.bearings[6].play = 150e-6;
  s.bearings[7].play = 100e-6;
  s.bearings[7].load_zone = false;
  s.bearings[8].play = 50e-6;
  s.gravity = {2, -9.5, 1};
  s.weights = {{{Kind::sun}, 180, 0.1}, {{Kind::ring}, 509, 0}, {{Kind::carrier}, 1500, -0.05}};
  for (int n = 0; n < 3; ++n) s.weights.push_back({{Kind::planet, n}, 110, 0.01});
  s.loads = {{"rotor", {Kind::carrier}, StageFrame::housing, {0.1, 0.2, -0.5}, {3e4, -2e4, 5e4}, {4e4, 8e4, 0}},
             {"pin", {Kind::planet, 1}, StageFrame::planet, {0.02, 0, 0.05}, {1e3, 2e3, -1e3}, {50, 70, 0}}};
  s.plane.planet_errors.assign(3, {});
  s.plane.planet_errors[1].position = {60e-6, 0.7};
  for (const double cycles : {0.0, 31.4, 77.7}) {
    const auto turn = at_once(s, {cycles});
    const auto& p = turn.positions[0];
    const auto made = assemble(s, p.time);
    const auto housing = frame_axes(s, StageFrame::housing, {}, p.time);
    Vector3d force = Vector3d::Zero(), moment(0, 0, s.plane.sun_torque + p.ring_torque + p.carrier_torque);
    for (std::size_t b = 0; b < made.bearings.size(); ++b) {
      const auto& bearing = made.bearings[b];
      if (bearing.body.kind == Kind::planet) continue;
      const Vector3d on_body = bearing.axes * p.bearings[b].force;
      force += on_body;
      moment += bearing.axes * Vector3d(p.bearings[b].moment[0], p.bearings[b].moment[1], 0) +
                Vector3d(0, 0, bearing.place).cross(on_body);
    }
    const auto add = [&](const Vector3d& point, const Vector3d& f, const Vector3d& m) {
      force += f;
      moment += m + point.cross(f);
    };
    double mass = 0;
    for (const auto& w : s.weights) {
      const int number = body_number(s, w.body);
      add(made.mechanism.body(number).reference + w.place * Vector3d::UnitZ(), w.mass * (housing * s.gravity),
          Vector3d::Zero());
      mass += w.mass;
    }
    add(housing * s.loads[0].point, housing * s.loads[0].force, housing * s.loads[0].moment);
    const auto planet = frame_axes(s, StageFrame::planet, {Kind::planet, 1}, 0);
    add(made.mechanism.body(4).reference + planet * s.loads[1].point, planet * s.loads[1].force,
        planet * s.loads[1].moment);
    const double size = mass * 9.8;
    record.at_most("sum of forces over the weight, three angles of the carrier", "", force.norm() / size, 1e-8,
                   "residual of the equilibrium");
    record.at_most("sum of moments over weight times centre distance", "", moment.norm() / (size * 0.308), 1e-8,
                   "residual of the equilibrium");
  }
}

// Helical stage with rigid bearings of the planets: what the meshes do to each body in closed form.
BOOST_AUTO_TEST_CASE(axial_forces_and_tilting_moments) {
  annulus::test::Verification record("Helical stage", "equilibrium of each body");
  for (const double helix : {7.5 * units::deg, -12 * units::deg}) {
    const auto s = stages::reliability_stage(helix);
    const auto turn = at_once(s);
    const auto& p = turn.positions[0];
    const double normal = s.plane.mean_mesh_force() / std::cos(s.base_helix_angle);
    const double axial = normal * std::sin(s.base_helix_angle);  // sigma F_a
    for (std::size_t n = 0; n < 3; ++n) {
      record.close("mesh forces", "N", p.sun_meshes[n].force, s.plane.mean_mesh_force(), 1e-9, "residual");
      record.close("mesh forces", "N", p.ring_meshes[n].force, s.plane.mean_mesh_force(), 1e-9, "residual");
    }
    // Supports: sun, ring, carrier, planets. They act against the meshes.
    record.close("axial force on the sun", "N", -p.bearings[0].force.z(), -3 * axial, 1e-9, "residual");
    record.close("axial force on the ring", "N", -p.bearings[1].force.z(), 3 * axial, 1e-9, "residual");
    for (std::size_t n = 0; n < 3; ++n) {
      record.at_most("axial force on a planet over F_a", "", std::abs(p.bearings[3 + n].force.z() / axial), 1e-9,
                     "residual");
      // sigma F_a (r_ws + r_wr) about the tangential axis, r_w the two working radii of the planet.
      const double both = s.planet_working_radius_sun + s.planet_working_radius_ring;
      record.close("tilting moment on a planet", "N m", -p.bearings[3 + n].moment[1], axial * both, 1e-9, "residual");
    }
    record.close("torque of the carrier", "N m", p.carrier_torque, -325e3, 1e-9, "residual");
  }
}

// A floating sun of a spur stage of three planets: F_n - F = (2/3) W . e_n, e_n along the line of action.
BOOST_AUTO_TEST_CASE(weight_of_a_floating_sun_over_a_turn) {
  annulus::test::Verification record("Weight of a floating sun", "statics of three planets");
  auto s = stages::reliability_stage(0);
  s.gravity = {0, -9.81, 0};
  s.weights = {{{Kind::sun}, 180, 0}};
  BOOST_TEST(s.reasons_for_space().empty());
  BOOST_TEST(s.depends_on_carrier_angle());
  const auto turn = solve_turn(s, places_over(period_of(s), 12, 1), 2);
  BOOST_TEST(turn.positions.size() == 12u);
  for (const auto& p : turn.positions)
    for (std::size_t n = 0; n < 3; ++n) {
      const double along = s.plane.planet_angles[n] + pi / 2 - s.plane.sun_working_angle;  // of e_n
      const double down = -pi / 2 - p.carrier_angle;
      const double expected = s.plane.mean_mesh_force() + 2.0 / 3 * 180 * 9.81 * std::cos(along - down);
      record.close("sun mesh forces at 12 angles", "N", p.sun_meshes[n].force, expected, 1e-9, "residual");
    }
}

// Where the search starts from changes nothing: there is one equilibrium.
BOOST_AUTO_TEST_CASE(any_start_finds_the_same_equilibrium) {
  auto s = stages::reliability_stage(7.5 * units::deg);
  add_all_bearings(s);
  s.gravity = {0, -9.81, 0};
  for (const auto& [body, mass] : {std::pair{StageBody{Kind::sun}, 180.0}, {StageBody{Kind::carrier}, 1500.0}})
    s.weights.push_back({body, mass, 0});
  const auto schedule = places_over(period_of(s), 20, 2);
  const auto turn = solve_turn(s, schedule, 1);
  auto stiffer = s;
  stiffer.sun_face = stages::even_face(3.3e9, 0.22);
  const auto from_near = solve_turn(stiffer, schedule, 1, &turn);
  const double force = s.plane.mean_mesh_force();
  for (std::size_t i = 0; i < turn.positions.size(); ++i) {
    const auto& p = turn.positions[i];
    const auto alone = at_once(s, {p.mesh_cycles}).positions.front();
    const auto stiffer_alone = at_once(stiffer, {p.mesh_cycles}).positions.front();
    for (std::size_t n = 0; n < 3; ++n) {
      // Residuals are 1e-12 of the largest force, and soft splines make more of them.
      BOOST_TEST(std::abs(p.sun_meshes[n].force - alone.sun_meshes[n].force) <= 1e-9 * force);
      BOOST_TEST(std::abs(from_near.positions[i].sun_meshes[n].force - stiffer_alone.sun_meshes[n].force) <=
                 1e-9 * force);
    }
  }
}

// Two positions of one mesh cycle: each loads another end of the face, in the mean it is even.
BOOST_AUTO_TEST_CASE(face_load_over_a_mesh_cycle) {
  StaticMesh one_end{.force = 10, .mean_line_load = 2, .place = 0, .line_load = {1, 2, 3}};
  auto other_end = one_end;
  other_end.line_load = {3, 2, 1};
  StaticMesh light{.force = 0.1, .mean_line_load = 0.02, .place = 0, .line_load = {0, 0, 0.06}};
  StaticTurn turn;
  turn.schedule = {.cycles = {0}, .phases = 2};
  turn.positions.resize(2);
  turn.positions[0].sun_meshes = {one_end, light};
  turn.positions[1].sun_meshes = {other_end, light};
  // The line load of the ring mesh changes its amount as well: (1 + 6) over (1 + 3) at one end.
  turn.positions[0].ring_meshes = {{.force = 5, .mean_line_load = 1, .place = 0, .line_load = {1, 1, 1}}};
  turn.positions[1].ring_meshes = {{.force = 15, .mean_line_load = 3, .place = 0, .line_load = {0, 3, 6}}};
  const auto figures = figures_of(turn);
  BOOST_TEST(figures.sun.line_load_ratio == 1.0);
  BOOST_TEST(figures.sun.line_load_ratio_instantaneous == 1.5);
  BOOST_TEST(figures.ring.line_load_ratio == 1.75);
  BOOST_TEST(figures.ring.line_load_ratio_instantaneous == 2.0);
}

/// The stage by other means: faces cut into slices that are springs, approaches written out in parts, contact found by
/// repeated linear solutions. Ring and carrier stand still; sun and planets have six degrees of freedom.
struct SlicedStage {
  const SpatialStage& s;
  int slices;
  Eigen::MatrixXd bearing_sun, bearing_planet;  // 6 x 6, at the bodies' centres

  /// Row of approach of a slice over the motions of sun and planets.
  [[nodiscard]] Eigen::RowVectorXd row(bool sun, int n, double z) const {
    const double c = std::cos(s.base_helix_angle), sb = std::sin(s.base_helix_angle);
    const double phi = s.plane.planet_angles[static_cast<std::size_t>(n)];
    const Vector3d r(std::cos(phi), std::sin(phi), 0), t(-std::sin(phi), std::cos(phi), 0), axis(0, 0, 1);
    const double a = sun ? s.plane.sun_working_angle : s.plane.ring_working_angle;
    const Vector3d e = sun ? Vector3d(std::cos(a) * t + std::sin(a) * r) : Vector3d(-std::cos(a) * t + std::sin(a) * r);
    Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(24);
    const auto body = [&](int at, double sign, const Vector3d& arm, double rotation) {
      result.segment<3>(at) = sign * (c * e + sb * axis).transpose();
      result.segment<3>(at + 3) = sign * (z * c * axis.cross(e) + sb * arm.cross(axis)).transpose();
      result[at + 5] = rotation * c;
    };
    const double sun_arm = s.plane.carrier.radius - s.planet_working_radius_sun;
    if (sun) {
      body(0, 1, sun_arm * r, s.plane.sun.radius);
      body(6 + 6 * n, -1, -s.planet_working_radius_sun * r, s.plane.planet.radius);
    } else {
      body(6 + 6 * n, 1, s.planet_working_radius_ring * r, -s.plane.planet.radius);
    }
    return result;
  }

  /// Largest force per width over the mean and share of each sun mesh, and all motions.
  struct Answer {
    std::vector<double> force, ratio;
    Eigen::VectorXd motion;
  };
  [[nodiscard]] Answer solve(double sun_stiffness, double ring_stiffness, double slope) const {
    std::vector<Eigen::RowVectorXd> rows;
    std::vector<double> stiffness, gap;
    for (const bool sun : {true, false})
      for (int n = 0; n < 3; ++n)
        for (int i = 0; i < slices; ++i) {
          const double b = sun ? 0.22 : 0.2275, z = b * ((i + 0.5) / slices - 0.5);
          rows.push_back(row(sun, n, z));
          stiffness.push_back((sun ? sun_stiffness : ring_stiffness) / slices);
          gap.push_back(sun ? slope * z : 0.0);
        }
    Eigen::VectorXd load = Eigen::VectorXd::Zero(24), q = Eigen::VectorXd::Zero(24);
    load[5] = s.plane.sun_torque;
    std::vector<bool> touches(rows.size(), true);
    for (int pass = 0; pass < 100; ++pass) {
      Eigen::MatrixXd k = Eigen::MatrixXd::Zero(24, 24);
      k.topLeftCorner(6, 6) += bearing_sun;
      for (int n = 0; n < 3; ++n) {
        // About the planet's own radial and tangential axes.
        const double phi = s.plane.planet_angles[static_cast<std::size_t>(n)];
        Eigen::Matrix3d turn;
        turn << std::cos(phi), -std::sin(phi), 0, std::sin(phi), std::cos(phi), 0, 0, 0, 1;
        Eigen::MatrixXd both = Eigen::MatrixXd::Zero(6, 6);
        both.topLeftCorner(3, 3) = turn;
        both.bottomRightCorner(3, 3) = turn;
        k.block(6 + 6 * n, 6 + 6 * n, 6, 6) += both * bearing_planet * both.transpose();
      }
      Eigen::VectorXd right = load;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!touches[i]) continue;
        k += stiffness[i] * rows[i].transpose() * rows[i];
        right += stiffness[i] * gap[i] * rows[i].transpose();
      }
      q = k.fullPivLu().solve(right);
      bool same = true;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const bool now = rows[i].dot(q) > gap[i];
        same = same && now == touches[i];
        touches[i] = now;
      }
      if (same) break;
    }
    Answer answer{{}, {}, q};
    for (std::size_t mesh = 0; mesh < 6; ++mesh) {
      double sum = 0, largest = 0;
      for (std::size_t i = mesh * static_cast<std::size_t>(slices); i < (mesh + 1) * static_cast<std::size_t>(slices);
           ++i) {
        const double f = stiffness[i] * std::max(0.0, rows[i].dot(q) - gap[i]);
        sum += f;
        largest = std::max(largest, f);
      }
      answer.force.push_back(sum * std::cos(s.base_helix_angle));
      answer.ratio.push_back(largest * slices / sum);
    }
    return answer;
  }
};

// Slices soften a tilt by the square of their number, and their largest force is that in the middle of the last one:
// 800 leave 1 / 800 of the rise of the load along the face.
BOOST_AUTO_TEST_CASE(tilting_planets_by_slices) {
  annulus::test::Verification record("Helical stage whose planets tilt", "800 springs per mesh, solved by other means");
  for (const double slope : {0.0, 4e-4}) {
    auto s = stages::reliability_stage(7.5 * units::deg);
    const double kr = 2e9, ka = 1e9, kt = 8e6;
    for (int n = 0; n < 3; ++n)
      s.bearings.push_back(bearing("row", {Kind::planet, n}, {Kind::carrier}, 0.03, kr, ka, kt));
    s.bearings.push_back(bearing("spline", {Kind::sun}, {}, 0.4, 3e7, 2e8, 1e6));
    s.sun_face = stages::even_face(3e9, 0.22, {-0.11 * slope, 0.11 * slope});
    SlicedStage other{s, 800, Eigen::MatrixXd::Zero(6, 6), Eigen::MatrixXd::Zero(6, 6)};
    const auto at_place = [](double z, double radial, double axial, double tilt) {
      Eigen::MatrixXd k = Eigen::MatrixXd::Zero(6, 6);
      k.diagonal() << radial, radial, axial, tilt + radial * z * z, tilt + radial * z * z, 0;
      k(0, 4) = k(4, 0) = radial * z;
      k(1, 3) = k(3, 1) = -radial * z;
      return k;
    };
    other.bearing_sun = at_place(0.4, 3e7, 2e8, 1e6);
    other.bearing_planet = at_place(0.03, kr, ka, kt);
    const auto expected = other.solve(3e9, 4e9, slope);
    const auto turn = at_once(s);
    const auto& p = turn.positions[0];
    for (std::size_t n = 0; n < 3; ++n) {
      record.close("mesh forces, two slopes", "N", p.sun_meshes[n].force, expected.force[n], 1e-5, "slices");
      record.close("mesh forces, two slopes", "N", p.ring_meshes[n].force, expected.force[3 + n], 1e-5, "slices");
      record.close("K_Hbeta", "", p.sun_meshes[n].line_load_ratio(), expected.ratio[n], 5e-3, "width of a slice");
      record.close("K_Hbeta", "", p.ring_meshes[n].line_load_ratio(), expected.ratio[3 + n], 5e-3, "width of a slice");
      const double phi = s.plane.planet_angles[n];
      const Vector3d tilt = expected.motion.segment<3>(static_cast<Eigen::Index>(6 + 6 * n + 3));
      const double about_tangent = -std::sin(phi) * tilt[0] + std::cos(phi) * tilt[1];
      record.close("tilt of the planets about the tangential axis", "rad", p.bodies[3 + n].rotation[1], about_tangent,
                   1e-4, "slices");
    }
  }
}

// On faces so narrow that they resist no tilt, cantilevered pins bend under the two mesh forces alone.
BOOST_AUTO_TEST_CASE(pins_bend_and_tilt) {
  annulus::test::Verification record("Pins of planets in space", "compliance of a beam under the two mesh forces");
  auto s = stages::reliability_stage(0);
  s.sun_face = stages::even_face(3e9, 1e-6);
  s.ring_face = stages::even_face(4e9, 1e-6);
  // Shift, tilt and their coupling under a force and a moment.
  const double shift = 4e-10, tilt = 2e-9, bend = 2e-8, reach = 1e-11;
  Eigen::Matrix<double, 5, 5> compliance = Eigen::Matrix<double, 5, 5>::Zero();
  compliance.diagonal() << shift, shift, reach, bend, bend;
  compliance(0, 4) = compliance(4, 0) = tilt;
  compliance(1, 3) = compliance(3, 1) = -tilt;
  s.pins = stages::on_each_planet(s, compliance.inverse());
  for (int n = 0; n < 3; ++n)
    s.loads.push_back(
        {"radial", {Kind::planet, n}, StageFrame::planet, Vector3d::Zero(), {3e4, 0, 0}, Vector3d::Zero()});
  BOOST_TEST(s.reasons_for_space().size() == 1u);
  const auto turn = at_once(s);
  const auto& p = turn.positions[0];
  const auto& plane = s.plane;
  const double force = plane.mean_mesh_force();
  const double radial = 3e4 + force * (std::sin(plane.sun_working_angle) - std::sin(plane.ring_working_angle));
  const double tangential = force * (std::cos(plane.sun_working_angle) + std::cos(plane.ring_working_angle));
  for (std::size_t n = 0; n < 3; ++n) {
    const auto &planet = p.bodies[3 + n], &pin = p.bodies[6 + n];
    record.close("displacement of planets, radial", "m", planet.displacement.x(), shift * radial, 1e-6,
                 "width of the faces");
    record.close("displacement of planets, tangential", "m", planet.displacement.y(), shift * tangential, 1e-6,
                 "width of the faces");
    record.close("tilt about the tangential axis", "rad", planet.rotation.y(), tilt * radial, 1e-6,
                 "width of the faces");
    record.close("tilt about the radial axis", "rad", planet.rotation.x(), -tilt * tangential, 1e-6,
                 "width of the faces");
    BOOST_TEST((planet.displacement - pin.displacement).norm() <= 1e-9 * pin.displacement.norm());
    BOOST_TEST(std::abs(pin.rotation.z()) <= 1e-15);
  }
}

// Two rigid bearings on either side of the face: in the plane they hold the same, and each bears half.
// A spline with backlash lets the shaft tilt to its stop, and resists beyond.
BOOST_AUTO_TEST_CASE(tilt_clearance) {
  annulus::test::Verification record("Bearing with tilt clearance", "moment over stiffness, beyond the clearance");
  Mechanism mechanism(0.1);
  mechanism.add_body({"shaft"});
  BearingAssembly bearings(mechanism, Motions::in_space);
  auto spline = bearing("spline", {Kind::sun}, {}, 0.2, rigid, rigid, 3e6);
  spline.tilt_play = 2e-3;
  (void)bearings.add(spline, {});
  mechanism.hold("the rotation", mechanism.rotation(0, Mechanism::ground, Eigen::Vector3d::UnitZ()));
  mechanism.add_load(0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), {400, -300, 0});
  const Eigen::Vector2d tilt = mechanism.solve().motion.segment<2>(3);
  record.close("tilt", "rad", tilt.norm(), 2e-3 + 500 / 3e6, 1e-6, "what holds the body in its play");
  record.close("its direction", "", tilt.x() / tilt.y(), -4.0 / 3, 1e-9, "rounding");
}

BOOST_AUTO_TEST_CASE(rigid_bearings_on_either_side) {
  auto s = stages::reliability_stage(0);
  s.plane.carrier.support = 1e9;
  s.weights = {{{Kind::carrier}, 1000, 0}};
  s.gravity = {0, -10, 0};
  for (const double place : {-0.3, 0.3})
    s.bearings.push_back(bearing("b" + std::to_string(place), {Kind::carrier}, {}, place, rigid));
  BOOST_TEST(s.reasons_for_space().empty());
  const auto turn = at_once(s);
  for (std::size_t b : {0u, 1u})
    BOOST_TEST(turn.positions[0].bearings[b].force.y() == 5000, boost::test_tools::tolerance(1e-9));
}

// A thrust bearing leaves the radial support of the sun where it is.
BOOST_AUTO_TEST_CASE(bearings_without_radial_stiffness_leave_the_support) {
  auto s = stages::reliability_stage(7.5 * units::deg);
  s.plane.sun.support = 1e10;
  s.plane.planet_errors.assign(3, {});
  s.plane.planet_errors[1].position = {100e-6, 0.7};
  const auto sharing = [](const SpatialStage& stage) { return figures_of(at_once(stage)).sun.sharing; };
  const double before = sharing(s);
  BOOST_TEST(before > 1.1);
  s.bearings = {bearing("thrust", {Kind::sun}, {}, 0, 0, 1e9, 1e9)};
  BOOST_TEST(sharing(s) == before, boost::test_tools::tolerance(0.02));
}

BOOST_AUTO_TEST_CASE(what_nothing_holds_is_named) {
  auto s = stages::reliability_stage(7.5 * units::deg);
  s.bearings = {bearing("spline", {Kind::sun}, {}, 0.4, 3e7, 0, 1e6)};
  s.plane.planet_errors.clear();
  // Sun along the axis: the helix turns it as it moves.
  const auto expect_refusal = [](const SpatialStage& stage, const std::string& words) {
    BOOST_CHECK_EXCEPTION((void)at_once(stage), annulus::InputError, [&](const annulus::InputError& e) {
      BOOST_TEST_INFO(e.what());
      return std::string(e.what()).find(words) != std::string::npos;
    });
  };
  expect_refusal(s, "sun");
  // A carrier in one bearing tilts about its planets, which shift along the meshes of a spur stage.
  s = stages::reliability_stage(0);
  for (int n = 0; n < 3; ++n) s.bearings.push_back(bearing("row", {Kind::planet, n}, {Kind::carrier}, 0, 2e9, 1e9));
  s.bearings.push_back(bearing("main", {Kind::carrier}, {}, -0.3, 3e9, 1e9));
  s.loads = {{"rotor", {Kind::carrier}, StageFrame::housing, {0, 0, 0}, {0, 0, 0}, {5e4, 0, 0}}};
  expect_refusal(s, "nothing resists a motion of carrier about");
  s = stages::reliability_stage(7.5 * units::deg);
  for (const double place : {-0.3, 0.3, 0.5}) {
    s.bearings.push_back(bearing("b" + std::to_string(s.bearings.size()), {Kind::carrier}, {}, place, rigid, 1e9));
  }
  expect_refusal(s, "is already held rigidly");
}

// Torque the other way with backlash: the back flanks carry, in the mirrored stage.
BOOST_AUTO_TEST_CASE(back_flanks_carry_what_is_reversed) {
  annulus::test::Verification record("Back flanks of a helical stage", "mirror image of the stage");
  auto s = stages::reliability_stage(7.5 * units::deg);
  add_all_bearings(s);
  s.sun_face.backlash = s.ring_face.backlash = 300e-6;
  auto mirrored = s;
  s.plane.sun_torque *= -1;
  mirrored.base_helix_angle *= -1;
  // The mirror image about the plane through planet 0: planets 1 and 2 change places.
  const auto reversed = at_once(s), image = at_once(mirrored);
  for (const std::size_t n : {0u, 1u, 2u}) {
    const auto& a = reversed.positions[0].sun_meshes[n];
    BOOST_TEST(a.back_flanks);
    record.close("sun mesh forces", "N", -a.force, image.positions[0].sun_meshes[(3 - n) % 3].force, 1e-9, "residual");
    record.close("ring mesh forces", "N", -reversed.positions[0].ring_meshes[n].force,
                 image.positions[0].ring_meshes[(3 - n) % 3].force, 1e-9, "residual");
  }
}

BOOST_AUTO_TEST_SUITE_END()
