#include <Eigen/Core>
#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include "core/errors.h"
#include "dynamics/modes/dense_spectrum.h"
#include "dynamics/modes/modes.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/system/lumped_system.h"
#include "dynamics/systems/planetary/bearing_forces.h"
#include "dynamics/systems/planetary/planetary_modes.h"
#include "dynamics/systems/planetary/response.h"
#include "dynamics/systems/planetary/space_motion.h"
#include "dynamics/systems/planetary/stage_statics.h"
#include "dynamics/systems/planetary/working_point.h"
#include "tests/dynamics/lumped_stages.h"
#include "tests/dynamics/second_derivatives.h"
#include "tests/dynamics/stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(space_dynamics)

using namespace annulus::dynamics;
namespace units = annulus::units;
using Eigen::Vector3d;
using Kind = StageBody::Kind;
using stages::bearing;
using namespace stages::lumped_in_space;

constexpr double pi = std::numbers::pi;

// Without inertia the lumped system is the mechanism of the statics, which is formulated otherwise: rigid bodies in one
// frame, holds, exact integrals along the face. Bearings with clearance bear at their working point what they do there.
BOOST_AUTO_TEST_CASE(equilibrium_is_that_of_the_statics) {
  annulus::test::Verification record("Lumped stage in space", "statics of the mechanism");
  enum class Case { linear, clearance, pins, carrier, partial };
  for (const auto& [which, helix, tolerance, origin] :
       {std::tuple{Case::linear, 7.5, 1e-8, "residual of the equilibria"},
        {Case::linear, -10.0, 1e-8, "residual of the equilibria"},
        {Case::linear, 0.0, 1e-8, "residual of the equilibria"},
        {Case::clearance, 7.5, 1e-7, "residual of the equilibria"},
        {Case::pins, 7.5, 1e-8, "residual of the equilibria"},
        {Case::carrier, 7.5, 1e-8, "residual of the equilibria"},
        {Case::partial, 7.5, 5e-4, "places on the face"}}) {
    auto s = stages::reliability_stage(helix * units::deg);
    s.plane.carrier_speed = 0;  // loads of the housing act as they are
    s.ring_face.middle = 0.004;
    s.gravity = {2, -9.5, 1};
    s.weights = {{{Kind::sun}, 180, 0.1}, {{Kind::ring}, 509, 0}, {{Kind::carrier}, 1500, -0.05}};
    add_all_bearings(s);
    s.loads = {{"thrust", {Kind::carrier}, StageFrame::housing, {0, 0, 0.1}, {0, 0, 4e4}, {0, 0, 0}},
               {"pin", {Kind::planet, 1}, StageFrame::planet, {0.02, 0, 0.05}, {1e3, 0, -1e3}, {50, 70, 0}}};
    s.plane.planet_errors.assign(3, {});
    s.plane.planet_errors[1].position = {60e-6, 0.7};
    if (which == Case::clearance) {
      s.bearings[6].play = 150e-6;
      s.bearings[7].play = 100e-6;
      s.bearings[7].load_zone = false;
      s.bearings[0].row = {.count = 30,
                           .diameter = 0.03,
                           .length = 0.04,
                           .pitch_diameter = 0.3,
                           .contact_angle = 0.2,
                           .clearance = -30e-6,
                           .ring = RollingRow::Ring::outer};
      s.bearings[1].row = s.bearings[0].row;
      s.bearings[1].row->contact_angle = -0.25;
    }
    // Pins that bend tilt the planets until a part of the faces has no contact.
    if (which == Case::pins || which == Case::partial) {
      const double tilt = which == Case::pins ? 3e8 : 3e6;
      Eigen::Matrix<double, 5, 5> pin = Eigen::Matrix<double, 5, 5>::Zero();
      pin.diagonal() << 1e9, 1e9, 2e9, tilt, tilt;
      pin(0, 4) = pin(4, 0) = 2e7;
      pin(1, 3) = pin(3, 1) = -2e7;
      s.pins = stages::on_each_planet(s, pin);
      s.bearings[2].axial = rigid;
    }
    if (which == Case::carrier) s.pins = pins_stiffness(stages::two_wall_carrier(s));
    const auto expected = statics(s).positions.front();
    const auto found = solved(lumped(s));
    double whole = 1;
    for (std::size_t m = 0; m < 6; ++m) {
      const auto& mesh = m < 3 ? expected.sun_meshes[m] : expected.ring_meshes[m - 3];
      const double half = (m < 3 ? sun_width : ring_width) / 2;
      const auto name = which == Case::partial ? "mesh forces, parts of the faces without contact" : "mesh forces";
      record.close(name, "N", found.force[m], mesh.force, tolerance, origin);
      const double scale = half * std::abs(mesh.force);
      record.at_most(which == Case::partial
                         ? "moment along the face over force x half its width, without contact in parts"
                         : "moment along the face over force x half its width",
                     "", std::abs(found.tilt[m] * half - mesh.force * mesh.place) / scale, tolerance, origin);
      for (const double line : mesh.line_load) whole = std::min(whole, line);
    }
    BOOST_TEST((whole <= 0) == (which == Case::partial), static_cast<int>(which)
                                                             << ", contact of the whole face: " << whole);
  }
}

