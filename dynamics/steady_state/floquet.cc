#include "dynamics/steady_state/floquet.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "dynamics/modes/dense_spectrum.h"
#include "dynamics/modes/modes.h"

namespace annulus::dynamics {

Eigen::VectorXcd floquet_multipliers(const LumpedSystem& system, const Eigen::VectorXd& mesh_stiffness,
                                     const SampledMeshes& meshes, double period) {
  const Eigen::Index n = system.dofs(), count = mesh_stiffness.size(), samples = meshes.samples();
  const Eigen::MatrixXd b = system.mesh_vectors();
  const Eigen::MatrixXd stiffness =
      system.stiffness() + system.rotating_stiffness() + b * mesh_stiffness.asDiagonal() * b.transpose();
  const Eigen::MatrixXd damping = system.damping_with_meshes() + system.gyroscopic();
  const Modes found = modes(system, mesh_stiffness);
  const Eigen::MatrixXd shapes = found.shapes();
  // Rigid displacements act on nothing, and rigid velocities only where something damps or turns them.
  const Eigen::Index free = neutral_motions(found, stiffness, system.mass());
  Eigen::Index loose = 0;
  while (loose < free && costs_no_force(shapes.col(loose), damping, system.mass())) ++loose;
  const Eigen::Index elastic = n - free, moving = n - loose;
  const auto bent = shapes.rightCols(elastic);
  const auto swift = shapes.rightCols(moving);
  const double w = std::max(2 * std::numbers::pi * found.modes.back().frequency, 1 / period);
  // Elastic displacements and velocities / w: entries of like size.
  const Eigen::Index size = elastic + moving;
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(size, size);
  state.topRightCorner(elastic, elastic).setIdentity();
  state.bottomLeftCorner(moving, elastic) = -swift.transpose() * stiffness * bent / (w * w);
  state.bottomRightCorner(moving, moving) = -swift.transpose() * damping * swift / w;
  // Impulses further apart than half a cycle of a mode act on it as on a slower one, which makes it grow or not.
  constexpr double fine = 1;
  constexpr Eigen::Index most_steps = 4096;
  const double needed = w * period / fine / static_cast<double>(samples);
  const auto affordable = static_cast<double>(std::max<Eigen::Index>(1, most_steps / samples));
  const int parts = static_cast<int>(std::ceil(std::clamp(needed, 1.0, affordable)));
  const double step = period / static_cast<double>(samples * parts);
  const Eigen::MatrixXd drift = exponential(state * (w * step));
  Eigen::MatrixXd of_displacement = b.transpose() * bent, of_velocity = b.transpose() * swift;
  // Modes so fast feel the mean alone: hundreds of vibrations in a mesh cycle are in no resonance with it.
  for (Eigen::Index mode = free; mode < n && needed > affordable; ++mode) {
    if (2 * std::numbers::pi * found.modes[static_cast<std::size_t>(mode)].frequency * step <= fine) continue;
    of_displacement.col(mode - free).setZero();
    of_velocity.col(mode - loose).setZero();
  }
  // Changes of the mesh forces with approaches and rates, beyond those of the constant stiffness and damping.
  std::vector<Eigen::MatrixXd> tangent(static_cast<std::size_t>(samples), Eigen::MatrixXd(count, count));
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(samples, count), force(samples, count), damper = meshes.damping();
  for (Eigen::Index m = 0; m < count; ++m) {
    damper.col(m).array() -= system.meshes()[static_cast<std::size_t>(m)].damping;
    unit.col(m).setOnes();
    meshes.apply_tangent(unit, mesh_stiffness, force);
    for (Eigen::Index i = 0; i < samples; ++i) tangent[static_cast<std::size_t>(i)].col(m) = force.row(i);
    unit.col(m).setZero();
  }
  const Eigen::MatrixXd gain = of_velocity * of_velocity.transpose();
  Eigen::MatrixXd map = Eigen::MatrixXd::Identity(size, size);
  for (Eigen::Index i = 0; i < samples; ++i) {
    const Eigen::Index next = (i + 1) % samples;
    for (int part = 0; part < parts; ++part) {
      const double share = part / static_cast<double>(parts);
      const auto between = [share](const auto& here, const auto& there) { return (1 - share) * here + share * there; };
      auto velocity = map.bottomRows(moving);
      const Eigen::MatrixXd change =
          between(tangent[static_cast<std::size_t>(i)], tangent[static_cast<std::size_t>(next)]);
      const Eigen::VectorXd resists = between(damper.row(i), damper.row(next)).transpose();
      const Eigen::MatrixXd kick =
          (step / w) * of_velocity.transpose() * (change * (of_displacement * map.topRows(elastic)));
      if (resists.any()) {
        // The rate in the middle of the impulse.
        const Eigen::MatrixXd resisted =
            Eigen::MatrixXd::Identity(count, count) + (step / 2) * gain * resists.asDiagonal();
        const Eigen::MatrixXd rate = resisted.partialPivLu().solve(of_velocity * (velocity - kick / 2));
        velocity -= kick + step * of_velocity.transpose() * (resists.asDiagonal() * rate);
      } else {
        velocity -= kick;
      }
      map = drift * map;
    }
  }
  const Eigen::VectorXcd all = eigenvalues(map, "the Floquet multipliers");
  std::vector<std::complex<double>> sorted(all.begin(), all.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](auto x, auto y) { return std::abs(x) > std::abs(y); });
  return Eigen::Map<Eigen::VectorXcd>(sorted.data(), static_cast<Eigen::Index>(sorted.size()));
}

}  // namespace annulus::dynamics
