#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/figure.h"
#include "dynamics/modes/modes.h"

namespace annulus::dynamics {

/// Distribution of the energy of each mode. The strain share of a spring is k (a^T phi)^2 / phi^T K phi: the relative
/// change of omega^2 per relative change of its stiffness. The share of a mesh is F^2/k / phi^T K phi. The rest of
/// coupled meshes, F^T D F, belongs to an element with the name MeshCoupling::body.
struct ModalEnergy {
  std::vector<std::string> elements;  ///< springs, then meshes, then bodies that couple them
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

/// The shares summed up by group.
struct GroupedEnergy {
  std::vector<std::string> groups;  ///< of elements
  Eigen::MatrixXd strain;           ///< groups x modes
  std::vector<std::string> bodies;  ///< "planet" for planet1, planet2, ...
  Eigen::MatrixXd kinetic;          ///< bodies x modes
};
/// `groups` and `bodies` come first, with zeros where the system has none of them; others follow as they appear.
[[nodiscard]] GroupedEnergy by_group(const ModalEnergy& energy, std::vector<std::string> groups = {},
                                     std::vector<std::string> bodies = {});
/// Name of a mode, "body on group", or "rigid" without strain: those with most kinetic and most strain energy.
[[nodiscard]] std::string mode_name(const GroupedEnergy& energy, Eigen::Index mode);

/// A natural frequency with its error.
struct Frequency {
  Figure figure;  ///< Hz
  ErrorParts parts{};
};

/// The n-th of frequencies in order is within the n-th of their lower and of their upper ends: where error bars of
/// neighbours overlap, either may be the n-th. Nothing changes where an error is not known.
void widen_to_neighbours(std::vector<Frequency>& frequencies);

/// The relative error of a quantity that some groups of elements are made of.
struct GroupError {
  std::vector<std::string> groups;
  double relative = 0;
  ErrorParts parts{};  ///< of `relative`, where they are known
  /// d ln f / d ln quantity of a mode that has all its strain energy in these groups: 1/2 for a stiffness, 1 for the
  /// own frequencies of an elastic body.
  double sensitivity = 0.5;
};
/// The error of a frequency is the sum of the relative errors times sensitivity and share of the strain energy of the
/// mode; all quantities are taken to err the same way; widened to neighbours.
[[nodiscard]] std::vector<Frequency> frequency_errors(const Modes& modes, const GroupedEnergy& energy,
                                                      const std::vector<GroupError>& errors);

}  // namespace annulus::dynamics
