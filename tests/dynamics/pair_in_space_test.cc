#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/errors.h"
#include "dynamics/spatial/elastic_laws.h"
#include "dynamics/spatial/even_face.h"
#include "dynamics/statics/static_solver.h"
#include "dynamics/systems/helical_pair/pair_response.h"
#include "dynamics/systems/helical_pair/spatial_pair.h"
#include "tests/dynamics/pairs.h"
#include "tests/dynamics/second_derivatives.h"
#include "tests/dynamics/spatial_stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(pair_in_space)

using namespace annulus::dynamics;
using Eigen::Vector3d;
using Kind = StageBody::Kind;
using stages::bearing;
namespace units = annulus::units;

namespace {

constexpr double pi = std::numbers::pi, width = 0.15, working_angle = 21 * units::deg;

double working_radius(const PairGear& gear) { return gear.radius / std::cos(working_angle); }

SpatialPair spatial(const HelicalPair& pair, std::vector<StageBearing> bearings) {
  SpatialPair s;
  s.base_helix_angle = pair.base_helix_angle;
  s.working_angle = working_angle;
  s.working_radius_pinion = working_radius(pair.pinion);
  s.working_radius_wheel = working_radius(pair.wheel);
  s.pinion_torque = pair.pinion_torque;
  s.stiffness = mean_stiffness(pair.mesh);
  s.face.width = width;
  s.bearings = std::move(bearings);
  return s;
}

constexpr double tilting_pinion = 3, tilting_wheel = 40;

HelicalPair lumped(HelicalPair pair, const SpatialPair& s, BearingLaws laws = BearingLaws::tangents) {
  pair.working_angle = s.working_angle;
  pair.space = pair_about_equilibrium(s, tilting_pinion, tilting_wheel);
  pair.space->laws = laws;
  return pair;
}

/// Bearings on either side, unlike, with an overhung pinion.
std::vector<StageBearing> unlike_bearings() {
  auto list = std::vector{
      bearing("near", {Kind::pinion}, {}, 0.12, 2e9, 5e8), bearing("far", {Kind::pinion}, {}, 0.4, 1e9),
      bearing("left", {Kind::wheel}, {}, -0.2, 2e9, 8e8, 1e6), bearing("right", {Kind::wheel}, {}, 0.3, 1.5e9)};
  list[1].y = 1.4e9;
  return list;
}

HelicalPair linear_pair() {
  auto pair = pairs::error_paper();
  pair.mesh = ConstantStiffness{mean_stiffness(pair.mesh)};
  pair.mesh_error = pair.pinion.error = pair.wheel.error = {};
  return pair;
}

struct Solved {
  Eigen::VectorXd q;
  double force = 0, tilt = 0;
};
Solved solved(const HelicalPair& pair) {
  const auto system = assemble(pair);
  StaticSolver solver(system);
  auto workspace = system.workspace();
  const Eigen::VectorXd q = solver.solve(0, workspace);
  return {q, workspace.force[0], workspace.force[1]};
}

/// Potential energy of the pair at any motion, with exact rotations: q is x, y, z and rotation vector of pinion and
/// wheel in the axes of the housing.
class RigidPair {
 public:
  RigidPair(const HelicalPair& pair, const SpatialPair& space) : pair_(pair), space_(space) {}

  [[nodiscard]] double energy(const Eigen::VectorXd& q) const {
    double sum = 0;
    for (const auto& b : space_.bearings) {
      const int body = b.body.kind == Kind::pinion ? 0 : 1;
      const Vector3d point = b.place * Vector3d::UnitZ();
      const Vector3d d = moved(q, body, point) - point, tilt = q.segment<3>(6 * body + 3);
      sum += (b.x * d[0] * d[0] + b.y * d[1] * d[1] + b.axial * d[2] * d[2] +
              b.tilt * (tilt[0] * tilt[0] + tilt[1] * tilt[1])) /
             2;
    }
    const Vector3d line(std::sin(working_angle), std::cos(working_angle), 0);
    const Vector3d normal =
        std::cos(pair_.base_helix_angle) * line - std::sin(pair_.base_helix_angle) * Vector3d::UnitZ();
    for (const double z : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}) {  // Gauss: exact for squares
      const Vector3d along = (space_.face.middle + z * width / 2) * Vector3d::UnitZ();
      const Vector3d first = working_radius(pair_.pinion) * Vector3d::UnitX() + along;
      const Vector3d second = -working_radius(pair_.wheel) * Vector3d::UnitX() + along;
      const double approach = normal.dot(moved(q, 0, first) - first - moved(q, 1, second) + second);
      sum += mean_stiffness(pair_.mesh) / 2 * approach * approach / 2;
    }
    return sum;
  }

