#pragma once

#include <vector>

#include "fem/contact/flank_contact.h"

namespace annulus::fem {

/// What varies along the face beside the flanks' own profile, m.
struct FaceGaps {
  double misalignment = 0;  ///< as in LoadedMeshProblem
  /// From the low end of each gear's teeth, at which its lead modifications begin, to that of the common face.
  double pinion_below = 0, wheel_below = 0;
};

/// The face width of a gear mesh in slices, with the gaps between unloaded flanks that vary along it.
class ContactFace {
 public:
  /// `flanks` are referred to; `slice_edges` (m) ascend.
  ContactFace(const FlankContact& flanks, std::vector<double> slice_edges, const FaceGaps& gaps);

  [[nodiscard]] const FlankContact& flanks() const { return flanks_; }
  [[nodiscard]] const std::vector<double>& slice_edges() const { return slice_edges_; }      ///< m
  [[nodiscard]] double width() const { return slice_edges_.back() - slice_edges_.front(); }  ///< m
  /// m, normal to the flanks, by lead modifications and misalignment: mean over a slice, and least in it.
  [[nodiscard]] double lead_gap(int slice) const { return lead_gap_[slice]; }
  [[nodiscard]] double smallest_lead_gap(int slice) const { return smallest_lead_gap_[slice]; }
  [[nodiscard]] double smallest_lead_gap() const;  ///< m, of all slices
  /// Measured flanks in a slice; null where none were.
  [[nodiscard]] const FlankDeviations* measured(int slice) const {
    return measured_.empty() ? nullptr : &measured_[slice];
  }
  /// m, normal to the flanks: by how much these come nearer to each other within a slice, at these rolls, than the
  /// means of the measured flanks and smallest_lead_gap() say; negative where both do not add up.
  [[nodiscard]] double measured_dip(int slice, double pinion_roll, double wheel_roll) const;
  /// Whether flanks face each other in every slice in another way.
  [[nodiscard]] bool varies() const { return helical() || !measured_.empty(); }
  /// cos(base helix angle): normal approach of the flanks per transmission error.
  [[nodiscard]] double normal_factor() const { return normal_factor_; }
  [[nodiscard]] bool helical() const { return roll_per_z_ != 0; }
  /// m, pinion roll at the contact in the middle of a slice beyond that in the middle of the face.
  [[nodiscard]] double slice_roll(int slice) const;

 private:
  const FlankContact& flanks_;
  std::vector<double> slice_edges_;
  std::vector<double> lead_gap_, smallest_lead_gap_;
  std::vector<FlankDeviations> measured_;         ///< of every slice, or none
  std::vector<std::vector<double>> lead_across_;  ///< of these, m, at FlankTopography::slice_places positions
  double normal_factor_;
  double roll_per_z_;
};

/// Change of the pinion's roll at the contact along the face width: tan(base helix angle), signed.
[[nodiscard]] double roll_per_z(const FlankContact& flanks);

}  // namespace annulus::fem
