#pragma once

#include <Eigen/Core>
#include <vector>

namespace annulus::fem {

/// A unit force spread evenly over one pressure element of a flank.
///
/// The mesh does not get the element itself, which may be far shorter than its cells, but a semi-elliptical load of
/// the same resultant and centre that the mesh resolves; the half-plane solution of the difference is added.
struct FlankLoad {
  double arc = 0;          ///< m, centre along the flank, s = rho^2 / (2 r_b)
  double half_length = 0;  ///< m, along the flank
  double spread = 0;       ///< m, half-width of the semi-ellipse
};

/// The pressure elements on one flank of one tooth: which load in which slice of the face width.
struct FlankPatch {
  std::vector<FlankLoad> loads;
  struct Element {
    int load = 0, slice = 0;
  };
  std::vector<Element> elements;
  Eigen::MatrixXd weights;  ///< of the loads on the profile stations of the body: stations x loads, column sums 1
};

}  // namespace annulus::fem