 private:
  static Vector3d moved(const Eigen::VectorXd& q, int body, const Vector3d& point) {
    const Vector3d rotation = q.segment<3>(6 * body + 3);
    const double angle = rotation.norm();
    const Vector3d axis = angle > 0 ? Vector3d(rotation / angle) : Vector3d(Vector3d::UnitZ());
    return q.segment<3>(6 * body) + Eigen::AngleAxisd(angle, axis) * point;
  }

  const HelicalPair& pair_;
  const SpatialPair& space_;
};

}  // namespace

// Both gears with six degrees of freedom.
BOOST_AUTO_TEST_CASE(modes_are_those_of_rigid_bodies_with_exact_rotations) {
  annulus::test::Verification record("Modes of a helical pair in space",
                                     "potential of rigid bodies with exact rotations");
  for (const double sign : {1.0, -1.0}) {
    auto pair = linear_pair();
    pair.base_helix_angle *= sign;
    pair.pinion_speed = 0;
    auto s = spatial(pair, unlike_bearings());
    s.face.middle = 0.01;
    const RigidPair bodies(pair, s);
    constexpr Eigen::Index size = 12;
    Eigen::VectorXd mass(size), step(size);
    for (const Eigen::Index first : {0, 6}) {
      const auto& gear = first == 0 ? pair.pinion : pair.wheel;
      const double across = first == 0 ? tilting_pinion : tilting_wheel;
      mass.segment<6>(first) << gear.mass, gear.mass, gear.mass, across, across, gear.inertia;
      step.segment<6>(first) << 1e-4, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3;
    }
    const auto k = second_derivatives([&](const Eigen::VectorXd& q) { return bodies.energy(q); }, step);
    // The mass of the pinion is beside its middle, where the tilting inertia counts from.
    constexpr double off = 0.08;
    Eigen::MatrixXd inertia = mass.asDiagonal();
    inertia(0, 4) = inertia(4, 0) = pair.pinion.mass * off;
    inertia(1, 3) = inertia(3, 1) = -pair.pinion.mass * off;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(k, inertia);
    auto made = lumped(pair, s);
    made.space->mass_place_pinion = off;
    const auto found = annulus::dynamics::modes(made).modes;
    BOOST_TEST_REQUIRE(found.size() == 12U);
    BOOST_TEST(found.front().frequency == 0);
    for (std::size_t i = 1; i < found.size(); ++i)
      record.close("natural frequencies, right- and left-handed", "Hz", found[i].frequency,
                   std::sqrt(solver.eigenvalues()[static_cast<Eigen::Index>(i)]) / (2 * pi), 1e-4,
                   "central differences");
  }
}