/// The same bodies, meshes and bearings by exact rotations of rigid bodies: the potential energy at any motion.
class RigidBodies {
 public:
  explicit RigidBodies(const SpatialStage& stage) : stage_(stage) {}

  /// q: x, y, z and rotation vector of sun, ring, carrier, planets, all in the frame of the carrier.
  [[nodiscard]] double energy(const Eigen::VectorXd& q) const {
    double sum = 0;
    for (const auto& b : stage_.bearings) {
      const int body = body_number(stage_, b.body), on = body_number(stage_, b.on);
      const auto axes = frame_axes(stage_, b.frame(), b.body, 0);
      const Vector3d point = centre(body) + b.place * Vector3d::UnitZ();
      const Vector3d d = axes.transpose() * (moved(q, body, point) - moved(q, on, point));
      const Vector3d tilt = axes.transpose() * (turn(q, body) - turn(q, on));
      sum += (b.x * d[0] * d[0] + b.y * d[1] * d[1] + b.axial * d[2] * d[2] +
              b.tilt * (tilt[0] * tilt[0] + tilt[1] * tilt[1])) /
             2;
    }
    for (int n = 0; n < stage_.planets(); ++n) sum += mesh_energy(q, n, true) + mesh_energy(q, n, false);
    return sum;
  }

 private:
  [[nodiscard]] Vector3d centre(int body) const {
    if (body < 3) return Vector3d::Zero();
    const double phi = stage_.plane.planet_angles[static_cast<std::size_t>(body - 3)];
    return stage_.plane.carrier.radius * Vector3d(std::cos(phi), std::sin(phi), 0);
  }
  static Vector3d turn(const Eigen::VectorXd& q, int body) {
    return body < 0 ? Vector3d(Vector3d::Zero()) : Vector3d(q.segment<3>(6 * body + 3));
  }
  [[nodiscard]] Vector3d moved(const Eigen::VectorXd& q, int body, const Vector3d& point) const {
    if (body < 0) return point;
    const Vector3d rotation = turn(q, body);
    const double angle = rotation.norm();
    const Vector3d axis = angle > 0 ? Vector3d(rotation / angle) : Vector3d(Vector3d::UnitZ());
    return centre(body) + q.segment<3>(6 * body) + Eigen::AngleAxisd(angle, axis) * (point - centre(body));
  }
  /// Contact at many places of the line z at the pitch point; n from the tangent plane of both base cylinders.
  [[nodiscard]] double mesh_energy(const Eigen::VectorXd& q, int n, bool sun) const {
    const auto& p = stage_.plane;
    const Vector3d c = centre(3 + n), r = c.normalized(), t = Vector3d::UnitZ().cross(r);
    const double alpha = sun ? p.sun_working_angle : p.ring_working_angle;
    const Vector3d line = std::sin(alpha) * r + (sun ? 1 : -1) * std::cos(alpha) * t;
    const Vector3d normal =
        std::cos(stage_.base_helix_angle) * line + std::sin(stage_.base_helix_angle) * Vector3d::UnitZ();
    const Vector3d pitch =
        sun ? Vector3d(c - stage_.planet_working_radius_sun * r) : Vector3d(c + stage_.planet_working_radius_ring * r);
    const int driving = sun ? 0 : 3 + n, driven = sun ? 3 + n : 1;
    const double width = sun ? sun_width : ring_width, stiffness = sun ? sun_stiffness : ring_stiffness;
    constexpr int places = 2;  // of Gauss: exact for squares
    double sum = 0;
    for (const double z : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}) {
      const Vector3d point =
          pitch + ((sun ? stage_.sun_face : stage_.ring_face).middle + z * width / 2) * Vector3d::UnitZ();
      const double approach = normal.dot(moved(q, driving, point) - moved(q, driven, point));
      sum += stiffness / places * approach * approach / 2;
    }
    return sum;
  }

  const SpatialStage& stage_;
};

