#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "core/errors.h"
#include "tests/dynamics/lumped_stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(housing)

using namespace annulus::dynamics;
using namespace stages::lumped_in_space;
namespace units = annulus::units;

namespace {

/// Numbers of add_all_bearings(), of three planets, that stand on the housing; the last one holds the ring.
const std::vector<std::size_t> on_housing{6, 7, 8, 9};

/// A helical stage on linear bearings, with weights and a load beside the axis.
SpatialStage stage() {
  auto s = stages::reliability_stage(7.5 * units::deg);
  s.gravity = {2, -9.5, 1};
  s.weights = {{{Kind::sun}, 180, 0.1}, {{Kind::ring}, 509, 0}, {{Kind::carrier}, 1500, -0.05}};
  add_all_bearings(s);
  s.loads = {{"rotor", {Kind::carrier}, StageFrame::housing, {0, 0, 0.1}, {0, 2e4, 4e4}, {1e4, 3e4, 0}}};
  s.plane.planet_errors.assign(3, {});
  s.plane.planet_errors[1].position = {60e-6, 0.7};
  return s;
}

/// Symmetric and positive definite, of the size of bearings; without a pattern.
HousingStructure housing_without_pattern(bool turns) {
  const Eigen::Index size = 20 + (turns ? 1 : 0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> entry(-1, 1);
  Eigen::MatrixXd a(size, size);
  for (double& value : a.reshaped()) value = entry(random);
  Eigen::VectorXd unit(size);  // per metre and per radian
  for (Eigen::Index i = 0; i < size; ++i) unit[i] = i % 5 < 3 && i < 20 ? 1 : 0.3;
  const Eigen::MatrixXd whole = a * a.transpose() / 7 + Eigen::MatrixXd::Identity(size, size);
  return {on_housing, 1e9 * unit.asDiagonal() * whole * unit.asDiagonal(),
          turns ? std::optional<std::size_t>(3) : std::nullopt};
}

Eigen::Matrix<double, 5, 5> diagonal(const StageBearing& b) {
  return Eigen::Vector<double, 5>(b.x, b.y, b.axial, b.tilt, b.tilt).asDiagonal();
}

double largest_difference(const StaticPosition& a, const StaticPosition& b) {
  double result = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    result = std::max(result, std::abs(a.sun_meshes[n].force / b.sun_meshes[n].force - 1));
    result = std::max(result, std::abs(a.ring_meshes[n].force / b.ring_meshes[n].force - 1));
  }
  for (std::size_t n = 0; n < 3; ++n)
    result = std::max(result, (a.bodies[n].displacement - b.bodies[n].displacement).norm() /
                                  (b.bodies[n].displacement.norm() + 1e-9));
  return result;
}

}  // namespace

// A housing that ties no bearing to another is a spring in series with each.
BOOST_AUTO_TEST_CASE(springs_in_series) {
  annulus::test::Verification record("Housing that gives way", "springs in series; eliminated by hand");
  auto on_springs = stage(), in_series = stage();
  HousingStructure housing{on_housing, Eigen::MatrixXd::Zero(20, 20)};
  for (std::size_t k = 0; k < on_housing.size(); ++k) {
    const auto first = 5 * static_cast<Eigen::Index>(k);
    const Eigen::Matrix<double, 5, 5> below = housing_without_pattern(false).stiffness.block<5, 5>(first, first);
    housing.stiffness.block<5, 5>(first, first) = below;
    auto& bearing = in_series.bearings[on_housing[k]];
    // Compliances of what resists add up.
    const Eigen::Matrix<double, 5, 5> own = diagonal(bearing);
    bearing.matrix = own - own * (own + below).inverse() * own;
    bearing.matrix = (*bearing.matrix + bearing.matrix->transpose()).eval() / 2;
  }
  on_springs.housing = housing;
  for (const double cycle : {0.0, 31.0}) {
    const auto found = statics(on_springs, {cycle}).positions.front();
    const auto expected = statics(in_series, {cycle}).positions.front();
    record.at_most("forces and displacements, on any side of the housing", "", largest_difference(found, expected),
                   1e-8, "residual of the equilibria");
  }
  // A rigid bearing leaves the housing alone.
  on_springs.bearings[6].x = on_springs.bearings[6].y = on_springs.bearings[6].axial = on_springs.bearings[6].tilt =
      rigid;
  in_series.bearings[6].matrix = housing.stiffness.topLeftCorner<5, 5>();
  record.at_most("with a rigid bearing", "",
                 largest_difference(statics(on_springs).positions.front(), statics(in_series).positions.front()), 1e-8,
                 "residual of the equilibria");
}

