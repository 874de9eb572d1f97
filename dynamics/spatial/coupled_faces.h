#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/elastic_law.h"

namespace annulus::dynamics {

/// Meshes that act on each other through a common body: the approach of mesh n falls by sum_m D_nm F_m over its whole
/// face, F_m the total force of mesh m (MeshCoupling). Its coordinates are those of the meshes one after the other.
class CoupledFaces final : public ElasticLaw {
 public:
  /// `compliance`: D along the normal, m/N, meshes x meshes, symmetric. Throws InputError when it does not fit.
  CoupledFaces(std::vector<std::shared_ptr<const FaceLaw>> meshes, Eigen::MatrixXd compliance);

  [[nodiscard]] int size() const override { return first_.back(); }
  /// Newton's method. It starts from the state before, which saves time and does not change the result but for
  /// rounding: an object belongs to one thread. Throws SolverError when it does not find the forces.
  [[nodiscard]] State at(const Eigen::VectorXd& approach) const override;
  [[nodiscard]] Eigen::MatrixXd in_contact() const override;
  /// Number of the first coordinate of a mesh; behind the last one the number of all.
  [[nodiscard]] int first(std::size_t mesh) const { return first_.at(mesh); }
  /// m, by which the approach of each mesh falls in a state.
  [[nodiscard]] Eigen::VectorXd losses(const State& state) const;

 private:
  [[nodiscard]] Eigen::Index meshes() const { return std::ssize(meshes_); }
  /// Takes what the coupling adds off the tangents of the meshes alone.
  void soften(Eigen::MatrixXd& tangent) const;
  [[nodiscard]] Eigen::MatrixXd sums() const;
  /// N, of the meshes at an approach.
  [[nodiscard]] Eigen::VectorXd expected(const Eigen::VectorXd& approach) const;
  /// The state of this approach is what the next one is expected from.
  void remember(const Eigen::VectorXd& approach, const State& state) const;

  std::vector<std::shared_ptr<const FaceLaw>> meshes_;
  Eigen::MatrixXd compliance_;
  std::vector<int> first_;
  mutable Eigen::VectorXd last_approach_, last_force_;
  mutable Eigen::MatrixXd last_slope_;  // meshes x coordinates
};

}  // namespace annulus::dynamics