SpatialStage with_planets(double helix, int planets) {
  auto s = stages::reliability_stage(helix * units::deg);
  s.plane.planet_angles.clear();
  for (int n = 0; n < planets; ++n) s.plane.planet_angles.push_back(2 * pi * n / planets);
  add_all_bearings(s);
  return s;
}

// Modes of a stage in which every body has its six degrees of freedom. The kinds and their numbers are those of
// [EritenelParker2009]: 12 rotational-axial modes, 12 pairs of translational-tilting ones, 6 groups of planet modes.
BOOST_AUTO_TEST_CASE(modes_are_those_of_rigid_bodies_with_exact_rotations) {
  annulus::test::Verification record("Modes of a stage in space", "potential of rigid bodies with exact rotations");
  for (const auto& [helix, planets] : {std::pair{7.5, 3}, {-20.0, 4}, {0.0, 3}}) {
    auto s = with_planets(helix, planets);
    auto stage = lumped(s);
    const auto found = modes(stage);
    const Eigen::Index size = 6 * (3 + planets);
    Eigen::VectorXd mass(size), step(size);
    for (Eigen::Index b = 0; b < 3 + planets; ++b) {
      const auto& p = stage;
      const double m = b == 0 ? p.sun.mass : b == 1 ? p.ring.mass : b == 2 ? p.carrier.mass : p.planet.mass;
      const double across = b == 0 ? 2.1 : b == 1 ? 90 : b == 2 ? 110 : 1.9;
      const double about = b == 0   ? p.sun.inertia
                           : b == 1 ? p.ring.inertia
                           : b == 2 ? p.carrier.inertia
                                    : p.planet.inertia;
      mass.segment<6>(6 * b) << m, m, m, across, across, about;
      step.segment<6>(6 * b) << 1e-4, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3;
    }
    // The rotation of the ring is rigid.
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < size; ++i)
      if (i != 6 + 5) kept.push_back(i);
    const Eigen::MatrixXd k =
        second_derivatives([&](const Eigen::VectorXd& q) { return RigidBodies(s).energy(q); }, step)(kept, kept);
    const Eigen::VectorXd root = mass(kept).cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(root.asDiagonal() * k * root.asDiagonal());
    BOOST_REQUIRE(static_cast<Eigen::Index>(found.modes.size()) == std::ssize(kept));
    const double highest = std::sqrt(solver.eigenvalues().maxCoeff()) / (2 * pi);
    std::map<ModeKind, int> kinds;
    for (std::size_t i = 0; i < found.modes.size(); ++i) {
      const double expected = std::sqrt(std::max(0.0, solver.eigenvalues()[static_cast<Eigen::Index>(i)])) / (2 * pi);
      if (expected > 1e-3 * highest)
        record.close("natural frequencies with three and four planets", "Hz", found.modes[i].frequency, expected, 1e-4,
                     "central differences");
      ++kinds[found.kinds[i]];
    }
    // The carrier and all that it drives turn freely.
    BOOST_TEST(found.modes.front().frequency == 0);
    BOOST_TEST(kinds[ModeKind::rotational] == 11);  // the ring does not turn
    BOOST_TEST(kinds[ModeKind::translational] == 24);
    BOOST_TEST(kinds[ModeKind::planet] == 6 * (planets - 3));
    BOOST_TEST(kinds[ModeKind::mixed] == 0);
  }
}

