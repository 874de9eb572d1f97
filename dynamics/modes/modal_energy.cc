#include "dynamics/modes/modal_energy.h"

#include <algorithm>
#include <cctype>

namespace annulus::dynamics {

namespace {

std::string body_of(const std::string& dof) { return dof.substr(0, dof.rfind('_')); }

/// Index of `name`, appended when new.
Eigen::Index index_of_name(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  const auto index = found - names.begin();
  if (found == names.end()) names.push_back(name);
  return index;
}

}  // namespace

ModalEnergy modal_energy(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness, const Modes& modes) {
  ModalEnergy result;
  std::vector<Eigen::VectorXd> vectors;
  std::vector<double> stiffness;
  for (const auto& spring : system.springs()) {
    if (spring.stiffness == 0) continue;
    Eigen::VectorXd a = Eigen::VectorXd::Zero(system.dofs());
    for (const auto& [i, factor] : spring.a) a[i] += factor;
    result.elements.push_back(spring.name);
    vectors.push_back(std::move(a));
    stiffness.push_back(spring.stiffness);
  }
  const auto springs = static_cast<Eigen::Index>(vectors.size());
  const Eigen::MatrixXd mesh_vectors = system.mesh_vectors();
  const Eigen::Index meshes = mesh_vectors.cols();
  for (const auto& mesh : system.meshes()) result.elements.push_back(mesh.name);
  const Eigen::MatrixXd coupled = mesh_stiffness_matrix(system, mesh_stiffness);
  if (!system.couplings().empty()) result.elements.emplace_back("ring_body");

  std::vector<Eigen::Index> body;
  for (const auto& dof : system.names()) body.push_back(index_of_name(result.bodies, body_of(dof)));

  const auto count = static_cast<Eigen::Index>(modes.modes.size());
  result.strain = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(result.elements.size()), count);
  result.kinetic = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(result.bodies.size()), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& mode = modes.modes[i];
    if (mode.frequency > 0) {
      for (std::size_t e = 0; e < vectors.size(); ++e) {
        const double stretch = vectors[e].dot(mode.shape);
        result.strain(static_cast<Eigen::Index>(e), i) = stiffness[e] * stretch * stretch;
      }
      const Eigen::VectorXd delta = mesh_vectors.transpose() * mode.shape, force = coupled * delta;
      result.strain.col(i).segment(springs, meshes) = force.array().square() / mesh_stiffness.array();
      if (!system.couplings().empty())
        result.strain(springs + meshes, i) = delta.dot(force) - result.strain.col(i).segment(springs, meshes).sum();
      result.strain.col(i) /= result.strain.col(i).sum();
    }
    const Eigen::VectorXd momentum = system.mass() * mode.shape;
    for (Eigen::Index f = 0; f < momentum.size(); ++f) result.kinetic(body[f], i) += mode.shape[f] * momentum[f];
    result.kinetic.col(i) /= result.kinetic.col(i).sum();
  }
  return result;
}

std::string element_group(const std::string& element) {
  std::string group;
  for (const char c : element)
    if (!std::isdigit(static_cast<unsigned char>(c))) group += c;
  for (const char* direction : {"_x", "_y", "_u", "_radial", "_tangential"})
    if (group.ends_with(direction)) return group.substr(0, group.rfind('_'));
  return group;
}

GroupedEnergy by_group(const ModalEnergy& energy) {
  GroupedEnergy result;
  std::vector<Eigen::Index> group;
  for (const auto& element : energy.elements) group.push_back(index_of_name(result.groups, element_group(element)));
  result.strain = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(result.groups.size()), energy.strain.cols());
  for (std::size_t e = 0; e < group.size(); ++e)
    result.strain.row(group[e]) += energy.strain.row(static_cast<Eigen::Index>(e));
  return result;
}

}  // namespace annulus::dynamics
