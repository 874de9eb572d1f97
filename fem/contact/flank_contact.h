#pragma once

#include <Eigen/Core>
#include <utility>

#include "geometry/flank_topography.h"
#include "geometry/gear_pair.h"
#include "geometry/profile.h"

namespace annulus::fem {

/// What measured flanks differ by from their profiles, over the face or in a slice of it.
struct FlankDeviations {
  geometry::FlankTopography::Slice pinion{}, wheel{};
};

/// Exact geometry of one tooth pair: pinion leading flank against the wheel's working flank, in the position in which
/// the conjugate flanks would touch at a given pinion roll length.
///
/// Frame of the solve: wheel at the origin, pinion at (a, 0). In the ring mesh the pinion turns counter-clockwise and
/// presses its leading flank on the trailing flank of a ring tooth; in the sun mesh the sun turns counter-clockwise and
/// presses its leading flank on the pinion's leading flank. (A real planet uses its two flanks in its two meshes; its
/// teeth are symmetric.)
class FlankContact {
 public:
  explicit FlankContact(const geometry::GearPair& pair);

  struct Match {
    double wheel_roll = 0;  ///< roll length of the wheel point on the pinion's normal, m
    double gap = 0;         ///< distance along the pinion's normal, modifications included, m; < 0: overlap
  };
  /// The wheel point opposite to pinion roll `pinion_roll`; `contact_roll` is the position. `measured`: deviations of
  /// the flanks, where there are any. Throws SolverError when the pinion's normal misses the wheel's involute.
  [[nodiscard]] Match match(double pinion_roll, double contact_roll, const FlankDeviations* measured = nullptr) const;

  struct Interval {
    double low = 0, high = 0;
    [[nodiscard]] bool empty() const { return !(high > low); }
  };
  /// Pinion roll lengths where both flanks exist (from form circle to tip of both gears), cut at the tip edges.
  [[nodiscard]] Interval domain(double contact_roll) const;
  /// Whether there is such an interval.
  [[nodiscard]] bool face_each_other(double contact_roll) const;
  /// Smallest gap over the domain: zero for an unmodified pair within the theoretical line of action.
  [[nodiscard]] double smallest_gap(double contact_roll) const;
  /// Pinion roll length in the domain (that of the contact) where the gap is smallest.
  [[nodiscard]] double nearest_roll(double contact_roll, const Interval& domain,
                                    const FlankDeviations* measured = nullptr) const;

  [[nodiscard]] const geometry::GearPair& pair() const { return pair_; }
  [[nodiscard]] const geometry::ToothProfile& pinion() const { return pinion_; }
  [[nodiscard]] const geometry::ToothProfile& wheel() const { return wheel_; }
  /// The working flank of the wheel.
  [[nodiscard]] geometry::Boundary wheel_flank() const {
    return pair_.internal() ? geometry::Boundary::trailing_flank : geometry::Boundary::leading_flank;
  }
  /// Angles of the two teeth in the frame of the solve when the pair's contact roll is `contact_roll`, rad.
  [[nodiscard]] double pinion_tooth_angle(double contact_roll) const;
  [[nodiscard]] double wheel_tooth_angle(double contact_roll) const;

 private:
  /// Wheel roll and distance of the unmodified flanks; roll 0 (below the base circle) or infinity: no opposite point.
  [[nodiscard]] std::pair<double, double> opposite(double pinion_roll, double contact_roll) const;
  /// Where to begin looking for it.
  [[nodiscard]] double guessed_opposite(double pinion_roll, double contact_roll) const;

  geometry::GearPair pair_;
  geometry::ToothProfile pinion_, wheel_;
  double pinion_base_half_angle_, wheel_base_half_angle_;
  double normal_factor_;  ///< cosine of the base helix angle
  bool modified_;         ///< either gear
};

/// Number of the wheel's tooth in pair `index` during mesh cycle `cycle`.
[[nodiscard]] int wheel_tooth(const FlankContact& flanks, int index, int cycle);
/// Angle of the pitch point in the real wheel's own frame, rad, when pair `index` has its theoretical contact at the
/// pinion roll length `roll`.
[[nodiscard]] double pitch_point_angle(const FlankContact& flanks, int index, double roll, int cycle);

}  // namespace annulus::fem
