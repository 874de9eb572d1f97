#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/contact/support_row.h"
#include "fem/ring/ring_flexibility.h"

namespace annulus::fem {

/// A ring that floats on pins or splines: its mesh forces and inertia loads with the supports' forces eliminated.
class RingOnSupports {
 public:
  /// `ring` has the plan's arcs; both are referred to.
  RingOnSupports(const RingFlexibility& ring, const SupportPlan& plan);

  struct State {
    Eigen::VectorXd displacement;  ///< m, of the work partners of the given loads
    Eigen::MatrixXd tangent;       ///< its derivative by the forces, the same supports touching, m/N; symmetric
    std::vector<bool> touching;    ///< per support force
    Eigen::VectorXd support;       ///< N, support forces
  };
  /// Mesh forces: `patterns` (teeth x loads) says how a unit load lies on the teeth, `forces` (N) how large they are;
  /// `start` guesses which supports touch (may be empty). Throws SolverError when the contact does not settle.
  [[nodiscard]] State solve(const Eigen::MatrixXd& patterns, const Eigen::VectorXd& forces,
                            std::vector<bool> start) const;
  /// Is there a support that can lift off?
  [[nodiscard]] bool unilateral() const;

  /// Compliance between the mesh forces of all teeth, then the inertia loads of all sectors [1 + sector * motions +
  /// motion], all pins or spline flanks held both ways, a housing bore left away.
  [[nodiscard]] Eigen::MatrixXd held_compliance() const;
  /// Its part between the mesh forces of all teeth.
  [[nodiscard]] Eigen::MatrixXd held_teeth_compliance() const;

 private:
  /// Loads first ... first + count - 1 of every sector: displacements under support forces, forces x (sector, load).
  [[nodiscard]] Eigen::MatrixXd coupling(int first, int count) const;
  /// Supports that can be held both ways: all but those of a housing bore.
  [[nodiscard]] std::vector<Eigen::Index> held() const;

  const RingFlexibility& ring_;
  const SupportPlan& plan_;
  Eigen::MatrixXd compliance_;      // between support forces
  Eigen::MatrixX3d resultants_;     // of support forces; moments over the base radius
  Eigen::MatrixXd teeth_coupling_;  // support forces x teeth
};

}  // namespace annulus::fem
