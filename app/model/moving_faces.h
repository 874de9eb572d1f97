#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "core/elastic_law.h"

namespace annulus::app {

/// The faces of the meshes of a lumped model whose bodies tilt.
struct MovingFaces {
  /// The law of a mesh (in the order of the model) at mesh cycles, any number of threads; empty: no mesh has one.
  std::function<std::shared_ptr<const FaceLaw>(std::size_t mesh, double cycles)> law{};
  /// cos(base helix angle) where forces and tilts of the motion are those of the transverse section, else 1.
  double to_normal = 1;
};

}  // namespace annulus::app
