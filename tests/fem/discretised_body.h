#pragma once

#include <Eigen/CholmodSupport>
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <vector>

#include "fem/problem/material.h"
#include "geometry/mesh.h"

namespace annulus::tests {

/// A finite-element body without deal.II's headers: nodes, the stiffness of all DOFs, nodes of each boundary.
struct DiscretisedBody {
  int dimension = 2;
  std::vector<Eigen::Vector3d> nodes;
  std::vector<int> dof;  ///< [node * dimension + component]
  Eigen::SparseMatrix<double> stiffness;
  Eigen::SparseMatrix<double> nodal_mass;  ///< of one component, nodes x nodes
  std::function<std::vector<int>(geometry::Boundary)> boundary_nodes;
};

using Projection = std::function<Eigen::Vector2d(geometry::Boundary, const Eigen::Vector2d&)>;

DiscretisedBody discretise_body(const geometry::Mesh& mesh, const Projection& project, const fem::Material& material,
                                int degree);

/// The part of a matrix that belongs to the DOFs that are not fixed, and the way there and back.
struct FreeSystem {
  std::vector<int> row;  ///< DOF -> row, -1 when fixed
  Eigen::SparseMatrix<double> matrix;
  FreeSystem(const Eigen::SparseMatrix<double>& full, const std::vector<bool>& fixed);
  [[nodiscard]] Eigen::MatrixXd restrict_rows(const Eigen::MatrixXd& full) const;
  [[nodiscard]] Eigen::MatrixXd extend_rows(const Eigen::MatrixXd& free) const;  ///< zero at the fixed DOFs
};

/// Direct solution, for comparison.
class SparseCholesky {
 public:
  explicit SparseCholesky(const Eigen::SparseMatrix<double>& matrix);
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_sides) const;

 private:
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace annulus::tests