// A free round rotor, seen from a frame that turns at another speed: whirl at I_p spin / I_t and none in the housing.
BOOST_AUTO_TEST_CASE(gyroscopic_moments_of_a_tilting_rotor) {
  annulus::test::Verification record("Tilting rotor in a turning frame", "closed form");
  for (const auto& [across, about, spin, speed, stiffness] :
       {std::array{0.8, 1.3, 900.0, 0.0, 0.0}, {0.8, 1.3, 900.0, -250.0, 0.0}, {2.0, 0.7, -400.0, 120.0, 3e6}}) {
    LumpedSystemBuilder builder;
    const auto x = builder.add_dof("tiltx"), y = builder.add_dof("tilty");
    builder.add_tilting_mass(x, y, across, about, spin, speed);
    for (const auto& form : {x, y}) builder.add_spring(form, stiffness, 0, "bearing");
    const auto system = builder.build();
    Eigen::Matrix4d state = Eigen::Matrix4d::Zero();
    state.topRightCorner<2, 2>().setIdentity();
    state.bottomLeftCorner<2, 2>() = -system.mass().inverse() * (system.stiffness() + system.rotating_stiffness());
    state.bottomRightCorner<2, 2>() = -system.mass().inverse() * system.gyroscopic();
    const Eigen::VectorXcd found = eigenvalues(state, "a rotor");
    // I_t w^2 - I_p spin w - k = 0 in the housing; w - speed in the frame.
    const double b = about * spin / (2 * across), root = std::sqrt(b * b + stiffness / across);
    for (const double w : {b + root, b - root}) {
      double nearest = 1e300;
      for (const auto& value : found)
        nearest = std::min({nearest, std::abs(value - std::complex<double>(0, w - speed))});
      record.at_most("whirl over the largest rate", "", nearest / (std::abs(b) + root + std::abs(speed)), 1e-7,
                     "double eigenvalues");
    }
  }
}

// A stage that leans in the housing as a whole while it turns needs no force but in its bearings on the housing, which
// it does not have here: spins, orbits of planets and their centrifugal preload take part.
BOOST_AUTO_TEST_CASE(a_turning_stage_leans_freely) {
  annulus::test::Verification record("Leaning of a turning stage", "rigid motion in the housing");
  auto s = with_planets(7.5, 3);
  s.plane.carrier_speed = 400 * units::rpm;
  auto stage = lumped(s);
  stage.support_damping_ratio = stage.mesh_damping_ratio = 0;
  std::erase_if(stage.space->bearings, [](const LinearBearing& b) { return b.on.kind == Kind::housing; });
  const auto system = assemble(stage);
  const double speed = stage.carrier_speed, a = stage.carrier.radius;
  // Of a tilt (about x, about y) of everything.
  const auto motion = [&](const Eigen::Vector2d& tilt) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(system.dofs());
    for (const auto& [name, radius] : {std::pair<std::string, double>{"sun", stage.sun.radius},
                                       {"ring", stage.ring.radius},
                                       {"carrier", stage.carrier.radius}}) {
      q[system.find(name + "_tiltx")] = radius * tilt[0];
      q[system.find(name + "_tilty")] = radius * tilt[1];
    }
    for (int n = 0; n < 3; ++n) {
      const double phi = stage.planet_angles[static_cast<std::size_t>(n)];
      const auto name = "planet" + std::to_string(n + 1);
      const double radial = std::cos(phi) * tilt[0] + std::sin(phi) * tilt[1];
      const double tangential = -std::sin(phi) * tilt[0] + std::cos(phi) * tilt[1];
      q[system.find(name + "_tiltx")] = stage.planet.radius * radial;
      q[system.find(name + "_tilty")] = stage.planet.radius * tangential;
      q[system.find(name + "_z")] = -a * tangential;
    }
    return q;
  };
  const Eigen::Vector2d tilt(0.6e-3, -0.3e-3), rate(speed * tilt[1], -speed * tilt[0]);
  const Eigen::VectorXd q = motion(tilt), v = motion(rate), w = -speed * speed * q;
  const Eigen::MatrixXd stiffness = stiffness_with_meshes(system, mean_tangents(system));
  const Eigen::VectorXd inertia = system.mass() * w;
  const Eigen::VectorXd rest = inertia + system.gyroscopic() * v + (stiffness + system.rotating_stiffness()) * q;
  record.at_most("forces left over, of the largest inertia force", "",
                 rest.cwiseAbs().maxCoeff() / inertia.cwiseAbs().maxCoeff(), 1e-6, "rounding of stiff springs");
}

