#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/contact/flank_patch.h"
#include "fem/contact/half_plane.h"
#include "fem/gear_body.h"

namespace annulus::fem {

/// What a fine plane mesh adds to the near field of a solid body's coarse flank, applied slice by slice: the compliance
/// of the fine plane tooth less that of a plane tooth as coarse as the solid, m per N/m.
struct NearField {
  TraceBasis fine, coarse;
  Eigen::MatrixXd fine_compliance, coarse_compliance;
};

/// A gear body prepared for contact: the compliance of its flanks under loads on pressure elements that are constant
/// over slices of the face width.
class ContactBody {
 public:
  /// `slice_edges`: z of the slice borders (m), ascending; in the plane {0, width} with one slice. `near_field`: solid
  /// bodies only. `base_radius` of the gear; `contact_slant`: length of a contact line per face width.
  ContactBody(GearBody body, double base_radius, const Material& material, const std::vector<double>& slice_edges,
              std::optional<NearField> near_field = {}, double contact_slant = 1);

  [[nodiscard]] const GearBody& body() const { return body_; }
  [[nodiscard]] int slices() const { return slices_; }

  /// The load that stands for an element on this body's mesh: as wide as the mesh needs to resolve it, as near to the
  /// ends of the flank as it fits.
  [[nodiscard]] FlankLoad make_load(double arc, double half_length) const;
  /// Fills the weights of a patch whose loads are given.
  void find_weights(FlankPatch& patch) const;

  /// Mean displacement into the material over the elements of `a` on tooth `tooth_a` under unit forces on those of `b`,
  /// m/N, as the mesh gives it.
  [[nodiscard]] Eigen::MatrixXd compliance(const FlankPatch& a, int tooth_a, const FlankPatch& b, int tooth_b) const;
  /// What is missing within one patch: the near field of loads that the mesh does not resolve.
  [[nodiscard]] Eigen::MatrixXd near_field(const FlankPatch& patch) const;
  /// Resultants (x, y, moment about the axis) of unit element forces on a tooth: elements x 3.
  [[nodiscard]] Eigen::MatrixXd resultants(const FlankPatch& patch, int tooth) const;
  /// Port forces of unit element forces: flank ports x elements.
  [[nodiscard]] Eigen::MatrixXd port_weights(const FlankPatch& patch) const;

 private:
  [[nodiscard]] Eigen::MatrixXd weights_on(const TraceBasis& flank, const std::vector<FlankLoad>& loads) const;
  /// Length of the mesh's cells at a place of the flank, m, continuous along it.
  [[nodiscard]] double cell_length(double arc) const;

  GearBody body_;
  double base_radius_;
  HalfPlane half_plane_;
  int slices_ = 1;
  std::vector<double> slice_length_;         // of the contact line, m
  Eigen::MatrixXd axial_;                    // axial stations x slices, column sum 1
  std::vector<Eigen::MatrixXd> compressed_;  // per offset: (station, slice) x (station, slice)
  std::optional<NearField> near_field_;
  std::vector<double> cell_centres_, cell_lengths_;
};

}  // namespace annulus::fem