// Gears in their bearings alone: every mode has the damping ratio of the supports, also about a centre of mass beside
// the middle.
BOOST_AUTO_TEST_CASE(modes_in_bearings_have_the_damping_of_supports) {
  annulus::test::Verification record("Modes of a helical pair in space", "modal damping");
  auto pair = linear_pair();
  pair.pinion_speed = 0;
  pair.bearing_damping_ratio = 0.05;
  auto made = lumped(pair, spatial(pair, unlike_bearings()));
  made.space->mass_place_pinion = 0.08;
  made.space->mass_place_wheel = -0.03;
  const auto system = assemble(made);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(system.stiffness(), system.mass());
  const Eigen::MatrixXd damping = modes.eigenvectors().transpose() * system.damping() * modes.eigenvectors();
  const double fastest = std::sqrt(modes.eigenvalues().maxCoeff());
  int damped = 0;
  for (Eigen::Index i = 0; i < damping.rows(); ++i) {
    const double rate = std::sqrt(std::max(0.0, modes.eigenvalues()[i]));
    record.near("damping over its fastest rate", "", damping(i, i) / (2 * 0.05 * fastest), rate / fastest, 1e-8,
                "rounding of the eigenvalues");
    for (Eigen::Index j = 0; j < i; ++j)
      record.near("coupling of modes by dampers, over their fastest rate", "", damping(i, j) / (2 * 0.05 * fastest), 0,
                  1e-8, "rounding of the eigenvalues");
    damped += rate > 1e-3 * fastest;
  }
  BOOST_TEST(damped == 10);  // the gears turn freely
}

// Two bearings of the pinion share the force of the mesh and its moment by statics, wherever along the face it stands.
BOOST_AUTO_TEST_CASE(reactions_of_two_bearings) {
  annulus::test::Verification record("Statics of a helical pair in space", "equilibrium of the pinion");
  for (const bool with_load : {false, true}) {
    const auto plain = linear_pair();
    auto s = spatial(plain, unlike_bearings());
    if (with_load) {
      s.loads = {{"belt", {Kind::pinion}, StageFrame::housing, {0, 0, 0.5}, {3e3, -2e3, 1e3}, {50, 20, 0}}};
      s.weights = {{{Kind::pinion}, plain.pinion.mass, 0.02}, {{Kind::wheel}, plain.wheel.mass, 0}};
      s.gravity = {0, -9.81, 0};
    }
    const auto pair = lumped(plain, s);
    const auto found = solved(pair);
    const auto system = assemble(pair);
    const auto at = [&](const char* name) { return found.q[system.find(name)]; };
    record.close("mesh force", "N", found.force, plain.static_force(), 1e-9, "residual of the equilibrium");
    // Of the pinion about its middle, in the axes of the lumped model: y along the line of action.
    const double c = std::cos(plain.base_helix_angle), sine = std::sin(plain.base_helix_angle);
    const double place = found.tilt * (width / 2) / found.force;
    const Vector3d normal(0, c, -sine);  // on the wheel
    const Vector3d pitch_point(std::cos(working_angle) * working_radius(plain.pinion),
                               std::sin(working_angle) * working_radius(plain.pinion), place);
    Vector3d force = -found.force * normal;
    Vector3d moment = pitch_point.cross(force);
    Eigen::Matrix3d axes;  // of the lumped model, as columns
    axes << std::cos(working_angle), std::sin(working_angle), 0, -std::sin(working_angle), std::cos(working_angle), 0,
        0, 0, 1;
    const auto add = [&](const Vector3d& point, const Vector3d& f, const Vector3d& m) {
      force += axes.transpose() * f;
      moment += axes.transpose() * (point.cross(f) + m);
    };
    for (const auto& load : s.loads) add(load.point, load.force, load.moment);
    if (with_load) add({0, 0, 0.02}, {0, -9.81 * plain.pinion.mass, 0}, {0, 0, 0});
    // Radial stiffnesses of "far" differ between the directions of the housing.
    Eigen::Matrix2d far = Eigen::Vector2d(1e9, 1.4e9).asDiagonal();
    far = axes.topLeftCorner<2, 2>().transpose() * far * axes.topLeftCorner<2, 2>();
    const Eigen::Vector2d middle(at("pinion_x"), at("pinion_y"));
    const Eigen::Vector2d tilt = Eigen::Vector2d(at("pinion_tiltx"), at("pinion_tilty")) / plain.pinion.radius;
    const auto displaced = [&](double z) { return Eigen::Vector2d(middle + z * Eigen::Vector2d(tilt[1], -tilt[0])); };
    const Eigen::Vector2d near = 2e9 * displaced(0.12), of_far = far * displaced(0.4);
    const double size = found.force;
    record.at_most("forces across the axis", "", (near + of_far - force.head<2>()).norm() / size, 1e-9,
                   "residual of the equilibrium");
    record.at_most("axial force", "", std::abs(5e8 * at("pinion_z") - force[2]) / size, 1e-9,
                   "residual of the equilibrium");
    const Eigen::Vector2d tilting(-0.12 * near[1] - 0.4 * of_far[1], 0.12 * near[0] + 0.4 * of_far[0]);
    record.at_most("moments across the axis over the force", "m", (tilting - moment.head<2>()).norm() / size, 1e-9,
                   "residual of the equilibrium");
    // The approach of the flanks rises along the face by as much as the gears tilt against each other.
    const double slope = -c * (at("pinion_tiltx") / plain.pinion.radius - at("wheel_tiltx") / plain.wheel.radius);
    record.close("moment along the face", "N m", found.force * place,
                 mean_stiffness(plain.mesh) * slope * width * width / 12, 1e-6, "places on the face");
  }
}