// Bodies held in the middle of a spur face neither move along the axis nor tilt: the response is that of the plane.
BOOST_AUTO_TEST_CASE(response_of_a_symmetric_spur_stage_is_that_of_the_plane) {
  annulus::test::Verification record("Response of a stage in space", "plane model");
  auto plane = stages::ring_paper();
  auto space = plane;
  StageSpace s;
  s.planet_working_radius_sun = 0.201 * 55 / (48 + 55);
  s.planet_working_radius_ring = 0.201 * 55 / (162 - 55);
  s.sun_face.width = s.ring_face.width = 0.088;
  s.tilt_inertia = {0.1, 1, 2, 0.1};
  const auto support = [&](StageBody body, StageBody on, double x, double y) {
    LinearBearing b{.name = "support", .body = body, .on = on};
    for (const auto& [i, value] : {std::pair{0, x}, {1, y}}) {
      if (value == rigid)
        b.rigid.at(static_cast<std::size_t>(i)) = true;
      else
        b.stiffness(i, i) = value;
    }
    b.stiffness(2, 2) = 1e9;
    b.stiffness(3, 3) = b.stiffness(4, 4) = 1e6;
    s.bearings.push_back(b);
  };
  support({Kind::sun}, {}, plane.sun.support, plane.sun.support);
  support({Kind::ring}, {}, plane.ring.support, plane.ring.support);
  support({Kind::carrier}, {}, plane.carrier.support, plane.carrier.support);
  for (int n = 0; n < plane.planets(); ++n)
    support({Kind::planet, n}, {Kind::carrier}, plane.planet_bearing(n).radial, plane.planet_bearing(n).tangential);
  space.space = s;
  SimulationOptions options;
  options.samples_per_cycle = 32;
  options.keep_series = true;
  const auto expected = simulate(plane, options), found = simulate(space, options);
  BOOST_TEST(found.steady);
  BOOST_TEST(found.confirmed);
  const auto rows = expected.series.force.rows();
  record.at_most(
      "mesh forces over a period, of the mean force", "",
      (found.series.force.topRows(rows) - expected.series.force).cwiseAbs().maxCoeff() / expected.mean_mesh_force, 2e-3,
      "accuracy of both");
  record.close("dynamic factor", "", found.sun_planet.branches[0].dynamic_factor.value,
               expected.sun_planet.branches[0].dynamic_factor.value, 1e-3, "accuracy of both");
  BOOST_TEST(found.series.force.bottomRows(rows).cwiseAbs().maxCoeff() < 1e-6 * expected.mean_mesh_force);
}