// Its bearings act on each other through the housing, and the torque of the ring moves all of them.
BOOST_AUTO_TEST_CASE(reactions_and_motions_of_the_housing) {
  annulus::test::Verification record("Housing that gives way", "its stiffness times its motions");
  auto s = stage();
  s.housing = housing_without_pattern(true);
  for (const bool elastic_ring : {false, true}) {
    s.plane.ring.torsional_support = elastic_ring ? 2e9 : rigid;
    for (const double cycle : {0.0, 31.0}) {
      const auto turn = statics(s, {cycle});
      const auto& p = turn.positions.front();
      Eigen::VectorXd motion(21), force(21);
      for (std::size_t k = 0; k < 4; ++k) {
        const auto& place = p.bodies[6 + k];
        const auto first = 5 * static_cast<Eigen::Index>(k);
        motion.segment<5>(first) << place.displacement, place.rotation.head<2>();
        const auto& bearing = p.bearings[on_housing[k]];  // on the body; in the frame of the housing
        force.segment<5>(first) << -bearing.force, -bearing.moment;
      }
      motion[20] = p.bodies[9].rotation[2];
      double torque = 0;
      for (const auto& mesh : p.ring_meshes) torque -= mesh.force * s.plane.ring.radius;
      force[20] = torque;
      const Eigen::VectorXd expected = s.housing->stiffness * motion;
      for (Eigen::Index i = 0; i < 21; ++i)
        record.at_most("forces on the housing", "", std::abs(force[i] - expected[i]) / expected.cwiseAbs().maxCoeff(),
                       1e-8, "residual of the equilibrium");
      BOOST_TEST(std::abs(motion[20]) > 1e-5);
      if (!elastic_ring) BOOST_TEST(p.bodies[1].rotation[2] == motion[20], boost::test_tools::tolerance(1e-9));
      record.close("torque of the ring", "N m", torque, p.carrier_torque + s.plane.sun_torque, 1e-8,
                   "residual of the equilibrium");
    }
  }
}

// The lumped stage at rest, with bearings and housing in series and the rotation of the ring, is the mechanism.
BOOST_AUTO_TEST_CASE(lumped_stage_in_a_housing) {
  annulus::test::Verification record("Housing that gives way", "lumped stage against the mechanism");
  enum class Case { elastic, turning, rigid_bearing, elastic_ring };
  for (const auto which : {Case::elastic, Case::turning, Case::rigid_bearing, Case::elastic_ring}) {
    auto s = stage();
    s.plane.carrier_speed = 0;
    s.housing = housing_without_pattern(which != Case::elastic);
    if (which == Case::rigid_bearing) {
      auto& b = s.bearings[on_housing.front()];
      b.x = b.y = b.axial = b.tilt = rigid;
      s.bearings[on_housing.back()].axial = rigid;
    }
    if (which == Case::elastic_ring) s.plane.ring.torsional_support = 2e9;
    const auto expected = statics(s).positions.front();
    const auto found = solved(lumped(s));
    for (std::size_t m = 0; m < 6; ++m) {
      const auto& mesh = m < 3 ? expected.sun_meshes[m] : expected.ring_meshes[m - 3];
      record.close("mesh forces", "N", found.force[m], mesh.force, 1e-7, "residual of the equilibria");
      const double half = (m < 3 ? sun_width : ring_width) / 2;
      record.at_most("moment along the face over force x half its width", "",
                     std::abs(found.tilt[m] * half - mesh.force * mesh.place) / (half * std::abs(mesh.force)), 1e-7,
                     "residual of the equilibria");
    }
  }
}

