#pragma once

#include <Eigen/Core>
#include <vector>

namespace annulus {

/// Forces over the deflections of some coordinates that have a convex potential: bearings, meshes, couplings.
/// Deflections and forces share their signs: a force > 0 resists a deflection > 0.
class ElasticLaw {
 public:
  ElasticLaw() = default;
  ElasticLaw(const ElasticLaw&) = delete;
  ElasticLaw& operator=(const ElasticLaw&) = delete;
  virtual ~ElasticLaw() = default;

  struct State {
    double energy = 0;        ///< J
    Eigen::VectorXd force;    ///< N, N m: one per coordinate
    Eigen::MatrixXd tangent;  ///< d force / d deflection, symmetric, positive semi-definite
  };
  [[nodiscard]] virtual int size() const = 0;  ///< number of coordinates
  /// At deflections (m, rad), one per coordinate. Throws what solving throws.
  [[nodiscard]] virtual State at(const Eigen::VectorXd& deflection) const = 0;
  /// The tangent while everything that can touch does: what the law resists at all.
  [[nodiscard]] virtual Eigen::MatrixXd in_contact() const = 0;
};

/// The mesh of two gears along its face in one position. Coordinates are the approaches of the flanks' rigid bodies
/// along the normal of the flanks at some stations along the face, m, with the contact in the pitch point; forces are
/// what the flanks press with there. A law whose contacts lie elsewhere on the path of contact has one coordinate more:
/// the lean, by which the approach grows per metre from the pitch point along the line of action into the driven gear.
class FaceLaw : public ElasticLaw {
 public:
  /// z of the stations, m, rising, from the middle of the common face.
  [[nodiscard]] virtual const std::vector<double>& stations() const = 0;
  [[nodiscard]] virtual double face_width() const = 0;  ///< m
  [[nodiscard]] bool leans() const { return size() > static_cast<int>(stations().size()); }
  /// N, of all stations, in a state.
  [[nodiscard]] double force(const State& state) const {
    return state.force.head(static_cast<Eigen::Index>(stations().size())).sum();
  }
  /// Force per face width at the stations, N/m, along the normal, of a state.
  [[nodiscard]] virtual Eigen::VectorXd line_load(const Eigen::VectorXd& approach, const State& state) const = 0;
};

}  // namespace annulus
