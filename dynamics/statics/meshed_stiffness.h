#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>

namespace annulus::dynamics {

/// Solves (K + V T V^T) q = f for one K and many tangents T of the meshes. With the mean stiffnesses k of the meshes,
/// A = K + V k V^T and D = T - k, Woodbury's formula
///
///   q = A^-1 f - A^-1 V (1 + D S)^-1 D V^T A^-1 f,   S = V^T A^-1 V,
///
/// needs a factorisation of the size of the meshes alone [Woodbury1950]. Where a mesh is far softer than its mean
/// stiffness, as an open one, its digits would cancel: the whole matrix is factorised.
class MeshedStiffness {
 public:
  /// `stiffness`: N/m, DOFs x DOFs, symmetric. `vectors`: V, DOFs x meshes. `mean`: k, N/m, one per mesh.
  MeshedStiffness(Eigen::MatrixXd stiffness, Eigen::MatrixXd vectors, const Eigen::VectorXd& mean);

  [[nodiscard]] const Eigen::MatrixXd& stiffness() const { return stiffness_; }
  [[nodiscard]] const Eigen::MatrixXd& vectors() const { return vectors_; }
  /// Other mesh vectors from now on.
  void set_vectors(Eigen::MatrixXd vectors);
  /// `tangent`: T, N/m, meshes x meshes, symmetric. False where the sum is not positive definite.
  [[nodiscard]] bool factorise(const Eigen::MatrixXd& tangent);
  /// q of the tangents that were factorised last, m, one column per column of `force` (N).
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& force) const;

 private:
  /// Positive definite, and no mesh far softer than its mean.
  [[nodiscard]] bool suits_formula(const Eigen::MatrixXd& tangent);

  Eigen::MatrixXd stiffness_, vectors_;
  Eigen::VectorXd mean_;
  bool reducible_ = false;               // A is positive definite, and worth it
  Eigen::MatrixXd inverse_, of_meshes_;  // A^-1, A^-1 V
  Eigen::MatrixXd across_, change_;      // S, D
  bool reduced_ = false;
  Eigen::LLT<Eigen::MatrixXd> whole_, tangent_;
  Eigen::PartialPivLU<Eigen::MatrixXd> small_;
};

}  // namespace annulus::dynamics
