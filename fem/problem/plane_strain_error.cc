#include "fem/problem/plane_strain_error.h"

namespace annulus::fem {

double plane_strain_error(const LoadedMeshProblem& problem) {
  const double nu = problem.material.poisson_ratio;
  const double width = problem.face_width / problem.pair.planet().parameters().module;
  return 0.65 * nu * nu / (1 - nu * nu) / (1 + width / 10);
}

}  // namespace annulus::fem
