#include "dynamics/systems/two_k_v/two_k_v_modes.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "core/errors.h"

namespace annulus::dynamics {

namespace {

double frozen_tangent(const MeshElement& mesh, FrozenStiffness frozen) {
  const auto& excitation = mesh.excitation;
  if (frozen == FrozenStiffness::mean) return mean_tangent_stiffness(excitation);
  if (const auto* table = std::get_if<TableStiffness>(&excitation))
    return table->tangent(mesh.phase_offset - table->phase_shift);
  if (const auto* harmonic = std::get_if<HarmonicStiffness>(&excitation))
    return harmonic->mean *
           (1 + harmonic->ripple * std::cos(2 * std::numbers::pi * (mesh.phase_offset - harmonic->phase_shift)));
  if (const auto* wave = std::get_if<RectangularStiffness>(&excitation)) {
    const double phase = mesh.phase_offset - wave->phase_shift;
    const double high = phase - std::floor(phase) < wave->duty ? 1 : 0;
    return wave->mean * (1 + wave->ripple * (high - wave->duty));
  }
  return std::get<ConstantStiffness>(excitation).mean;
}

Eigen::VectorXd frozen_tangents(const LumpedSystem& system, FrozenStiffness frozen) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(system.meshes().size()));
  for (Eigen::Index m = 0; m < result.size(); ++m) result[m] = frozen_tangent(system.meshes()[m], frozen);
  return result;
}

/// Stiffness seen from one DOF, N m/rad.
double stiffness_seen_from(const std::string& dof, const TwoKVStage& stage, FrozenStiffness frozen) {
  const LumpedSystem system = assemble(stage);
  const int index = system.find(dof);
  const Eigen::LLT<Eigen::MatrixXd> factor(stiffness_with_meshes(system, frozen_tangents(system, frozen)));
  if (factor.info() != Eigen::Success)
    throw SolverError(fmt::format(
        "the torsional stiffness of the 2K-V stage is not positive at a crank angle of {} rad", stage.crank_angle));
  const double radius = dof_radii(stage, system)[index];
  const Eigen::VectorXd moved = factor.solve(Eigen::VectorXd::Unit(system.dofs(), index));
  return radius * radius / moved[index];
}

void check_count(int count) {
  if (count < 1) throw InputError(fmt::format("{} crank angles; at least one is needed", count));
}

TwoKVStage at_angle(const TwoKVStage& stage, double angle) {
  TwoKVStage turned = stage;
  turned.crank_angle = angle;
  return turned;
}

/// What is said of the reducer by itself.
TwoKVStage without_rotors(TwoKVStage stage) {
  stage.rotors.clear();
  return stage;
}

double hertz(double stiffness, double inertia) { return std::sqrt(stiffness / inertia) / (2 * std::numbers::pi); }

}  // namespace

Eigen::VectorXd mesh_stiffness(const TwoKVStage& stage, FrozenStiffness frozen) {
  return frozen_tangents(assemble(stage), frozen);
}

Modes modes(const TwoKVStage& stage) { return modes(assemble(stage)); }

ModalEnergy modal_energy(const TwoKVStage& stage, const Modes& modes) {
  return modal_energy(assemble(stage), mesh_stiffness(stage), modes);
}

int crank_positions(const TwoKVStage& stage) {
  constexpr int least = 72, per_cycle = 8;
  return constant_stiffness(stage) ? least : std::max(least, per_cycle * std::max(stage.planet_teeth, stage.arc_teeth));
}

CrankModes modes_over_crank(const TwoKVStage& stage, int count, FrozenStiffness frozen) {
  check_count(count);
  CrankModes result;
  result.angle = Eigen::VectorXd::LinSpaced(count + 1, 0, 2 * std::numbers::pi).head(count);
  for (int i = 0; i < count; ++i) {
    const LumpedSystem system = assemble(at_angle(stage, result.angle[i]));
    const Eigen::VectorXd stiffness = frozen_tangents(system, frozen);
    auto& found = result.modes.emplace_back(modes(system, stiffness));
    const GroupedEnergy energy = by_group(modal_energy(system, stiffness, found));
    if (i == 0) result.frequency.resize(static_cast<Eigen::Index>(found.modes.size()), count);
    auto& names = result.names.emplace_back();
    for (Eigen::Index m = 0; m < result.frequency.rows(); ++m) {
      auto& [frequency, shape] = found.modes[m];
      result.frequency(m, i) = frequency;
      names.push_back(mode_name(energy, m));
      // Shapes have no sign of their own.
      Eigen::Index most = 0;
      (void)shape.cwiseAbs().maxCoeff(&most);
      if ((i == 0 ? shape[most] : shape.dot(result.modes[i - 1].modes[m].shape)) < 0) shape = -shape;
    }
  }
  return result;
}

TorsionalStiffness torsional_stiffness(const TwoKVStage& stage, int count, FrozenStiffness frozen) {
  check_count(count);
  TorsionalStiffness result;
  result.angle = Eigen::VectorXd::LinSpaced(count + 1, 0, 2 * std::numbers::pi).head(count);
  result.from_output.resize(count);
  result.from_input.resize(count);
  for (int i = 0; i < count; ++i) {
    TwoKVStage turned = without_rotors(at_angle(stage, result.angle[i]));
    turned.input_support = rigid;
    turned.output_support = 0;
    result.from_output[i] = stiffness_seen_from("output_u", turned, frozen);
    turned.input_support = 0;
    turned.output_support = rigid;
    result.from_input[i] = stiffness_seen_from("input_u", turned, frozen);
  }
  return result;
}

bool constant_stiffness(const TwoKVStage& stage) {
  return std::holds_alternative<ConstantStiffness>(stage.sun_mesh) &&
         std::holds_alternative<ConstantStiffness>(stage.arc_mesh);
}

OneDof one_dof(const TwoKVStage& stage) {
  OneDof one;
  one.stiffness = torsional_stiffness(stage, 1, FrozenStiffness::mean).from_output[0];
  one.input_inertia = stage.input_inertia * stage.ratio() * stage.ratio();
  auto free = without_rotors(stage);
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