// A helical stage whose stiffness changes: harmonic balance and time integration find the same motion, and the time
// integration keeps the balance of energy.
BOOST_AUTO_TEST_CASE(helical_response_by_two_methods) {
  annulus::test::Verification record("Response of a helical stage in space", "time integration, balance of energy");
  auto s = with_planets(7.5, 3);
  s.bearings[6].play = 150e-6;
  auto stage = lumped(s);
  const double c2 = std::pow(std::cos(s.base_helix_angle), 2);
  stage.sun_mesh = HarmonicStiffness{sun_stiffness * c2, 0.1, 0};
  stage.ring_mesh = HarmonicStiffness{ring_stiffness * c2, 0.05, 0.2};
  for (int n = 0; n < 3; ++n) {
    stage.sun_phase_lag.push_back(0.3 * n);
    stage.ring_phase_lag.push_back(0.2 * n);
    stage.ring_tooth_offset.push_back(0);
  }
  stage.carrier_speed = 120 * units::rpm;
  stage.mesh_damping_ratio = 0.05;
  stage.support_damping_ratio = 0.04;
  SimulationOptions options;
  options.samples_per_cycle = 64;
  options.integrator.relative_tolerance = 1e-7;
  const auto found = simulate(stage, options);
  BOOST_TEST(found.confirmed);
  record.at_most("difference of harmonic balance and time integration, of the mean force", "", *found.steady_difference,
                 1e-3, "tolerance of the steady state");
  record.at_most("balance of energy", "", found.energy.relative, 1e-4, "tolerance of the integrator");
  record.at_most("balance of the sun's torque", "", found.force_balance_relative, 1e-4, "tolerance of the integrator");
  BOOST_TEST(found.sun_planet.branches[0].dynamic_factor.value > 1.005);
  // The Jacobian in a state of partial contact, by differences.
  const auto system = assemble(stage);
  auto workspace = system.workspace();
  const int n = system.dofs();
  Eigen::VectorXd y = Eigen::VectorXd::Zero(2 * n);
  y.head(n) = found.series.displacement.col(3);
  y.tail(n) = found.series.velocity.col(3);
  y[system.find("planet2_tiltx")] += 3e-4;
  y[system.find("sun_tilty")] -= 2e-4;
  Eigen::MatrixXd jacobian(2 * n, 2 * n);
  system.jacobian(0.01, y.data(), jacobian, workspace);
  Eigen::VectorXd up(2 * n), down(2 * n);
  double worst = 0;
  for (int i = 0; i < 2 * n; ++i) {
    const double step = i < n ? 1e-9 : 1e-6;
    Eigen::VectorXd there = y;
    there[i] += step;
    system.rhs(0.01, there.data(), up.data(), workspace);
    there[i] -= 2 * step;
    system.rhs(0.01, there.data(), down.data(), workspace);
    const Eigen::VectorXd column = (up - down) / (2 * step);
    worst = std::max(worst, (column - jacobian.col(i)).cwiseAbs().maxCoeff() / jacobian.col(i).cwiseAbs().maxCoeff());
  }
  record.at_most("Jacobian against differences, of the largest of its column", "", worst, 1e-5, "differences");
}

// Solid gears along their face: straight flanks have the force of the whole mesh, and the moment of their course.
BOOST_AUTO_TEST_CASE(moment_of_a_face_that_moves_its_load) {
  annulus::test::Verification record("Face with a course", "closed form; balance of energy");
  annulus::FaceShape shape;
  constexpr int phases = 16;
  for (int i = 0; i < phases; ++i) {
    const double angle = 2 * pi * i / phases;
    shape.slope.push_back(0.05 + 0.3 * std::cos(angle));
    shape.curvature.push_back(0.2 + 0.1 * std::sin(angle));
    shape.gap_slope.push_back(2e-6 + 3e-6 * std::sin(angle + 1));
  }
  const auto curve = [](const std::vector<double>& values) { return annulus::PeriodicCurve(values, phases); };
  constexpr double stiffness = 5e8, frequency = 100, deflection = 40e-6, half = 20e-6;
  LumpedSystemBuilder builder;
  const auto u = builder.add_dof("u");
  builder.add_mass(u, 1);
  MeshElement mesh;
  mesh.name = "mesh";
  mesh.b = u;
  mesh.excitation = ConstantStiffness{stiffness};
  mesh.frequency = frequency;
  mesh.phase_offset = 0.3;
  builder.add_mesh(mesh);
  mesh.name = "mesh_tilt";
  mesh.b = {};
  mesh.excitation = ConstantStiffness{stiffness / 3};
  builder.add_mesh(mesh);
  FaceElement face{0, 1, half, {}, {}};
  for (const auto& place : face_places()) face.places.push_back({place.z, place.weight, 0});
  face.course = {curve(shape.slope), curve(shape.curvature), curve(shape.gap_slope)};
  builder.add_face(face);
  const auto system = builder.build();
  auto workspace = system.workspace();
  const double y[2] = {deflection, 0};
  for (const double t : {0.0, 0.0013, 0.0071}) {
    system.evaluate_meshes(t, y, y + 1, workspace);
    const double phase = frequency * t + 0.3;
    const double slope = face.course->slope(phase), curvature = face.course->curvature(phase);
    const double gap = face.course->gap_slope(phase);
    const double mean = slope / 3, square = 1.0 / 3 + 2.0 / 15 * curvature;
    const double force = stiffness * (deflection - half);
    record.close("force", "N", workspace.force[0], force, 1e-12, "rounding");
    record.near("moment over half the face width", "N", workspace.force[1],
                force * mean - stiffness * gap * (square - mean * mean), 1e-9 * force, "rounding");
    // dE/dt at rest is what the changing face supplies.
    const double step = 1e-7;
    const double after = system.energy(t + step, y, workspace), before = system.energy(t - step, y, workspace);
    system.evaluate_meshes(t, y, y + 1, workspace);
    record.near("power that the changing face supplies, over force x deflection x frequency", "",
                system.power(t, y, workspace).supplied / (force * deflection * frequency),
                (after - before) / (2 * step) / (force * deflection * frequency), 1e-6, "differences");
  }
}

