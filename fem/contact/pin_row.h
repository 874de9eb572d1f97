#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "fem/contact/contact_body.h"
#include "fem/ring_structure.h"

namespace annulus::fem {

/// The pins around a floating ring, as port loads on its outside.
///
/// Each pin acts on the rim over an arc of its own diameter with a parabolic distribution, in two fixed directions:
/// radially inwards (what a pressed pin does) and tangentially.
class PinRow {
 public:
  /// `mirrored`: the frame of the solve is the mirror image of the real ring, pin angles change sign.
  PinRow(const PinHeld& pins, const GearBody& ring, double outside_radius, double width, bool mirrored,
         double derived_stiffness);

  [[nodiscard]] int size() const { return static_cast<int>(angles_.size()); }
  [[nodiscard]] double stiffness() const { return stiffness_; }  ///< N/m per pin, radial and tangential alike
  [[nodiscard]] const PinHeld& parameters() const { return pins_; }
  /// 2 pins x 2 pins: displacements at the pins under unit pin forces, (radial inwards, tangential) per pin, m/N,
  /// the pins' own compliance included.
  [[nodiscard]] const Eigen::MatrixXd& compliance() const { return compliance_; }
  /// Displacement of a tooth's flank ports under unit pin forces, m/N: flank ports x 2 pins.
  [[nodiscard]] const Eigen::MatrixXd& to_ports(int tooth) const;
  /// Resultants (x, y, moment) of unit pin forces: 2 pins x 3.
  [[nodiscard]] const Eigen::MatrixXd& resultants() const { return resultants_; }

 private:
  PinHeld pins_;
  double stiffness_;
  std::vector<double> angles_;
  /// Per pin: the sectors it touches with their port loads (ports x 2).
  std::vector<std::vector<std::pair<int, Eigen::MatrixXd>>> loads_;
  Eigen::MatrixXd compliance_, resultants_;
  std::vector<Eigen::MatrixXd> to_stations_;  // per tooth: flank stations x 2 pins
};

}  // namespace annulus::fem
