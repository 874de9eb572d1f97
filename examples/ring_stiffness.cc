// Mesh stiffness of a planet in a ring that is held outside, over one mesh cycle.
#include <cstdio>

#include "fem/loaded_mesh.h"

using namespace annulus;

int main() {
  geometry::GearParameters gear{.teeth = 24, .module = 4e-3, .pressure_angle = 0.349, .face_width = 60e-3};
  const geometry::Gear planet(gear);
  gear.kind = geometry::GearKind::internal;
  gear.teeth = 72;
  gear.tip_diameter = 281e-3;
  fem::LoadedMeshProblem problem{geometry::GearPair(planet, geometry::Gear(gear), 96e-3), fem::Material{}, 60e-3, 22e-3,
                                 165e-3};
  problem.loads = {10e3};
  problem.phases = 8;
  const auto result = fem::solve_loaded_mesh(problem, {});
  for (const auto& p : result.positions)
    std::printf("phase %.3f: %.4g N/um, error %.1g %%\n", p.mesh_phase, p.entry.stiffness_secant / 1e6,
                100 * p.entry.error_relative);
}
