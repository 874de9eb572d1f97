#pragma once

#include <Eigen/Core>
#include <string>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Kinds of modes of equally spaced planets [LinParker1999].
enum class ModeKind {
  rotational,     ///< central bodies only turn, all planets move equally
  translational,  ///< central bodies do not turn; in pairs from three planets on
  planet,         ///< central bodies stand still, planets move differently
  mixed           ///< none of them: planets not equally spaced, or a single one
};
[[nodiscard]] std::string to_string(ModeKind kind);

/// Distinguishes the kinds by shares of the kinetic energy. DOFs are identified by their names (sun_x, planet1_u, ...);
/// others, such as elastic ones, are ignored.
class KindSorter {
 public:
  KindSorter(const LumpedSystem& system, int planets);

  /// Kind of a shape normalised to shape^H M shape = 1.
  [[nodiscard]] ModeKind operator()(const Eigen::VectorXcd& shape) const;
  /// Shapes (columns) of one multiple frequency are any basis of their space. Returns the basis in which each shape is
  /// of one kind, where it exists, normalised to shape^H M shape = 1. Throws SolverError for dependent shapes.
  [[nodiscard]] Eigen::MatrixXd separated(const Eigen::MatrixXd& shapes) const;
  [[nodiscard]] Eigen::MatrixXcd separated(const Eigen::MatrixXcd& shapes) const;

 private:
  template <class Matrix>
  [[nodiscard]] Matrix separate(const Matrix& shapes) const;

  Eigen::MatrixXd mass_;
  // Rows: root of the mass x amplitude of a motion that distinguishes kinds; the norm of map x shape is its energy.
  Eigen::MatrixXd central_translation_, central_rotation_;
  Eigen::MatrixXd planets_unlike_;  ///< the planets' motion less its mean over the planets
};

}  // namespace annulus::dynamics