// A helical stage whose faces move their load: two methods agree, energy is balanced, and tilting bearings feel it.
BOOST_AUTO_TEST_CASE(shuttling_forces_of_a_helical_stage) {
  annulus::test::Verification record("Shuttling forces", "harmonic balance and time integration");
  auto stage = lumped(with_planets(7.5, 3));
  auto shape = std::make_shared<annulus::FaceShape>();
  constexpr int phases = 16;
  for (int i = 0; i < phases; ++i) {
    const double angle = 2 * pi * i / phases;
    shape->slope.push_back(0.2 * std::cos(angle));
    shape->curvature.push_back(0.3);
    shape->gap_slope.push_back(3e-6 * std::sin(angle));
  }
  stage.carrier_speed = 60 * units::rpm;
  stage.mesh_damping_ratio = 0.05;
  stage.support_damping_ratio = 0.04;
  SimulationOptions options;
  options.integrator.relative_tolerance = 1e-7;
  const auto even = simulate(stage, options);
  stage.space->sun_face.shape = stage.space->ring_face.shape = shape;
  const auto found = simulate(stage, options);
  BOOST_TEST(found.confirmed);
  record.at_most("difference of both methods, of the mean force", "", *found.steady_difference, 1e-3,
                 "tolerance of the steady state");
  record.at_most("balance of energy", "", found.energy.relative, 1e-4, "tolerance of the integrator");
  // The stiffness does not change, and without shuttling nothing moves.
  const auto ripple = [&](const DynamicResponse& response) {
    const auto motion = space_motion(stage, response.series);
    const Eigen::RowVectorXd force = motion.bearings[0].force.row(0);
    return (force.maxCoeff() - force.minCoeff()) / response.mean_mesh_force;
  };
  BOOST_TEST(ripple(even) < 1e-6);
  BOOST_TEST(ripple(found) > 1e-3);
}

// Planets in the supports of the plane, with clearance: the pins bear what the planets' bearings do.
BOOST_AUTO_TEST_CASE(pin_forces_of_planets_with_clearance) {
  auto s = stages::reliability_stage(7.5 * units::deg);
  add_all_bearings(s);
  s.bearings.erase(s.bearings.begin(), s.bearings.begin() + 6);
  s.plane.planet_bearings = {{2e9, 2e9, 20e-6}};
  for (const auto laws : {BearingLaws::tangents, BearingLaws::whole}) {
    auto stage = lumped(s);
    stage.space->laws = laws;
    stage.carrier_speed = 10 * units::rpm;
    stage.mesh_damping_ratio = 0.05;
    stage.support_damping_ratio = 0.04;
    SimulationOptions options;
    options.keep_series = true;
    const auto found = simulate(stage, options);
    const auto pins = bearing_forces(stage, found.series);
    for (const auto& b : space_motion(stage, found.series).bearings) {
      if (b.body.kind != Kind::planet) continue;
      const Eigen::Index n = b.body.planet;
      const double size = pins.tangential.row(n).cwiseAbs().maxCoeff();
      BOOST_TEST(size > 1e5);
      BOOST_TEST((pins.radial.row(n) + b.force.row(0)).cwiseAbs().maxCoeff() < 1e-4 * size);
      BOOST_TEST((pins.tangential.row(n) + b.force.row(1)).cwiseAbs().maxCoeff() < 1e-4 * size);
    }
  }
}

