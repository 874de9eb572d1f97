#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/closed_form/ring_loads.h"
#include "fem/closed_form/ring_supports.h"
#include "fem/closed_form/tooth_cantilever.h"

namespace annulus::fem {

/// Which theory carries the loads of the teeth through the rim.
enum class RimTheory {
  elastic_ring,  ///< exact plane elasticity of the annulus: any thickness
  curved_beam,   ///< Winkler and Bach's beam with shear, as in the ring paper: slender rims
};

/// What carries the loads of the teeth through the rim of a ring on supports.
struct RimModel {
  RimTheory theory = RimTheory::elastic_ring;
  /// Teeth stiffen a bending rim as a layer on its inside would, whatever the thickness of the rim: what they add
  /// decays within a pitch (a boundary layer). Its thickness in root pitches, measured, not derived: plane finite
  /// elements of the ring paper's ring with rims of 5 to 35 mm give 0.06 to 0.09, the thinnest most (docs/methods.md).
  double tooth_band = 0.07;
};

/// A gear in closed form: teeth as cantilevers on a plain ring between the root circle and the support circle. Loads
/// enter the ring over the roots of the teeth (uniform axial and transverse tractions, linear ones for the moment, as
/// in [SainsotVelexDuverger2004]) and over the arcs of the supports; what a load does is measured by the work of
/// these tractions, so that reciprocity is exact. Neighbouring teeth are coupled through the ring.
///
/// On its own supports a ring yields as a whole: to the foundation with the outside held is added what the rim yields
/// more without. In that the teeth count as a thin layer on the inside (see the source).
class ClosedFormBody {
 public:
  /// Without supports the support circle is held (rigid hub, ring held on its outside). `width` in m, `neighbours`: the
  /// farthest teeth whose coupling is wanted.
  ClosedFormBody(const geometry::ToothProfile& profile, double support_radius, double width, const Material& material,
                 const std::vector<RingSupport>& supports, const RimModel& model, int neighbours);

  [[nodiscard]] const ToothCantilever& tooth() const { return tooth_; }
  [[nodiscard]] bool floating() const { return support_compliance_.size() > 0; }
  /// Displacement of the root of tooth `offset` (axial, transverse, rotation) under unit root loads on tooth 0, each in
  /// its own tooth's frame, m/N.
  [[nodiscard]] Eigen::Matrix3d root_compliance(int offset) const;
  /// The part of `root_compliance(0)` with the support circle held: without motions of a ring on its supports.
  [[nodiscard]] const Eigen::Matrix3d& foundation_compliance() const { return foundation_; }
  /// Displacement of the root of a tooth under unit forces of every support, m/N: 3 x supports.
  [[nodiscard]] Eigen::MatrixXd root_from_supports(int tooth) const;
  /// Between the supports, their own springs included, m/N.
  [[nodiscard]] const Eigen::MatrixXd& support_compliance() const { return support_compliance_; }
  /// Resultants (x, y, moment about the axis) of unit root loads on a tooth and of unit support forces, one row each,
  /// in the frame of tooth 0.
  [[nodiscard]] Eigen::Matrix3d root_resultants(int tooth) const;
  [[nodiscard]] const Eigen::MatrixXd& support_resultants() const { return support_resultants_; }

 private:
  /// Adds what the ring yields because only supports hold it: `rim` as a whole against the same rim held outside.
  void let_yield(const PlainRing& rim, double width, RimTheory theory, const std::vector<RingSupport>& supports,
                 int terms);

  ToothCantilever tooth_;
  double pitch_angle_;
  int teeth_;
  Eigen::Matrix3d foundation_;
  std::vector<Eigen::Matrix3d> root_;           // offsets -neighbours ... neighbours
  std::vector<Eigen::MatrixXd> from_supports_;  // per tooth
  Eigen::MatrixXd support_compliance_, support_resultants_;
};

}  // namespace annulus::fem
