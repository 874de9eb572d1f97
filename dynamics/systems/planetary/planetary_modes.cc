#include "dynamics/systems/planetary/planetary_modes.h"

namespace annulus::dynamics {

namespace {

/// Combines the shapes of every multiple frequency so that each is of one kind.
void separate_multiples(const KindSorter& sorter, std::vector<Mode>& modes) {
  for (std::size_t begin = 0, end = 0; begin < modes.size(); begin = end) {
    // Rounding splits equal frequencies by some 1e-15 of the highest; different kinds so close together are equal for
    // every purpose.
    constexpr double same = 1e-9, of_the_highest = 1e-14;
    for (end = begin + 1; end < modes.size(); ++end)
      if (modes[end].frequency - modes[begin].frequency >
          same * modes[end].frequency + of_the_highest * modes.back().frequency)
        break;
    if (end - begin == 1) continue;
    Eigen::MatrixXd shapes(modes[begin].shape.size(), static_cast<Eigen::Index>(end - begin));
    for (std::size_t i = begin; i < end; ++i) shapes.col(static_cast<Eigen::Index>(i - begin)) = modes[i].shape;
    shapes = sorter.separated(shapes);
    for (std::size_t i = begin; i < end; ++i) modes[i].shape = shapes.col(static_cast<Eigen::Index>(i - begin));
  }
}

}  // namespace

Eigen::VectorXd mean_mesh_stiffness(const PlanetaryStage& stage) {
  Eigen::VectorXd stiffness(2 * stage.planets());
  stiffness.head(stage.planets()).setConstant(mean_tangent_stiffness(stage.sun_mesh));
  stiffness.tail(stage.planets()).setConstant(mean_tangent_stiffness(stage.ring_mesh));
  return stiffness;
}

ModalEnergy modal_energy(const PlanetaryStage& stage, const Modes& modes) {
  return modal_energy(assemble(stage), mean_mesh_stiffness(stage), modes);
}

PlanetaryModes modes(const PlanetaryStage& stage) {
  const LumpedSystem system = assemble(stage);
  PlanetaryModes result{modes(system, mean_mesh_stiffness(stage)), {}};
  const KindSorter sorter(system, stage.planets());
  separate_multiples(sorter, result.modes);
  for (const auto& mode : result.modes) result.kinds.push_back(sorter(mode.shape));
  return result;
}

}  // namespace annulus::dynamics