// Spur gears in bearings on either side have no reason to leave the plane; helical ones on one bearing that does not
// tilt are the model of the paper.
BOOST_AUTO_TEST_CASE(the_plane_is_a_setting) {
  annulus::test::Verification record("Plane pair as a pair in space", "plane model");
  const auto compare = [&](const HelicalPair& plane, const SpatialPair& s, const char* name) {
    const auto in_space = lumped(plane, s);
    const auto found = annulus::dynamics::modes(in_space).modes;
    for (const auto& mode : annulus::dynamics::modes(plane).modes) {
      double nearest = 1e300;
      for (const auto& other : found)
        if (std::abs(other.frequency - mode.frequency) < std::abs(nearest - mode.frequency)) nearest = other.frequency;
      record.near(std::string("natural frequencies, ") + name, "Hz", nearest, mode.frequency,
                  1e-9 * std::max(1.0, mode.frequency), "rounding");
    }
    const auto expected = evaluate_pair(plane), response = evaluate_pair(in_space);
    record.close(std::string("largest force, ") + name, "N", response.force_max.value, expected.force_max.value, 1e-6,
                 "tolerance of the harmonic balance");
    record.close(std::string("transmission error, ") + name, "m",
                 response.dynamic.transmission_error.peak_to_peak.value,
                 expected.dynamic.transmission_error.peak_to_peak.value, 1e-5, "tolerance of the harmonic balance");
  };
  auto paper = pairs::error_paper();
  compare(
      paper,
      spatial(
          paper,
          {bearing("pinion", {Kind::pinion}, {}, 0, paper.pinion.bearing_transverse, paper.pinion.bearing_axial, rigid),
           bearing("wheel", {Kind::wheel}, {}, 0, paper.wheel.bearing_transverse, paper.wheel.bearing_axial, rigid)}),
      "tilts held");
  auto spur = paper;
  spur.base_helix_angle = 0;
  spur.pinion.bearing_axial = spur.wheel.bearing_axial = rigid;
  std::vector<StageBearing> both;
  for (const double z : {-0.2, 0.2}) {
    both.push_back(bearing("p", {Kind::pinion}, {}, z, spur.pinion.bearing_transverse / 2, 1e9));
    both.push_back(bearing("w", {Kind::wheel}, {}, z, spur.wheel.bearing_transverse / 2, 1e9));
  }
  const auto s = spatial(spur, both);
  BOOST_TEST(s.reasons_for_space().empty());
  BOOST_TEST(assemble(lumped(spur, s)).find("pinion_tiltx") < 0);
  compare(spur, s, "spur gears");
}

