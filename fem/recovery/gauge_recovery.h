#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fem/body/gear_body.h"
#include "fem/contact/contact_forces.h"
#include "fem/contact/support_row.h"
#include "fem/problem/strain_gauge.h"

namespace annulus::fem {

/// What a finer section makes of the strain of a gauge in a root, as a factor, both under the force on a flank beside
/// it that strains it most: cells of a solid body follow a fillet with too few points. `gauge`: its number in both,
/// whose own gauges are in plane sections; `angle`: rad, in its tooth space.
[[nodiscard]] double gauge_factor(std::size_t gauge, double angle, const GearBody& fine, const GearBody& coarse);

/// The strain of one gauge on a whole body under given forces on its teeth and supports.
///
/// The strain is a load of the condensed body like a stress (StressRecovery). The body carried it to all of its
/// interfaces when it was composed: by reciprocity the strain under any forces is a product of vectors.
class GaugeRecovery {
 public:
  /// Gauge number `gauge` of `body`, which is referred to, like `supports`, which may be null. The strains are
  /// multiplied by `factor`.
  GaugeRecovery(std::size_t gauge, const GearBody& body, double face_width, const SupportRow* supports,
                double factor = 1);

  /// Strains at the places that are 0, 1, ... teeth further counter-clockwise; one per tooth of the body.
  [[nodiscard]] Eigen::VectorXd strains(const std::vector<ToothForces>& teeth, const Eigen::VectorXd& supports) const;

 private:
  [[nodiscard]] int number(int sector) const { return ((sector % body_.teeth) + body_.teeth) % body_.teeth; }

  const GearBody& body_;
  const GaugeProbe& probe_;
  const SupportRow* supports_;
  double per_width_;
  int first_load_, loads_;
  double factor_;
  /// Strain of the gauge turned by k teeth under unit support forces, the k-th row; without what passes inside a
  /// sector.
  Eigen::MatrixXd at_supports_;
};

}  // namespace annulus::fem
