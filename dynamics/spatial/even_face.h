#pragma once

#include <functional>
#include <vector>

#include "core/elastic_law.h"

namespace annulus::dynamics {

/// A whole mesh under an approach of its flanks: work (J), force (N) and tangent (N/m), all along the normal.
struct MeshPoint {
  double energy = 0, force = 0, tangent = 0;
};
/// Over the approach, m, > 0.
using MeshLaw = std::function<MeshPoint(double approach)>;

/// A mesh whose stiffness is spread evenly over the face: every part of it presses with the force of the whole mesh
/// under the approach there, divided by the face width, and knows nothing of its neighbours. Between stations the
/// approach is linear; where it ends the contact, the integrals end there. Three points of Gauss integrate each
/// stretch: a straight approach of a linear law is exact with any number of stations.
class EvenFace final : public FaceLaw {
 public:
  /// `stiffness`: N/m, what is left of the tangent of the law in contact. `stations`: m, rising, two or more, the ends
  /// of the face among them. `gap`: m, before deformation, one per station. Throws InputError when they do not fit.
  EvenFace(MeshLaw law, double stiffness, std::vector<double> stations, std::vector<double> gap);
  /// A linear law of this stiffness.
  EvenFace(double stiffness, std::vector<double> stations, std::vector<double> gap);

  [[nodiscard]] int size() const override { return static_cast<int>(stations_.size()); }
  [[nodiscard]] State at(const Eigen::VectorXd& approach) const override;
  [[nodiscard]] Eigen::MatrixXd in_contact() const override { return in_contact_; }
  [[nodiscard]] const std::vector<double>& stations() const override { return stations_; }
  [[nodiscard]] double face_width() const override { return stations_.back() - stations_.front(); }
  [[nodiscard]] Eigen::VectorXd line_load(const Eigen::VectorXd& approach, const State& state) const override;

 private:
  [[nodiscard]] State integral(const MeshLaw& law, const Eigen::VectorXd& above_gap) const;

  MeshLaw law_;
  std::vector<double> stations_;
  Eigen::VectorXd gap_;
  Eigen::MatrixXd in_contact_;
};

}  // namespace annulus::dynamics