// A clearance moves the gear until its bearing carries; it has its tangent there.
BOOST_AUTO_TEST_CASE(bearings_about_the_equilibrium) {
  annulus::test::Verification record("Helical pair in bearings with clearance", "equilibrium of the mechanism");
  const auto plain = linear_pair();
  auto linear = spatial(plain, unlike_bearings());
  auto loose = linear;
  loose.bearings[0].play = 40e-6;
  loose.bearings[0].load_zone = false;  // beyond the clearance it is the same spring
  const auto a = solved(lumped(plain, linear)), b = solved(lumped(plain, loose));
  record.close("mesh force", "N", b.force, a.force, 1e-8, "residual of the equilibrium");
  // The force of a stop points where the shaft has moved, 2e9 N/m beyond 40 um.
  const auto system = assemble(lumped(plain, loose));
  const auto at = [&](const char* name) { return b.q[system.find(name)]; };
  const Eigen::Vector2d d(at("pinion_x") + 0.12 * at("pinion_tilty") / plain.pinion.radius,
                          at("pinion_y") - 0.12 * at("pinion_tiltx") / plain.pinion.radius);
  BOOST_TEST(d.norm() > 40e-6);
  const auto pair = lumped(plain, loose);
  const auto& found = pair.space->bearings[0];
  const Eigen::Vector2d force = found.stiffness.topLeftCorner<2, 2>() * d + found.preload.head<2>();
  record.at_most("force of the bearing with clearance", "",
                 (force - 2e9 * (d - 40e-6 * d.normalized())).norm() / force.norm(), 1e-6,
                 "residual of the equilibrium");
}

/// Bearings of a pinion on rollers with clearance, and a wheel in clearances.
std::vector<StageBearing> loose_bearings() {
  auto list = unlike_bearings();
  list[0].row = stages::row_of_planets();
  list[0].axial_play = 15e-6;
  list[2].play = 40e-6;
  list[2].load_zone = false;
  list[3].play = 60e-6;
  return list;
}

// Bearings act by their law, wherever their stiffness for modes was taken: the equilibrium under another torque is that
// of the mechanism there.
BOOST_AUTO_TEST_CASE(bearings_act_by_their_law) {
  annulus::test::Verification record("Helical pair in bearings with clearance", "equilibrium of the mechanism");
  for (const double sign : {1.0, -1.0}) {
    auto pair = linear_pair();
    pair.base_helix_angle *= sign;
    auto heavier = pair;
    heavier.pinion_torque *= 2.5;
    auto about_less = lumped(pair, spatial(pair, loose_bearings()), BearingLaws::whole);
    about_less.pinion_torque = heavier.pinion_torque;
    const auto about_equilibrium = lumped(heavier, spatial(heavier, loose_bearings()), BearingLaws::whole);
    const auto a = solved(about_less), b = solved(about_equilibrium);
    const double size = b.q.cwiseAbs().maxCoeff();
    record.at_most("motions over the largest", "", (a.q - b.q).cwiseAbs().maxCoeff() / size, 1e-8,
                   "residual of the equilibrium");
    // The mechanism took its tangents in an equilibrium that it found by itself.
    const auto motions = bearing_coordinates(about_equilibrium);
    for (const std::size_t i : {0U, 3U}) {
      const auto& bearing = about_equilibrium.space->bearings[i];
      Eigen::VectorXd d(5);
      for (Eigen::Index c = 0; c < 5; ++c) {
        d[c] = 0;
        for (const auto& [dof, factor] : motions[i][static_cast<std::size_t>(c)]) d[c] += factor * b.q[dof];
      }
      const Eigen::Matrix2d turn = Eigen::Rotation2Dd(-bearing.law_axes).toRotationMatrix();
      d.head<2>() = (turn * d.head<2>()).eval();
      d.tail<2>() = (turn * d.tail<2>()).eval();
      const auto part = parts_of(*bearing.law, Motions::in_space).front();
      const auto tangent = part.law->at(d(part.coordinates)).tangent;
      record.close("radial stiffness of bearings, both directions", "N/m", tangent(0, 0) + tangent(1, 1),
                   bearing.stiffness(0, 0) + bearing.stiffness(1, 1), 1e-5, "residual of the equilibrium");
    }
    record.close("mesh force", "N", b.force, heavier.static_force(), 1e-9, "residual of the equilibrium");
  }
}

