#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/gear_body.h"

namespace annulus::fem {

/// A difference of plane compliances on one flank: what a fine plane mesh adds to the near field of a coarse one,
/// m/(N/m) per unit width, applied slice by slice to a solid body.
struct NearFieldTerm {
  TraceBasis flank;
  Eigen::MatrixXd compliance;
  double sign = 1;
};

/// A gear body prepared for contact: the compliance of its flanks under loads that are constant over axial slices.
class ContactBody {
 public:
  /// `slice_edges`: z of the slice borders (m), ascending; in the plane {0, width} with one slice.
  ContactBody(GearBody body, const std::vector<double>& slice_edges, std::vector<NearFieldTerm> near_field = {});

  [[nodiscard]] const GearBody& body() const { return body_; }
  [[nodiscard]] int slices() const { return slices_; }

  /// Weights of the profile stations of each pressure element of a pair: one column per element, column sum 1.
  using Weights = Eigen::MatrixXd;

  /// Mean displacement into the material over (element, slice) of tooth `tooth_a` under unit forces on (element,
  /// slice) of tooth `tooth_b`, m/N; rows and columns ordered [element * slices + slice].
  [[nodiscard]] Eigen::MatrixXd compliance(const Weights& a, int tooth_a, const Weights& b, int tooth_b) const;
  /// Near-field terms for one pair; the arguments are the rolls at the quadrature points behind the elements.
  [[nodiscard]] Eigen::MatrixXd near_field(const std::vector<std::vector<double>>& rolls,
                                           const std::vector<std::vector<double>>& weights) const;
  /// Port forces of unit (element, slice) forces: ports x (element, slice).
  [[nodiscard]] Eigen::MatrixXd port_weights(const Weights& a) const;
  /// Resultants (x, y, moment about the axis) of unit (element, slice) forces on a tooth: 3 columns.
  [[nodiscard]] Eigen::MatrixXd resultants(const Weights& a, int tooth) const;

 private:
  GearBody body_;
  int slices_ = 1;
  std::vector<double> slice_width_;
  Eigen::MatrixXd axial_;                    // axial stations x slices, column sum 1
  std::vector<Eigen::MatrixXd> compressed_;  // per offset: (station, slice) x (station, slice)
  std::vector<NearFieldTerm> near_field_;
};

}  // namespace annulus::fem