// The ring couples its meshes: the same forces as the mechanism of the statics, which solves for them otherwise.
BOOST_AUTO_TEST_CASE(coupled_meshes_in_space) {
  annulus::test::Verification record("Coupled ring meshes in space", "statics of the mechanism");
  auto s = with_planets(7.5, 3);
  s.plane.carrier_speed = 0;  // no centrifugal forces
  s.plane.planet_errors.assign(3, {});
  s.plane.planet_errors[2].position = {40e-6, 1.7};
  auto coupling = std::make_shared<annulus::RingCoupling>();
  coupling->planets = 3;
  coupling->ring_teeth = 99;
  coupling->per_cycle = 1;
  Eigen::Matrix3d compliance;
  compliance << 5e-11, -2e-11, -1e-11, -2e-11, 6e-11, -2e-11, -1e-11, -2e-11, 5e-11;
  coupling->compliance = {compliance};
  s.plane.ring_coupling = coupling;
  const auto expected = statics(s).positions.front();
  const auto stage = lumped(s);
  const auto found = solved(stage);
  for (std::size_t m = 0; m < 6; ++m) {
    const auto& mesh = m < 3 ? expected.sun_meshes[m] : expected.ring_meshes[m - 3];
    record.close("mesh forces", "N", found.force[m], mesh.force, 1e-8, "residual of the equilibria");
    record.at_most("moment along the face over force x face width", "",
                   std::abs(found.tilt[m] * (m < 3 ? sun_width : ring_width) / 2 - mesh.force * mesh.place) /
                       std::abs(mesh.force * ring_width),
                   1e-8, "residual of the equilibria");
  }
}

// The shaft of a carrier passes on its torque, whatever the bearings of the planets bear that stand on it.
BOOST_AUTO_TEST_CASE(rotor_on_a_carrier) {
  auto s = stages::reliability_stage(7.5 * units::deg);
  add_all_bearings(s);
  auto stage = lumped(s);
  stage.rotors = {{.name = "blades", .on = "carrier", .inertia = 1e5, .shaft_stiffness = 1e8}};
  const auto system = assemble(stage);
  const double torque = stage.carrier_torque(), radius = stage.carrier.radius;
  BOOST_TEST(std::abs(system.load()[system.find("blades_u")] * radius + torque) <= 1e-9 * torque);
  StaticSolver solver(system);
  auto workspace = system.workspace();
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(system.dofs());
  system.detect_contact(0, start.data(), workspace);
  (void)solver.solve(0, workspace);
  const auto shaft = std::find_if(system.meshes().begin(), system.meshes().end(),
                                  [](const auto& mesh) { return mesh.name == "blades_shaft"; });
  BOOST_TEST_REQUIRE((shaft != system.meshes().end()));
  const double passed = workspace.force[static_cast<std::size_t>(shaft - system.meshes().begin())] * radius;
  BOOST_TEST(std::abs(passed - torque) <= 1e-8 * torque);
}

BOOST_AUTO_TEST_CASE(what_does_not_fit_is_refused) {
  auto s = with_planets(7.5, 3);
  auto stage = lumped(s);
  const auto message = [&](const PlanetaryStage& wrong) {
    try {
      (void)assemble(wrong);
    } catch (const annulus::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  auto wrong = stage;
  wrong.space->tilt_inertia.ring = 0;
  BOOST_TEST(message(wrong).find("tilting inertia of the ring") != std::string::npos, message(wrong));
  wrong = stage;
  wrong.space->bearings.back().on = {Kind::carrier};
  wrong.space->bearings.back().rigid[2] = true;
  BOOST_TEST(message(wrong).find("stands rigidly on the carrier") != std::string::npos, message(wrong));
  wrong = stage;
  wrong.space->sun_face.gap = {0, 0};
  BOOST_TEST(message(wrong).find("2 gaps for 20 places") != std::string::npos, message(wrong));
}

BOOST_AUTO_TEST_SUITE_END()