// With tangents the response states the largest difference to the law in the motion found.
BOOST_AUTO_TEST_CASE(deviation_of_the_tangents) {
  annulus::test::Verification record("Helical pair in bearings with clearance",
                                     "force of a stop over its displacement");
  constexpr double stiffness = 2e9, play = 40e-6;
  auto pair = linear_pair();
  pair.mesh = HarmonicStiffness{mean_stiffness(pair.mesh), 0.3, 0};
  auto s = spatial(pair, unlike_bearings());
  s.bearings[0].play = play;
  s.bearings[0].load_zone = false;
  const auto tangents = lumped(pair, s);
  SimulationOptions options;
  options.keep_series = true;
  const auto response = evaluate_pair(tangents, options);
  const auto& series = response.series;
  const auto& bearing = tangents.space->bearings[0];
  const auto motion = bearing_coordinates(tangents)[0];
  double largest = 0;
  for (Eigen::Index t = 0; t < series.time.size(); ++t) {
    Eigen::Vector2d d = Eigen::Vector2d::Zero();
    for (const std::size_t i : {0U, 1U})
      for (const auto& [dof, factor] : motion[i])
        d[static_cast<Eigen::Index>(i)] += factor * series.displacement(dof, t);
    const Eigen::Vector2d law = stiffness * (d - play * d.normalized());
    const Eigen::Vector2d tangent = bearing.stiffness.topLeftCorner<2, 2>() * d + bearing.preload.head<2>();
    largest = std::max(largest, (law - tangent).norm());
  }
  const auto found = space_motion(tangents, series).bearings[0].law_deviation;
  BOOST_TEST(found > 1e-4);
  record.close("largest difference over the mean mesh force", "", found, largest / series.force.row(0).mean(),
               stiffness_in_play * stiffness * play / largest, "1e-7 of the stiffness within the clearance");
  auto laws = tangents;
  laws.space->laws = BearingLaws::whole;
  const auto whole = evaluate_pair(laws, options);
  const auto forces = space_motion(laws, whole.series).bearings[0].force;
  // By its law the bearing has the force of the stop.
  double worst = 0;
  for (Eigen::Index t = 0; t < whole.series.time.size(); ++t) {
    Eigen::Vector2d d = Eigen::Vector2d::Zero();
    for (const std::size_t i : {0U, 1U})
      for (const auto& [dof, factor] : motion[i])
        d[static_cast<Eigen::Index>(i)] += factor * whole.series.displacement(dof, t);
    const Eigen::Vector2d law = stiffness * (d - play * d.normalized());
    const Eigen::Vector2d force = forces.col(t).head<2>();
    worst = std::max(worst, (force + law).norm() / law.norm());
  }
  record.at_most("force of the stop over its displacement", "", worst, 1e-6,
                 "1e-7 of the stiffness within the clearance");
}

BOOST_AUTO_TEST_CASE(what_does_not_fit_is_refused) {
  const auto plain = linear_pair();
  const auto refused = [&](auto change, const std::string& text) {
    auto s = spatial(plain, unlike_bearings());
    change(s);
    BOOST_CHECK_EXCEPTION((void)lumped(plain, s), annulus::InputError, [&](const auto& error) {
      BOOST_TEST_MESSAGE(error.what());
      return std::string(error.what()).find(text) != std::string::npos;
    });
  };
  refused([](auto& s) { s.bearings[0].body = {Kind::sun}; }, "names the sun");
  refused([](auto& s) { s.bearings[0].on = {Kind::wheel}; }, "stand on the housing");
  refused(
      [](auto& s) {
        s.bearings.resize(3);
        s.bearings.pop_back();
      },
      "nothing resists");
  auto heavy = lumped(plain, spatial(plain, unlike_bearings()));
  heavy.space->mass_place_pinion = 1;
  BOOST_CHECK_THROW((void)assemble(heavy), annulus::InputError);
  auto negative = lumped(plain, spatial(plain, unlike_bearings()));
  negative.pinion_torque = -1;
  BOOST_CHECK_THROW(negative.check(), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
