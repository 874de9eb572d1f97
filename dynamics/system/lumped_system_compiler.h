#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <memory>

#include "dynamics/system/lumped_system.h"
#include "dynamics/system/lumped_system_compiled.h"

namespace annulus::dynamics {

/// Turns an assembled system into the flat arrays that the right-hand side reads. One object compiles one system.
class LumpedSystemCompiler {
 public:
  /// Throws InputError when the mass matrix is not positive definite.
  explicit LumpedSystemCompiler(const LumpedSystem& system);

  /// Throws InputError when a moving share or a coupling does not fit the meshes and DOFs of the system.
  [[nodiscard]] std::shared_ptr<const LumpedSystem::Compiled> compile();

 private:
  void compile_matrices();
  void compile_power();
  void compile_mesh(const MeshElement& mesh);
  void compile_excitation(const MeshElement& mesh, CompiledMesh& compiled);
  void compile_errors(const MeshElement& mesh, CompiledMesh& compiled);
  void compile_moving_shares();
  void compile_friction();
  void compile_coupling(const MeshCoupling& coupling);
  void check_coupling(const MeshCoupling& coupling) const;
  void compile_law(const LawElement& element);
  void compile_face(const FaceElement& face, int number);
  /// That a mesh exists and depends on no other yet.
  void check_uncoupled(const std::string& what, int mesh) const;
  void check_without_backlash(const std::string& what, int mesh) const;
  void compile_rows();

  const LumpedSystem& system_;
  int dofs_ = 0;
  Eigen::LLT<Eigen::MatrixXd> mass_;
  Eigen::MatrixXd inverse_;  ///< |M^-1|, entry by entry
  std::shared_ptr<LumpedSystem::Compiled> compiled_;
};

}  // namespace annulus::dynamics
