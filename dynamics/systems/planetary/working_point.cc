#include "dynamics/systems/planetary/working_point.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace annulus::dynamics {

namespace {

using Kind = StageBody::Kind;
using Stiffness = LinearBearing::Stiffness;
using Vector = LinearBearing::Vector;

/// Tangents, forces and rigid coordinates of a bearing in a state.
LinearBearing linear(const StageMechanism::Bearing& bearing, const Mechanism::Equilibrium& at) {
  LinearBearing result;
  result.name = bearing.name;
  // A bearing of every planet has the planet in its name as well.
  if (const auto own = " " + name_of_body(bearing.body); result.name.ends_with(own))
    result.name.resize(result.name.size() - own.size());
  result.body = bearing.body;
  result.on = bearing.on;
  result.place = bearing.place;
  for (std::size_t i = 0; i < 5; ++i) {
    result.rigid.at(i) = bearing.held.at(i) >= 0;
    const int element = bearing.element.at(i);
    if (element < 0) continue;
    const auto row = static_cast<Eigen::Index>(i);
    const auto& state = at.state[static_cast<std::size_t>(element)];
    result.preload[row] = state.force[bearing.coordinate.at(i)];
    for (std::size_t j = 0; j < 5; ++j) {
      if (bearing.element.at(j) != element) continue;
      const double tangent = state.tangent(bearing.coordinate.at(i), bearing.coordinate.at(j));
      result.stiffness(row, static_cast<Eigen::Index>(j)) = tangent;
      result.preload[row] -= tangent * at.deflection[static_cast<std::size_t>(element)][bearing.coordinate.at(j)];
    }
  }
  return result;
}

/// The mean of a stiffness that stands in the housing, as the carrier turns past it.
Stiffness mean_over_turn(const Stiffness& stiffness) {
  constexpr int angles = 8;  // second harmonics of the angle vanish
  Stiffness sum = Stiffness::Zero();
  for (int k = 0; k < angles; ++k) {
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(2 * std::numbers::pi * k / angles).toRotationMatrix();
    Stiffness all = Stiffness::Identity();
    all.topLeftCorner<2, 2>() = turn;
    all.bottomRightCorner<2, 2>() = turn;
    sum += all.transpose() * stiffness * all / angles;
  }
  return sum;
}

/// The bearings of one planet on its pin as one in the planet's middle.
LinearBearing on_pin(const std::vector<LinearBearing>& bearings, const Stiffness& pin) {
  Stiffness sum = Stiffness::Zero();
  Vector preload = Vector::Zero();
  Eigen::MatrixXd held(0, 5);
  for (const auto& b : bearings) {
    const auto move = to_place(b.place);
    sum += move.transpose() * b.stiffness * move;
    preload += move.transpose() * b.preload;
    for (Eigen::Index i = 0; i < 5; ++i)
      if (b.rigid.at(static_cast<std::size_t>(i))) {
        held.conservativeResize(held.rows() + 1, Eigen::NoChange);
        held.bottomRows<1>() = move.row(i);
      }
  }
  // Motions of the planet against its pin: the pin gives way until the forces are equal.
  const Eigen::MatrixXd free = held.rows() == 0  ? Eigen::MatrixXd(Eigen::MatrixXd::Identity(5, 5))
                               : held.rows() < 5 ? Eigen::MatrixXd(held.fullPivLu().kernel())
                                                 : Eigen::MatrixXd(5, 0);
  LinearBearing result;
  result.name = "bearing";
  result.body = bearings.front().body;
  result.on = {Kind::carrier};
  result.stiffness = pin;
  const bool gives = free.cols() > 0 && free.cwiseAbs().maxCoeff() > 0;
  if (!gives) return result;
  const Eigen::MatrixXd inner = free.transpose() * (sum + pin) * free;
  const Eigen::MatrixXd share = pin * free * inner.inverse() * free.transpose();
  result.stiffness -= share * pin;
  result.stiffness = (result.stiffness + result.stiffness.transpose()).eval() / 2;
  result.preload = share * preload;
  return result;
}

}  // namespace

bool stands_in_housing(const StageLoad& load) {
  return load.frame == StageFrame::housing &&
         (load.force.head<2>().any() || load.moment.head<2>().any() || load.point.head<2>().any());
}

StageSpace space_about_equilibrium(const SpatialStage& stage, const StageSpace::TiltInertia& inertia) {
  // Of what stands in the housing, the part along the axis stays the same as the carrier turns.
  auto turning = stage;
  bool stands = stage.gravity.head<2>().any() && !stage.weights.empty();
  turning.gravity.head<2>().setZero();
  for (auto& load : turning.loads)
    if (stands_in_housing(load)) {
      stands = true;
      load.point.head<2>().setZero();
      load.force.head<2>().setZero();
      load.moment.setZero();
    }
  const auto made = assemble(turning, 0), made_under_all = assemble(stage, 0);
  const auto at = made.mechanism.solve();
  const auto under_all = stands ? made_under_all.mechanism.solve() : at;
  StageSpace space;
  space.base_helix_angle = stage.base_helix_angle;
  space.planet_working_radius_sun = stage.planet_working_radius_sun;
  space.planet_working_radius_ring = stage.planet_working_radius_ring;
  space.sun_face.middle = stage.sun_face.middle;
  space.ring_face.middle = stage.ring_face.middle;
  space.tilt_inertia = inertia;
  const bool in_space = !turning.reasons_for_space().empty();
  std::vector<std::vector<LinearBearing>> of_planets(static_cast<std::size_t>(stage.planets()));
  for (std::size_t i = 0; i < made.bearings.size(); ++i) {
    const auto& bearing = made.bearings[i];
    if (bearing.body.kind == Kind::pin) continue;
    auto found = linear(bearing, at);
    const bool given = i < turning.bearings.size();
    const bool on_housing = bearing.on.kind == Kind::housing && stage.plane.carrier_speed != 0;
    if (on_housing && stands) {
      found = linear(made_under_all.bearings[i], under_all);
      found.preload.head<2>().setZero();
      found.preload.tail<2>().setZero();
    }
    const bool directed = given && bearing.frame == StageFrame::housing &&
                          (turning.bearings[i].matrix || turning.bearings[i].x != turning.bearings[i].y);
    if (on_housing && (stands || directed)) found.stiffness = mean_over_turn(found.stiffness);
    if (!in_space)
      for (const std::size_t k : {2, 3, 4}) found.rigid.at(k) = true;
    const bool seated = stage.pin && bearing.body.kind == Kind::planet && bearing.on.kind == Kind::carrier;
    if (seated)
      of_planets[static_cast<std::size_t>(bearing.body.planet)].push_back(std::move(found));
    else
      space.bearings.push_back(std::move(found));
  }
  for (const auto& list : of_planets)
    if (!list.empty()) space.bearings.push_back(on_pin(list, *stage.pin));
  for (const auto& load : turning.loads) {
    SpaceLoad own{load.body, {}};
    // Axes of the body: those of the load but for its kind of frame, which all agree at time 0 or along the axis.
    const auto axes = frame_axes(stage, load.frame, load.body, 0);
    const Eigen::Vector3d point = axes * load.point, force = axes * load.force;
    const Eigen::Vector3d moment = axes * load.moment + point.cross(force);
    const bool planet = load.body.kind == Kind::planet;
    const auto body_axes = frame_axes(stage, planet ? StageFrame::planet : StageFrame::carrier, load.body, 0);
    own.load << body_axes.transpose() * force, body_axes.transpose() * moment;
    space.loads.push_back(own);
  }
  return space;
}

}  // namespace annulus::dynamics
