#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/modes/modes.h"

namespace annulus::dynamics {

/// Distribution of the energy of each mode. The strain share of a spring is k (a^T phi)^2 / phi^T K phi: the relative
/// change of omega^2 per relative change of its stiffness. The share of a mesh is F^2/k / phi^T K phi. The rest of
/// meshes coupled through the ring, F^T D F, belongs to the element ring_body.
struct ModalEnergy {
  std::vector<std::string> elements;  ///< springs, then meshes (and ring_body)
  Eigen::MatrixXd strain;             ///< elements x modes; columns sum to 1, to 0 for rigid motions
  std::vector<std::string> bodies;    ///< of the DOFs
  /// bodies x modes; columns sum to 1. A body without DOFs of its own counts with the body that carries it.
  Eigen::MatrixXd kinetic;
};
/// `mesh_stiffness`: N/m, one per mesh, as for the modes.
[[nodiscard]] ModalEnergy modal_energy(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness,
                                       const Modes& modes);

/// Group of an element: its name without planet number and direction, such as sun_planet (mesh), planet_bearing or
/// sun_support.
[[nodiscard]] std::string element_group(const std::string& element);

/// The strain shares summed up by group.
struct GroupedEnergy {
  std::vector<std::string> groups;  ///< in order of first appearance
  Eigen::MatrixXd strain;           ///< groups x modes
};
[[nodiscard]] GroupedEnergy by_group(const ModalEnergy& energy);

}  // namespace annulus::dynamics
