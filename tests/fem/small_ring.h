#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "discretised_body.h"
#include "fem/contact/support_row.h"
#include "fem/ring/ring_flexibility.h"

namespace annulus::tests {

/// A small toothed ring twice: reduced to its mesh forces, inertia and arc loads, and as one whole mesh.
struct SmallRing {
  geometry::Gear gear;
  double outside = 0, width = 0;
  fem::SectorModel sector;
  fem::SectorLoads loads;
  fem::RingFlexibility flexibility;
  DiscretisedBody whole;
  std::vector<bool> fixed;                ///< DOFs of the whole that are held
  std::vector<std::vector<int>> node_of;  ///< [sector][node of the sector] -> node of the whole

  /// Load `load` of sector `sector` over the DOFs of the whole, in the units of `flexibility`: divided by the width
  /// in the plane.
  [[nodiscard]] Eigen::VectorXd whole_load(int sector, int load) const;
  /// Stiffness of supports (a spring per force, all touching) over the DOFs of the whole.
  [[nodiscard]] Eigen::SparseMatrix<double> support_stiffness(const fem::SupportPlan& plan) const;
  /// Arc loads of a support force, likewise.
  [[nodiscard]] Eigen::VectorXd support_load(const fem::SupportPlan& plan, int force) const;
  /// Consistent mass over the DOFs of the whole, per unit of width in the plane.
  [[nodiscard]] Eigen::SparseMatrix<double> whole_mass() const;
  [[nodiscard]] double per_width() const { return whole.dimension == 2 ? 1 / width : 1; }
};

enum class SmallHeld { outside, sleeve, floating };

/// `plan`: supports of a floating ring.
SmallRing small_ring(int teeth, SmallHeld held, const fem::MotionOrder& motions,
                     const fem::SupportPlan* plan = nullptr);
enum class SmallPins { unilateral, both_ways };
/// Pins of prescribed stiffness around the small ring.
fem::SupportPlan small_ring_pins(int teeth, std::vector<double> angles, double radial, double tangential,
                                 SmallPins kind, double clearance = 0);

/// The lowest frequencies (Hz) of K x = omega^2 M x by subspace iteration.
Eigen::VectorXd lowest_frequencies(const Eigen::SparseMatrix<double>& stiffness,
                                   const Eigen::SparseMatrix<double>& mass, int count);

}  // namespace annulus::tests
