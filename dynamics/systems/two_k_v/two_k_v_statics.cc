#include "dynamics/systems/two_k_v/two_k_v_statics.h"

#include <cmath>
#include <numbers>
#include <variant>

#include "dynamics/systems/two_k_v/two_k_v_modes.h"

namespace annulus::dynamics {

namespace {

double hertz(double stiffness, double inertia) { return std::sqrt(stiffness / inertia) / (2 * std::numbers::pi); }

}  // namespace

bool constant_stiffness(const TwoKVStage& stage) {
  return std::holds_alternative<ConstantStiffness>(stage.sun_mesh) &&
         std::holds_alternative<ConstantStiffness>(stage.arc_mesh);
}

OneDof one_dof(const TwoKVStage& stage) {
  OneDof one;
  one.stiffness = torsional_stiffness(stage, 1, FrozenStiffness::mean).from_output[0];
  one.input_inertia = stage.input_inertia * stage.ratio() * stage.ratio();
  auto free = stage;
  free.input_support = free.output_support = 0;
  const auto system = assemble(free);
  Eigen::VectorXd motion = rigid_motion(free, system);
  motion[system.find("output_u")] = 0;
  one.train_inertia = motion.dot(system.mass() * motion);
  one.input_frequency = hertz(one.stiffness, one.input_inertia);
  one.train_frequency = hertz(one.stiffness, one.train_inertia);
  return one;
}

LostMotion lost_motion(const TwoKVStage& stage, double stiffness, double arc_clearance) {
  // By virtual work: the mesh forces of one newton metre at the output are the turns of the output per metre of play.
  const double sun = 1 / (stage.ratio() * stage.sun_base_radius());
  const double arc = (1 - 1 / stage.ratio()) / (stage.eccentricity * stage.pins);
  LostMotion lost;
  lost.backlash =
      2 * (sun * stage.sun_half_backlash.value_or(0) + arc * (stage.arc_half_backlash.value_or(0) + arc_clearance));
  constexpr double test_torque = 0.03;  // of the rated torque
  lost.elastic = 2 * test_torque * stage.output_torque / stiffness;
  lost.wind_up = stage.output_torque / stiffness;
  return lost;
}

}  // namespace annulus::dynamics
