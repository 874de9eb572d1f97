#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/radial_bearing.h"
#include "fem/contact/flank_contact.h"
#include "fem/contact/support_row.h"
#include "fem/problem/planet_rollers.h"

namespace annulus::fem {

/// A planet's bed of rollers, and where its other mesh acts on it.
///
/// The other mesh presses on the other flanks of the planet: its frame is the mirror image of this one, so that its
/// contact on a tooth follows from the angle at which that tooth stands. Its load, as large as this mesh's, is shared
/// by its pairs by a parabola over its path of contact: far from the contact solved here only its resultant counts.
class PlanetOnRollers {
 public:
  /// Places of the other flank at which forces are applied.
  static constexpr int places = 7;

  /// `planet` was condensed for the arcs of bed() and for `places`; it is referred to.
  PlanetOnRollers(const PlanetRollers& rollers, SupportPlan bed, const GearBody& planet);

  /// The bed of a planet: up to four patches behind every tooth, on their own unilateral in every slice. Of one patch
  /// the load zone would have to be some teeth wide.
  [[nodiscard]] static SupportPlan bed(const PlanetRollers& rollers, int teeth, std::vector<double> slice_edges,
                                       FacePart part);

  /// Patches behind every tooth.
  [[nodiscard]] static int patches_per_tooth(int teeth, int slices);

  [[nodiscard]] const SupportRow& row() const { return row_; }
  [[nodiscard]] double play() const { return row_.gap()[0]; }  ///< m
  /// Forces that the other mesh applies to the planet whose tooth 0 stands at `angle` (rad) in the frame of the solve,
  /// per N of its load: as the last ones of row().
  [[nodiscard]] Eigen::VectorXd partner_forces(double angle) const;

  /// A change of the loads: of this mesh and of the other one, N/N, and of the forces of row() with it.
  struct Change {
    double own = 0, other = 0;
    Eigen::VectorXd forces{};
  };
  /// What the motion of a planet with a rigid rim adds to the transmission error, m, if the bed carries as much as it
  /// does under a load of this mesh and `forces` of row() (N), and how it changes, m/N. Throws SolverError where no
  /// equilibrium is found.
  struct Motion {
    double transmission_error = 0;
    std::vector<double> slopes{};  ///< one per change
  };
  [[nodiscard]] Motion bearing_motion(double load, const Eigen::VectorXd& forces,
                                      const std::vector<Change>& changes) const;

 private:
  /// Bed under a motion of a round rim: what is left of a force, and its tangent.
  void press(const Eigen::Vector2d& motion, const Eigen::Vector2d& force, Eigen::Vector2d& residual,
             Eigen::Matrix2d& stiffness) const;
  /// The motion of a round rim under a force; `stiffness`: there, N/m.
  [[nodiscard]] Eigen::Vector2d round_rim(const Eigen::Vector2d& force, Eigen::Matrix2d& stiffness) const;

  FlankContact partner_;
  RadialBearing bearing_;
  const GearBody& planet_;
  SupportRow row_;
  Eigen::MatrixXd directions_;  ///< of the bed's forces, as resultants: forces x 2
  Eigen::VectorXd stiffness_;   ///< N/m, of the bed under each
};

}  // namespace annulus::fem