// Bearings with clearance in a housing past which nothing turns, about the equilibrium of another torque.
BOOST_AUTO_TEST_CASE(clearance_in_a_housing_that_stands) {
  annulus::test::Verification record("Housing that gives way", "statics, with clearance");
  auto s = stage();
  s.plane.carrier_speed = 0;
  s.housing = housing_without_pattern(true);
  for (const std::size_t b : {6U, 7U}) {
    s.bearings[b].play = 60e-6;
    s.bearings[b].load_zone = false;
  }
  auto moving = lumped(s);
  moving.space->laws = BearingLaws::whole;
  for (const double share : {1.0, 1.4}) {  // all faces carry from end to end
    s.plane.sun_torque *= share;
    moving.sun_torque = s.plane.sun_torque;
    const auto expected = statics(s).positions.front();
    const auto found = solved(moving);
    for (std::size_t m = 0; m < 6; ++m)
      record.close("mesh forces", "N", found.force[m],
                   m < 3 ? expected.sun_meshes[m].force : expected.ring_meshes[m - 3].force, 1e-7,
                   "residual of the equilibria");
  }
}

// A housing that is the same in all directions looks the same to a carrier that turns: then nothing is averaged, and
// the turning stage rests as the mechanism does in every position.
BOOST_AUTO_TEST_CASE(turning_past_an_even_housing) {
  annulus::test::Verification record("Housing that gives way", "statics of the turning stage");
  auto s = stage();
  // The rows of the carrier and the ring give way together; x and y alike.
  Eigen::MatrixXd& k = s.housing.emplace(HousingStructure{on_housing, Eigen::MatrixXd::Zero(21, 21), 3}).stiffness;
  const auto spring = [&](Eigen::Index i, Eigen::Index j, double stiffness) {  // between two coordinates
    k(i, i) += stiffness;
    k(j, j) += stiffness;
    k(i, j) -= stiffness;
    k(j, i) -= stiffness;
  };
  for (Eigen::Index i = 0; i < 21; ++i) k(i, i) = i % 5 < 3 && i < 20 ? 3e9 : 3e8;
  for (const Eigen::Index xy : {0, 1}) {
    spring(xy, 5 + xy, 2e9);
    spring(5 + xy, 15 + xy, 1e9);
  }
  spring(7, 17, 1e9);   // axial
  spring(17, 20, 1e8);  // the ring screws
  for (const int cycle : {0, 13, 50}) {
    const auto expected = statics(s, {static_cast<double>(cycle)}).positions.front();
    auto moving = lumped(s);
    moving.rotating_frame = false;
    const auto found = solved(moving, expected.time);
    for (std::size_t m = 0; m < 6; ++m) {
      const auto& mesh = m < 3 ? expected.sun_meshes[m] : expected.ring_meshes[m - 3];
      record.close("mesh forces while the carrier turns", "N", found.force[m], mesh.force, 1e-7,
                   "residual of the equilibria");
    }
  }
}

BOOST_AUTO_TEST_CASE(what_does_not_fit_is_refused) {
  auto s = stage();
  s.housing = housing_without_pattern(false);
  s.housing->ring_bearing = 3;
  BOOST_CHECK_EXCEPTION((void)statics(s), annulus::InputError, [](const auto& error) {
    return std::string(error.what()).find("20 x 20 entries; 4 bearings need 21 x 21") != std::string::npos;
  });
  s.housing = housing_without_pattern(false);
  s.housing->bearings.front() = 0;
  BOOST_CHECK_THROW((void)statics(s), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
