#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem/contact/tooth_pairs.h"

namespace annulus::fem {

/// Contact forces of tooth pairs between bodies that are brought together by given amounts:
///
///     w = C f + g - P a,   f >= 0, w >= 0, f w = 0
///
/// f are the forces of the pressure elements, a the approaches of the rigid bodies (m, along the normal) in every slice
/// and, as the last one, their lean: what the approach grows by per metre along the line of action (`arms`, m, one per
/// element). The forces are unique, and the gradient of a convex potential.
class ImposedContact {
 public:
  ImposedContact(std::shared_ptr<const ToothPairs> pairs, int slices, Eigen::VectorXd arms);

  struct Solution {
    double energy = 0;           ///< J
    Eigen::VectorXd force;       ///< N per slice, and N m of the lean
    Eigen::MatrixXd tangent;     ///< d force / d a
    bool at_window_end = false;  ///< an element that has to stay free touches
    int iterations = 0;
  };
  /// Starts from the contacts of the solution before: these save time and do not change the result but for rounding.
  /// Throws SolverError when the contacts do not settle.
  [[nodiscard]] Solution solve(const Eigen::VectorXd& approach);
  [[nodiscard]] const ToothPairs& pairs() const { return *pairs_; }

 private:
  /// Factorises the compliance of the active elements, unless that has been done.
  void factorise(const std::vector<bool>& active);

  std::shared_ptr<const ToothPairs> pairs_;
  int slices_;
  Eigen::VectorXd gap_, arms_;
  std::vector<int> slice_;  // of every element
  std::vector<bool> outermost_, active_, factorised_;
  std::vector<int> set_;    // numbers of the active elements
  Eigen::MatrixXd factor_;  // lower
};

}  // namespace annulus::fem
