#include "dynamics/systems/helical_pair/spatial_pair.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/errors.h"
#include "dynamics/spatial/bearing_laws.h"
#include "dynamics/spatial/even_face.h"
#include "dynamics/spatial/linearised.h"
#include "dynamics/spatial/mechanism.h"

namespace annulus::dynamics {

namespace {

using Kind = StageBody::Kind;
using Eigen::Vector3d;

/// Axes of the lumped pair (columns) in those of the housing: y along the transverse line of action.
Eigen::Matrix3d along_line_of_action(const SpatialPair& pair) {
  const double c = std::cos(pair.working_angle), s = std::sin(pair.working_angle);
  Eigen::Matrix3d axes;
  axes << c, s, 0, -s, c, 0, 0, 0, 1;
  return axes;
}

void check_body(const StageBody& body, const std::string& what) {
  if (body.kind != Kind::pinion && body.kind != Kind::wheel)
    throw InputError(fmt::format("{} names the {}; a pair has pinion and wheel", what, name_of_body(body)));
}

int number(const StageBody& body) { return body.kind == Kind::pinion ? 0 : 1; }

struct PairMechanism {
  Mechanism mechanism;
  std::vector<MadeBearing> bearings;
};

PairMechanism assemble(const SpatialPair& pair, Motions motions) {
  const bool in_space = motions == Motions::in_space;
  PairMechanism result{Mechanism(pair.working_radius_pinion), {}};
  auto& m = result.mechanism;
  m.add_body({"pinion", Vector3d::Zero(), in_space});
  m.add_body({"wheel", Vector3d::Zero(), in_space});
  BearingAssembly bearings(m, motions);
  for (const auto& b : pair.bearings) {
    check_body(b.body, fmt::format("bearing '{}'", b.name));
    if (b.on.kind != Kind::housing)
      throw InputError(fmt::format("bearing '{}' stands on the {}; those of a pair stand on the housing", b.name,
                                   name_of_body(b.on)));
    result.bearings.push_back(bearings.add(b, {.body = number(b.body)}));
  }
  // The wheel takes the torque; how far it has turned does not matter.
  m.hold("the rotation of the wheel", m.rotation(1, Mechanism::ground, Vector3d::UnitZ()));
  const double c = std::cos(pair.base_helix_angle), s = std::sin(pair.base_helix_angle);
  const Vector3d along(std::sin(pair.working_angle), std::cos(pair.working_angle), 0);
  const Vector3d normal = c * along - s * Vector3d::UnitZ();
  const double half = pair.face.width / 2;
  const auto& gaps = pair.face.gap;
  std::vector<double> stations{-half}, gap{gaps.empty() ? 0.0 : gaps.front()};
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    stations.push_back(face_places()[i].z * half);
    gap.push_back(gaps[i]);
  }
  stations.push_back(half);
  gap.push_back(gaps.empty() ? 0.0 : gaps.back());
  Eigen::MatrixXd measures(std::ssize(stations), 6 * static_cast<Eigen::Index>(m.bodies()));
  for (Eigen::Index i = 0; i < measures.rows(); ++i) {
    const Vector3d place = (pair.face.middle + stations[static_cast<std::size_t>(i)]) * Vector3d::UnitZ();
    measures.row(i) =
        m.displacement(0, Mechanism::ground, pair.working_radius_pinion * Vector3d::UnitX() + place, normal) -
        m.displacement(1, Mechanism::ground, -pair.working_radius_wheel * Vector3d::UnitX() + place, normal);
  }
  (void)m.add_element("mesh", measures, std::make_shared<EvenFace>(pair.stiffness, stations, std::move(gap)),
                      Eigen::VectorXd::Zero(measures.rows()));
  m.add_load(0, Vector3d::Zero(), Vector3d::Zero(), pair.pinion_torque * Vector3d::UnitZ());
  for (const auto& load : pair.loads) {
    check_body(load.body, fmt::format("load '{}'", load.name));
    m.add_load(number(load.body), load.point, load.force, load.moment);
  }
  for (const auto& weight : pair.weights)
    m.add_load(number(weight.body), weight.place * Vector3d::UnitZ(), weight.mass * pair.gravity, Vector3d::Zero());
  return result;
}

PairMechanism assemble(const SpatialPair& pair) {
  return assemble(pair, pair.reasons_for_space().empty() ? Motions::in_plane : Motions::in_space);
}

/// A bearing of the housing in the axes of the lumped pair.
void turn(LinearBearing& bearing, const Eigen::Matrix3d& axes) {
  LinearBearing::Stiffness all = LinearBearing::Stiffness::Identity();
  all.topLeftCorner<2, 2>() = all.bottomRightCorner<2, 2>() = axes.topLeftCorner<2, 2>();
  // Equal in all directions: rounding would tie what is free of each other.
  constexpr double rounding = 1e-12;
  LinearBearing::Stiffness turned = all.transpose() * bearing.stiffness * all;
  const double size = bearing.stiffness.cwiseAbs().maxCoeff();
  if ((turned - bearing.stiffness).cwiseAbs().maxCoeff() > rounding * size)
    bearing.stiffness = (turned + turned.transpose()) / 2;
  bearing.preload = (all.transpose() * bearing.preload).eval();
  if (bearing.rigid[0] != bearing.rigid[1] || bearing.rigid[3] != bearing.rigid[4])
    throw InputError(
        fmt::format("bearing '{}' is rigid in one direction across the axis and not in the other: give it a stiffness",
                    bearing.name));
}

}  // namespace

