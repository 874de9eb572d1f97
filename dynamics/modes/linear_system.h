#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/system/lumped_system.h"

namespace annulus::dynamics {

/// The matrices of a lumped system for small motions, all teeth in contact, at time 0:
///
///   M q'' + (C + G) q' + (K + K_Omega) q = f,   K = K_supports + B K_m B^T,   C = C_supports + B C_m B^T
///
/// with the mean tangents of the meshes. Errors e of the meshes (m) add B (K_m e + C_m e') to f.
struct LinearSystem {
  std::vector<std::string> dofs, meshes;
  Eigen::MatrixXd mass;                ///< M, kg, DOFs x DOFs
  Eigen::MatrixXd damping;             ///< C, N s/m
  Eigen::MatrixXd gyroscopic;          ///< G, N s/m, skew
  Eigen::MatrixXd stiffness;           ///< K, N/m
  Eigen::MatrixXd rotating_stiffness;  ///< K_Omega, N/m: centripetal and circulatory terms
  Eigen::MatrixXd mesh_vectors;        ///< B, DOFs x meshes
  Eigen::MatrixXd mesh_stiffness;      ///< K_m, N/m, meshes x meshes; diagonal without a common elastic body
  Eigen::VectorXd mesh_damping;        ///< the diagonal of C_m, N s/m
  Eigen::VectorXd load;                ///< f without errors, N
};
/// Throws SolverError as mesh_stiffness_matrix() does.
[[nodiscard]] LinearSystem linear_system(const LumpedSystem& system);

}  // namespace annulus::dynamics
