#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/modes/modes.h"

namespace annulus::dynamics {

/// Where the energy of each mode sits. The strain share of an element is k (a^T phi)^2 / phi^T K phi: the relative
/// change of omega^2 per relative change of its stiffness. Of a mesh it is F^2/k; what meshes coupled through the ring
/// leave, F^T D F, is the element ring_body.
struct ModalEnergy {
  std::vector<std::string>
      elements;            ///< springs (sun_support_x, planet1_bearing_radial, ...), then meshes (and ring_body)
  Eigen::MatrixXd strain;  ///< elements x modes; columns sum to 1, to 0 for rigid motions
  std::vector<std::string> bodies;  ///< of the DOFs: sun, ring, carrier, planet1, ...
  /// bodies x modes; columns sum to 1. A body without DOFs of its own counts with the one it rides on.
  Eigen::MatrixXd kinetic;
};
[[nodiscard]] ModalEnergy modal_energy(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness,
                                       const Modes& modes);

/// What an element belongs to: its name without planet number and direction, as sun_planet (mesh), planet_bearing,
/// sun_support.
[[nodiscard]] std::string element_group(const std::string& element);

/// The strain shares summed up by group.
struct GroupedEnergy {
  std::vector<std::string> groups;  ///< in order of first appearance
  Eigen::MatrixXd strain;           ///< groups x modes
};
[[nodiscard]] GroupedEnergy by_group(const ModalEnergy& energy);

}  // namespace annulus::dynamics
