#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/closed_form/closed_form_body.h"
#include "fem/closed_form/line_contact.h"
#include "fem/contact/complementarity.h"
#include "fem/contact/flank_contact.h"

namespace annulus::fem {

/// One tooth pair that may touch, as one unknown force.
struct ToothContact {
  int index = 0;                            ///< number of the pair, and of the pinion's tooth in cycle 0
  double roll = 0;                          ///< m, pinion roll length of the theoretical contact
  double nearest_roll = 0, gap = 0;         ///< m, where the flanks are nearest, modifications included
  Eigen::Vector3d pinion_root, wheel_root;  ///< root loads of a unit force, each in its own tooth's frame
  double cantilevers = 0;                   ///< m/N, of both teeth
  LineContact line;
};

/// Flanks that formulas do not bring into contact: tips that pass each other behind the path of contact, and those that
/// face each other more than a base pitch beyond it.
struct FlanksApart {
  int index = 0;
  double gap = 0;                           ///< m
  Eigen::Vector3d pinion_root, wheel_root;  ///< as of a ToothContact
};

/// All tooth pairs of one phase and their compliance but for the line contacts; the same in every mesh cycle and at
/// every load.
struct ToothContacts {
  double phase = 0;
  std::vector<ToothContact> pairs;
  Eigen::MatrixXd compliance;  ///< m/N
  double asymmetry = 0;        ///< of the compliance, formed in both directions
  std::vector<FlanksApart> apart;
};

/// Pairs up to one base pitch before and after the theoretical path, as in the finite-element models.
[[nodiscard]] ToothContacts find_contacts(const FlankContact& flanks, const ClosedFormBody& pinion,
                                          const ClosedFormBody& wheel, const MeshMaterials& materials, double width,
                                          double phase);

/// Forces of all pairs and supports at one position.
struct ToothContactSolution {
  ComplementarityProblem problem;    ///< line contacts linearised at the solution
  ComplementaritySolution solution;  ///< pairs first, then supports
  std::vector<LineContact::State> lines;
};

/// Solves one position: complementarity of pairs and supports, Newton's method for the line contacts. `supports` belong
/// to the wheel. Throws SolverError with phase, load and residual, and where the deflections close flanks that formulas
/// do not bring into contact.
[[nodiscard]] ToothContactSolution solve_contacts(const FlankContact& flanks, const ToothContacts& contacts,
                                                  const ClosedFormBody& pinion, const ClosedFormBody& wheel,
                                                  const std::vector<RingSupport>& supports, int cycle, double load,
                                                  const std::vector<bool>& start);

}  // namespace annulus::fem
