#include "dynamics/systems/two_k_v/two_k_v_modes.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

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

}  // namespace

Eigen::VectorXd mesh_stiffness(const TwoKVStage& stage, FrozenStiffness frozen) {
  return frozen_tangents(assemble(stage), frozen);
}

Modes modes(const TwoKVStage& stage, FrozenStiffness frozen) {
  const LumpedSystem system = assemble(stage);
  return modes(system, frozen_tangents(system, frozen));
}

ModalEnergy modal_energy(const TwoKVStage& stage, const Modes& modes, FrozenStiffness frozen) {
  const LumpedSystem system = assemble(stage);
  return modal_energy(system, frozen_tangents(system, frozen), modes);
}

std::string mode_name(const ModalEnergy& energy, Eigen::Index mode) {
  std::map<std::string, double> bodies, groups;
  const auto largest = [](const std::map<std::string, double>& shares) {
    return std::max_element(shares.begin(), shares.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  };
  for (std::size_t i = 0; i < energy.bodies.size(); ++i)
    bodies[element_group(energy.bodies[i])] += energy.kinetic(static_cast<Eigen::Index>(i), mode);
  for (std::size_t i = 0; i < energy.elements.size(); ++i)
    groups[element_group(energy.elements[i])] += energy.strain(static_cast<Eigen::Index>(i), mode);
  if (!(energy.strain.col(mode).sum() > 0)) return "rigid";
  return largest(bodies) + " on " + largest(groups);
}

CrankModes modes_over_crank(const TwoKVStage& stage, int count, FrozenStiffness frozen) {
  check_count(count);
  CrankModes result;
  result.angle = Eigen::VectorXd::LinSpaced(count + 1, 0, 2 * std::numbers::pi).head(count);
  for (int i = 0; i < count; ++i) {
    const LumpedSystem system = assemble(at_angle(stage, result.angle[i]));
    const Eigen::VectorXd stiffness = frozen_tangents(system, frozen);
    auto& found = result.modes.emplace_back(modes(system, stiffness));
    const ModalEnergy energy = modal_energy(system, stiffness, found);
    if (i == 0) result.frequency.resize(static_cast<Eigen::Index>(found.modes.size()), count);
    auto& names = result.names.emplace_back();
    for (Eigen::Index m = 0; m < result.frequency.rows(); ++m) {
      result.frequency(m, i) = found.modes[m].frequency;
      names.push_back(mode_name(energy, m));
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
    TwoKVStage turned = at_angle(stage, result.angle[i]);
    turned.input_support = rigid;
    turned.output_support = 0;
    result.from_output[i] = stiffness_seen_from("output_u", turned, frozen);
    turned.input_support = 0;
    turned.output_support = rigid;
    result.from_input[i] = stiffness_seen_from("input_u", turned, frozen);
  }
  return result;
}

}  // namespace annulus::dynamics
