#pragma once

#include <Eigen/Core>
#include <string>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// Lin and Parker (J. Vib. Acoust. 121, 1999): rotational: the central bodies only turn and all planets move alike;
/// translational: the central bodies do not turn (in pairs from three planets on); planet: the central bodies stand
/// still and the planets move differently. `mixed`: none of them (planets not equally spaced, or a single one).
enum class ModeKind { rotational, translational, planet, mixed };
[[nodiscard]] std::string to_string(ModeKind kind);

/// Tells the kinds apart by the shares of the kinetic energy. DOFs are known by their names (sun_x, planet1_u,
/// ...); others, such as elastic ones, take no part.
class KindSorter {
 public:
  KindSorter(const LumpedSystem& system, int planets);

  /// Kind of a shape normalised to shape^H M shape = 1.
  [[nodiscard]] ModeKind operator()(const Eigen::VectorXcd& shape) const;
  /// Shapes (columns) of one multiple frequency may be mixed at will; returns a basis of the same space, normalised to
  /// shape^H M shape = 1, in which each shape is of one kind, when there is one.
  [[nodiscard]] Eigen::MatrixXd separated(const Eigen::MatrixXd& shapes) const;
  [[nodiscard]] Eigen::MatrixXcd separated(const Eigen::MatrixXcd& shapes) const;

 private:
  template <class Matrix>
  [[nodiscard]] Matrix separate(const Matrix& shapes) const;

  Eigen::MatrixXd mass_;
  // Rows: root of the mass x the amplitude of a motion that tells kinds apart; the norm of map x shape is its energy.
  Eigen::MatrixXd central_translation_, central_rotation_;
  Eigen::MatrixXd planets_unlike_;  ///< the planets' motion less its mean over the planets
};

}  // namespace annulus::dynamics
