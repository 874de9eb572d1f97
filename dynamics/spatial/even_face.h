#pragma once

#include <functional>
#include <vector>

#include "core/elastic_law.h"

namespace annulus::dynamics {

/// A mesh whose stiffness is spread evenly over the face: every part of it presses with the force of the whole mesh
/// under the approach there, divided by the face width, and knows nothing of its neighbours. Between stations the
/// approach is linear; where it ends the contact, the integrals end there, so that a straight approach is exact with
/// any number of stations.
class EvenFace final : public FaceLaw {
 public:
  /// `stiffness`: N/m, along the normal, of the whole mesh. `stations`: m, rising, two or more, the ends of the face
  /// among them. `gap`: m, before deformation, one per station. Throws InputError when they do not fit.
  EvenFace(double stiffness, std::vector<double> stations, std::vector<double> gap);

  [[nodiscard]] int size() const override { return static_cast<int>(stations_.size()); }
  [[nodiscard]] State at(const Eigen::VectorXd& approach) const override;
  [[nodiscard]] Eigen::MatrixXd in_contact() const override;
  [[nodiscard]] const std::vector<double>& stations() const override { return stations_; }
  [[nodiscard]] double face_width() const override { return stations_.back() - stations_.front(); }
  [[nodiscard]] Eigen::VectorXd line_load(const Eigen::VectorXd& approach, const State& state) const override;

 private:
  double stiffness_;  ///< N/m per m of face width
  std::vector<double> stations_;
  Eigen::VectorXd gap_;
};

}  // namespace annulus::dynamics
