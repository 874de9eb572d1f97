#include "dynamics/systems/planetary/bearing_forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "dynamics/figures/motion.h"
#include "dynamics/systems/planetary/space_motion.h"
#include "dynamics/systems/planetary/stage_forms.h"

namespace annulus::dynamics {

using geometry::StageMember;

namespace {

/// Motion of the stage over time by DOF or spring; rigid ones give zeros.
class Motion {
 public:
  Motion(const LumpedSystem& system, const TimeSeries& series) : system_(system), series_(series) {
    require(series.dofs == system_.names(),
            fmt::format("a time series of {} degrees of freedom belongs to another stage than this one of {}",
                        series.dofs.size(), system_.dofs()));
    const auto meshes = static_cast<Eigen::Index>(system_.meshes().size());
    require(series.force.rows() == meshes, fmt::format("{} forces of {} meshes", series.force.rows(), meshes));
  }

  [[nodiscard]] Eigen::RowVectorXd displacement(const std::string& dof) const { return row(series_.displacement, dof); }
  [[nodiscard]] const std::string& dof(int index) const { return system_.names()[static_cast<std::size_t>(index)]; }
  [[nodiscard]] bool moves(const std::string& dof) const { return system_.find(dof) >= 0; }
  /// A sum of factor x DOF over time.
  struct Course {
    Eigen::RowVectorXd displacement, velocity, acceleration;
  };
  [[nodiscard]] Course course(const std::vector<std::pair<std::string, double>>& form) {
    if (acceleration_.size() == 0)
      acceleration_ = accelerations(system_, series_.time, series_.displacement, series_.velocity);
    const auto sum = [&](const Eigen::MatrixXd& values) {
      Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(values.cols());
      for (const auto& [dof, factor] : form) result += factor * row(values, dof);
      return result;
    };
    return {sum(series_.displacement), sum(series_.velocity), sum(acceleration_)};
  }

  [[nodiscard]] const SpringElement* spring(const std::string& name) const {
    const auto& springs = system_.springs();
    const auto found = std::find_if(springs.begin(), springs.end(), [&](const auto& s) { return s.name == name; });
    return found == springs.end() ? nullptr : &*found;
  }
  /// k a^T q + c a^T q'
  [[nodiscard]] Eigen::RowVectorXd force(const SpringElement& spring) const {
    Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(series_.time.size());
    for (const auto& [i, factor] : spring.a)
      result += factor * (spring.stiffness * series_.displacement.row(i) + spring.damping * series_.velocity.row(i));
    return result;
  }

 private:
  [[nodiscard]] Eigen::RowVectorXd row(const Eigen::MatrixXd& values, const std::string& dof) const {
    const int i = system_.find(dof);
    if (i < 0) return Eigen::RowVectorXd::Zero(series_.time.size());
    return values.row(i);
  }

