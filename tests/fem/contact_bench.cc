#include "contact_bench.h"

#include <cmath>
#include <memory>
#include <vector>

namespace annulus::tests {
namespace {

fem::LoadedMeshSettings settings_for(fem::Fidelity fidelity, Symmetry symmetry, int degree) {
  fem::LoadedMeshSettings settings;
  settings.fidelity = fidelity;
  settings.symmetry = symmetry == Symmetry::used;
  settings.degree = degree;
  return settings;
}

}  // namespace

ContactBench::ContactBench(const fem::LoadedMeshProblem& problem, int level, fem::Fidelity fidelity, Symmetry symmetry,
                           int degree)
    : problem_(problem),
      flanks_(problem.pair),
      bodies_(build_bodies(problem, flanks_, settings_for(fidelity, symmetry, degree), level)) {
  options_.half_face = bodies_.face.half;
  // As many pressure elements as solve_loaded_mesh takes at this level.
  options_.elements =
      static_cast<int>(std::lround((fidelity == fem::Fidelity::solid ? 6 : 10) * std::pow(1.25, level - 1)));
  misalign(problem.misalignment);
}

void ContactBench::misalign(double misalignment) {
  options_.gaps = {misalignment, problem_.pinion_overhang.below, problem_.wheel_overhang.below};
  rebuild();
}

void ContactBench::set_elements(int elements) {
  options_.elements = elements;
  rebuild();
}

void ContactBench::rebuild() {
  system_ =
      std::make_unique<fem::ContactSystem>(flanks_, *bodies_.pinion, *bodies_.wheel, bodies_.supports.get(),
                                           problem_.materials, bodies_.slice_edges, options_, bodies_.rollers.get());
  pairs_ = {};
  warm_ = {};
}

fem::LoadedPosition ContactBench::solve(double phase, double load) {
  return system_->solve(0, phase, load, pairs_, warm_, nullptr);
}

fem::ContactForces ContactBench::forces(double phase, double load) {
  fem::ContactForces forces;
  (void)system_->solve(0, phase, load, pairs_, warm_, &forces);
  return forces;
}

std::vector<fem::LoadedPosition> ContactBench::sweep(int steps, double load) {
  std::vector<fem::LoadedPosition> positions;
  for (int i = 0; i <= steps; ++i) positions.push_back(solve(static_cast<double>(i) / steps, load));
  return positions;
}

}  // namespace annulus::tests
