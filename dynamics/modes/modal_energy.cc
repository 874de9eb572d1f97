#include "dynamics/modes/modal_energy.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

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
  const Eigen::MatrixXd mesh_vectors = system.mesh_vectors();
  // Where a law acts beside springs, its meshes have no stiffness.
  std::vector<Eigen::Index> element_of_mesh(system.meshes().size(), -1);
  for (std::size_t m = 0; m < system.meshes().size(); ++m) {
    if (mesh_stiffness[static_cast<Eigen::Index>(m)] == 0) continue;
    element_of_mesh[m] = std::ssize(result.elements);
    result.elements.push_back(system.meshes()[m].name);
  }
  const Eigen::MatrixXd coupled = mesh_stiffness_matrix(system, mesh_stiffness);
  for (const auto& coupling : system.couplings()) (void)index_of_name(result.elements, coupling.body);

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
      for (std::size_t m = 0; m < element_of_mesh.size(); ++m)
        if (const auto n = static_cast<Eigen::Index>(m); element_of_mesh[m] >= 0)
          result.strain(element_of_mesh[m], i) = force[n] * force[n] / mesh_stiffness[n];
      for (const auto& coupling : system.couplings())
        for (const int m : coupling.meshes) {
          const auto element = element_of_mesh[static_cast<std::size_t>(m)];
          result.strain(index_of_name(result.elements, coupling.body), i) +=
              delta[m] * force[m] - (element < 0 ? 0.0 : result.strain(element, i));
        }
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
  for (const char* direction : {"_x", "_y", "_u", "_radial", "_tangential", "_along", "_across", "_tilt"})
    if (group.ends_with(direction)) return group.substr(0, group.rfind('_'));
  return group;
}

GroupedEnergy by_group(const ModalEnergy& energy, std::vector<std::string> groups, std::vector<std::string> bodies) {
  const auto summed = [](const std::vector<std::string>& names, const Eigen::MatrixXd& shares,
                         std::vector<std::string>& sum_names) {
    std::vector<Eigen::Index> group;
    group.reserve(names.size());
    for (const auto& name : names) group.push_back(index_of_name(sum_names, element_group(name)));
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(sum_names.size()), shares.cols());
    for (std::size_t i = 0; i < group.size(); ++i) sums.row(group[i]) += shares.row(static_cast<Eigen::Index>(i));
    return sums;
  };
  GroupedEnergy result{std::move(groups), {}, std::move(bodies), {}};
  result.strain = summed(energy.elements, energy.strain, result.groups);
  result.kinetic = summed(energy.bodies, energy.kinetic, result.bodies);
  return result;
}

std::string mode_name(const GroupedEnergy& energy, Eigen::Index mode) {
  if (!(energy.strain.col(mode).sum() > 0)) return "rigid";
  Eigen::Index body = 0, group = 0;
  (void)energy.kinetic.col(mode).maxCoeff(&body);
  (void)energy.strain.col(mode).maxCoeff(&group);
  return energy.bodies[static_cast<std::size_t>(body)] + " on " + energy.groups[static_cast<std::size_t>(group)];
}

void widen_to_neighbours(std::vector<Frequency>& frequencies) {
  if (std::any_of(frequencies.begin(), frequencies.end(), [](const auto& f) { return std::isnan(f.figure.error); }))
    return;
  const auto own = frequencies;
  for (const double side : {-1.0, 1.0}) {
    const auto end = [&](const Frequency& f) { return f.figure.value + side * f.figure.error; };
    auto order = own;
    std::stable_sort(order.begin(), order.end(), [&](const auto& a, const auto& b) { return end(a) < end(b); });
    for (std::size_t n = 0; n < frequencies.size(); ++n) {
      auto& [figure, parts] = frequencies[n];
      const double reach = side * (end(order[n]) - figure.value);
      if (reach <= figure.error * (1 + 1e-12)) continue;
      // Those that may have changed places with it.
      const auto at = order.begin() + static_cast<std::ptrdiff_t>(n);
      const auto& widest =
          *std::max_element(side < 0 ? order.begin() : at, side < 0 ? at + 1 : order.end(),
                            [](const auto& a, const auto& b) { return a.figure.error < b.figure.error; });
      figure.error = reach;
      parts = (reach / widest.figure.error) * widest.parts;
    }
  }
}

std::vector<Frequency> frequency_errors(const Modes& modes, const GroupedEnergy& energy,
                                        const std::vector<GroupError>& errors) {
  std::vector<Frequency> result;
  for (std::size_t i = 0; i < modes.modes.size(); ++i) {
    auto& [figure, parts] = result.emplace_back(Frequency{{modes.modes[i].frequency, 0}});
    for (const auto& error : errors) {
      double share = 0;
      for (std::size_t g = 0; g < energy.groups.size(); ++g)
        if (std::find(error.groups.begin(), error.groups.end(), energy.groups[g]) != error.groups.end())
          share += energy.strain(static_cast<Eigen::Index>(g), static_cast<Eigen::Index>(i));
      const double weight = figure.value * error.sensitivity * std::abs(share);
      figure.error += weight * error.relative;
      parts += weight * error.parts;
    }
  }
  widen_to_neighbours(result);
  return result;
}

}  // namespace annulus::dynamics
