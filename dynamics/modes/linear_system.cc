#include "dynamics/modes/linear_system.h"

#include "dynamics/modes/modes.h"

namespace annulus::dynamics {

LinearSystem linear_system(const LumpedSystem& system) {
  const auto tangents = mean_tangents(system);
  LinearSystem result{.dofs = system.names(),
                      .meshes = {},
                      .mass = system.mass(),
                      .damping = system.damping_with_meshes(),
                      .gyroscopic = system.gyroscopic(),
                      .stiffness = stiffness_with_meshes(system, tangents),
                      .rotating_stiffness = system.rotating_stiffness(),
                      .mesh_vectors = system.mesh_vectors(),
                      .mesh_stiffness = mesh_stiffness_matrix(system, tangents),
                      .mesh_damping = Eigen::VectorXd(static_cast<Eigen::Index>(system.meshes().size())),
                      .load = system.load_at(0)};
  for (const auto& mesh : system.meshes()) {
    result.mesh_damping[static_cast<Eigen::Index>(result.meshes.size())] = mesh.damping;
    result.meshes.push_back(mesh.name);
  }
  return result;
}

}  // namespace annulus::dynamics