  const LumpedSystem& system_;
  const TimeSeries& series_;
  Eigen::MatrixXd acceleration_;
};

enum class Direction { radial, tangential };

Direction across(Direction direction) {
  return direction == Direction::radial ? Direction::tangential : Direction::radial;
}

/// Coordinate of a planet in space as names of DOFs and factors.
std::vector<std::pair<std::string, double>> planet_form(const PlanetaryStage& stage, const Motion& motion, int n,
                                                        Direction direction) {
  LumpedSystemBuilder builder;
  const auto forms = add_bodies_in_space(builder, stage);
  const auto& planet = forms.planets[static_cast<std::size_t>(n)];
  std::vector<std::pair<std::string, double>> named;
  for (const auto& [dof, factor] : direction == Direction::radial ? planet.x : planet.y)
    named.emplace_back(motion.dof(dof), factor);
  return named;
}

/// Transverse load on a body in space, N, in its axes, x times.
Eigen::MatrixXd space_load(const PlanetaryStage& stage, const StageBody& body, const Eigen::VectorXd& time) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(2, time.size());
  if (!stage.space) return sum;
  for (const auto& load : stage.space->loads)
    if (load.body == body) sum.colwise() += load.load.head<2>();
  const Eigen::ArrayXd angle = stage.carrier_speed * time.array();
  for (const auto& load : stage.space->standing_loads)
    if (load.body == body)
      sum += load.cosine.head<2>() * angle.cos().matrix().transpose() +
             load.sine.head<2>() * angle.sin().matrix().transpose();
  return sum;
}

/// Motion of planet n in its radial or tangential coordinate, whether it has the DOF or rides on the carrier.
Motion::Course planet_course(const PlanetaryStage& stage, Motion& motion, int n, Direction direction) {
  const bool radial = direction == Direction::radial;
  if (stage.space) return motion.course(planet_form(stage, motion, n, direction));
  const auto dof = "planet" + std::to_string(n + 1) + (radial ? "_x" : "_y");
  if (motion.moves(dof)) return motion.course({{dof, 1}});
  const double c = std::cos(stage.planet_angles[n]), s = std::sin(stage.planet_angles[n]);
  return motion.course({{"carrier_x", radial ? c : -s}, {"carrier_y", radial ? s : c}, {"carrier_u", radial ? 0 : 1}});
}

/// Force on the pin from m (x'' - 2 Omega y' - Omega^2 x) = -sum b F - pin force, and likewise for y.
Eigen::RowVectorXd pin_force_by_equilibrium(const PlanetaryStage& stage, const TimeSeries& series, Motion& motion,
                                            int n, Direction direction) {
  const bool radial = direction == Direction::radial;
  const double as = stage.sun_working_angle, ar = stage.ring_working_angle;
  const double sun_b = radial ? -std::sin(as) : -std::cos(as), ring_b = radial ? std::sin(ar) : -std::cos(ar);
  const double speed = stage.rotating_frame ? stage.carrier_speed : 0;
  const Motion::Course own = planet_course(stage, motion, n, direction),
                       other = planet_course(stage, motion, n, across(direction));
  Eigen::RowVectorXd displacement = own.displacement;
  if (!radial) displacement -= motion.displacement("carrier_u");  // the centrifugal force turns with the carrier
  const Eigen::RowVectorXd inertia =
      stage.planet.mass *
      (own.acceleration + (radial ? -2 : 2) * speed * other.velocity - speed * speed * displacement);
  return -sun_b * series.force.row(n) - ring_b * series.force.row(stage.planets() + n) - inertia;
}

/// Of a bearing with play, which contains the centrifugal force: its elements, turned back from along and across the
/// mean pin force.
void set_pin_force_with_play(const PlanetaryStage& stage, const TimeSeries& series, int n, Eigen::Index first,
                             BearingForces& result) {
  const Eigen::Vector2d along = stage.pin_direction();
  const auto force = series.force.row(first), across = series.force.row(first + 1);
  result.radial.row(n) = along[0] * force - along[1] * across;
  result.tangential.row(n) = along[1] * force + along[0] * across;
}

BearingForces pin_forces(const PlanetaryStage& stage, const TimeSeries& series, Motion& motion) {
  BearingForces result;
  result.radial.resize(stage.planets(), series.time.size());
  result.tangential.resize(stage.planets(), series.time.size());
  const double centrifugal = stage.rotating_frame && !stage.space
                                 ? stage.planet.mass * stage.carrier.radius * stage.carrier_speed * stage.carrier_speed
                                 : 0;  // in space one of its loads
  Eigen::Index with_play = 2 * static_cast<Eigen::Index>(stage.planets());
  for (int n = 0; n < stage.planets(); ++n) {
    if (!stage.space && stage.planet_bearing(n).play > 0) {
      set_pin_force_with_play(stage, series, n, with_play, result);
      with_play += 2;
      continue;
    }
    for (const auto direction : {Direction::radial, Direction::tangential}) {
      const bool radial = direction == Direction::radial;
      const auto name = "planet" + std::to_string(n + 1) + (radial ? "_bearing_radial" : "_bearing_tangential");
      const auto* spring = stage.space ? nullptr : motion.spring(name);
      (radial ? result.radial : result.tangential).row(n) =
          spring ? motion.force(*spring) : pin_force_by_equilibrium(stage, series, motion, n, direction);
    }
    const auto load = space_load(stage, {StageBody::Kind::planet, n}, series.time);
    result.radial.row(n) += load.row(0);
    result.radial.row(n).array() += centrifugal;
    result.tangential.row(n) += load.row(1);
  }
  return result;
}

StageBody::Kind kind_of(StageMember member) {
  return member == StageMember::sun    ? StageBody::Kind::sun
         : member == StageMember::ring ? StageBody::Kind::ring
                                       : StageBody::Kind::carrier;
}

/// Sum of all forces on the body without its supports.
SupportReaction applied(const PlanetaryStage& stage, const TimeSeries& series, Motion& motion, StageMember member) {
  const auto zero = Eigen::VectorXd::Zero(series.time.size());
  SupportReaction sum{zero, zero, zero};
  const auto load = space_load(stage, {kind_of(member)}, series.time);
  sum.x += load.row(0).transpose();
  sum.y += load.row(1).transpose();
  if (member == StageMember::carrier) {
    const auto pins = pin_forces(stage, series, motion);
    for (int n = 0; n < stage.planets(); ++n) {
      const double c = std::cos(stage.planet_angles[n]), s = std::sin(stage.planet_angles[n]);
      sum.x += (c * pins.radial.row(n) - s * pins.tangential.row(n)).transpose();
      sum.y += (s * pins.radial.row(n) + c * pins.tangential.row(n)).transpose();
      sum.torque += stage.carrier.radius * pins.tangential.row(n).transpose();
    }
    return sum;
  }
  const bool sun = member == StageMember::sun;
  for (int n = 0; n < stage.planets(); ++n) {
    const double psi = stage.planet_angles[n] + (sun ? -stage.sun_working_angle : stage.ring_working_angle);
    const Eigen::VectorXd force = series.force.row(sun ? n : stage.planets() + n).transpose();
    sum.x += std::sin(psi) * force;  // -b F [HuFangXuShen2021, eqs. (15), (16)]
    sum.y -= std::cos(psi) * force;
    sum.torque -= (sun ? stage.sun : stage.ring).radius * force;
  }
  return sum;
}

/// Sum of the transverse forces of a body's bearings on the housing, 2 x times; nothing where one is rigid, or in a
/// plane stage.
std::optional<Eigen::MatrixXd> bearings_on_housing(const PlanetaryStage& stage, const SpaceMotion& motion,
                                                   Eigen::Index times, StageMember member) {
  if (!stage.space) return std::nullopt;
  const auto kind = kind_of(member);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(2, times);
  for (const auto& b : stage.space->bearings)
    if (b.body.kind == kind && b.on.kind == StageBody::Kind::housing && (b.rigid[0] || b.rigid[1])) return std::nullopt;
  for (const auto& b : motion.bearings)
    if (b.body.kind == kind && b.on.kind == StageBody::Kind::housing) sum -= b.force.topRows<2>();
  return sum;
}

SupportReaction reaction_of(const PlanetaryStage& stage, const TimeSeries& series, Motion& motion,
                            const SpaceMotion& space, StageMember member) {
  const auto& body = stage.body(member);
  const std::string name = to_string(member);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(series.time.size());
  SupportReaction result{zero, zero, zero};
  const auto in_space = bearings_on_housing(stage, space, series.time.size(), member);
  if (in_space) {
    result.x = in_space->row(0).transpose();
    result.y = in_space->row(1).transpose();
  }
  if ((body.support == rigid && !in_space) || body.torsional_support == rigid) {
    const auto held = applied(stage, series, motion, member);
    if (body.support == rigid && !in_space) {
      result.x = held.x;
      result.y = held.y;
    }
    if (body.torsional_support == rigid) result.torque = held.torque;
  }
  const double speed = stage.rotating_frame ? stage.carrier_speed : 0;
  if (const auto* spring = motion.spring(name + "_support_x"))
    result.x = (motion.force(*spring) - spring->damping * speed * motion.displacement(name + "_y")).transpose();
  if (const auto* spring = motion.spring(name + "_support_y"))
    result.y = (motion.force(*spring) + spring->damping * speed * motion.displacement(name + "_x")).transpose();
  if (member == StageMember::ring && stage.space && stage.space->coupling_that_turns({StageBody::Kind::ring}))
    result.torque = -space.turning_torque;
  else if (const auto* spring = motion.spring(name + "_support_u"))
    result.torque = body.radius * motion.force(*spring).transpose();
  return result;
}

}  // namespace

BearingForces bearing_forces(const PlanetaryStage& stage, const TimeSeries& series) {
  const auto system = assemble(stage);
  Motion motion(system, series);
  return pin_forces(stage, series, motion);
}

SupportReaction support_reaction(const PlanetaryStage& stage, const TimeSeries& series, StageMember member) {
  const auto system = assemble(stage);
  Motion motion(system, series);
  return reaction_of(stage, series, motion, space_motion(stage, series), member);
}

StageForces stage_forces(const PlanetaryStage& stage, const LumpedSystem& system, const TimeSeries& series) {
  Motion motion(system, series);
  const auto space = space_motion(stage, system, series);
  const auto reaction = [&](StageMember member) { return reaction_of(stage, series, motion, space, member); };
  return {pin_forces(stage, series, motion), reaction(StageMember::sun), reaction(StageMember::ring),
          reaction(StageMember::carrier)};
}

}  // namespace annulus::dynamics