std::vector<std::string> SpatialPair::reasons_for_space() const {
  std::vector<std::string> reasons;
  if (base_helix_angle != 0) reasons.emplace_back("the teeth are helical");
  if (!face.gap.empty() && !std::equal(face.gap.begin(), face.gap.end(), face.gap.rbegin(), [](double a, double b) {
        constexpr double rounding = 1e-12;  // m
        return std::abs(a - b) <= rounding;
      }))
    reasons.emplace_back("the flanks differ between the ends of the face");
  if (face.middle != 0) reasons.emplace_back("the face lies beside the middle of the stage");
  add_reasons(reasons, loads, weights, gravity);
  add_reasons(reasons, bearings);
  return reasons;
}

void check_held(const SpatialPair& pair) { assemble(pair).mechanism.check(); }

PairSpace pair_about_equilibrium(const SpatialPair& pair, double tilt_inertia_pinion, double tilt_inertia_wheel) {
  const bool in_space = !pair.reasons_for_space().empty();
  const auto made = assemble(pair);
  const auto at = made.mechanism.solve();
  const auto axes = along_line_of_action(pair);
  PairSpace space;
  space.working_radius_pinion = pair.working_radius_pinion;
  space.working_radius_wheel = pair.working_radius_wheel;
  space.tilt_inertia_pinion = tilt_inertia_pinion;
  space.tilt_inertia_wheel = tilt_inertia_wheel;
  space.face = pair.face;
  for (const auto& bearing : made.bearings) {
    auto found = linearised(bearing, at).bearing;
    turn(found, axes);
    if (!in_space) flatten(found);
    give_law(found, bearing, pair.working_angle);
    space.bearings.push_back(std::move(found));
  }
  if (!in_space)
    for (const auto kind : {Kind::pinion, Kind::wheel}) space.bearings.push_back(plane_guide({kind}));
  const auto add = [&](const StageBody& body, const Vector3d& point, const Vector3d& force, const Vector3d& moment) {
    SpaceLoad load{body};
    Vector3d about = moment + point.cross(force);
    if (!in_space) about.head<2>().setZero();
    load.load << axes.transpose() * force, axes.transpose() * about;
    space.loads.push_back(load);
  };
  for (const auto& load : pair.loads) add(load.body, load.point, load.force, load.moment);
  for (const auto& weight : pair.weights)
    add(weight.body, weight.place * Vector3d::UnitZ(), weight.mass * pair.gravity, Vector3d::Zero());
  return space;
}

}  // namespace annulus::dynamics
