#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "app/scene/scene.h"

/// Pins and structure of the carrier of a stage in space.
namespace annulus::app {

/// Stiffness of the pins on the carrier, with its structure: SpatialStage::pins. The wall of cantilevers and flexpins
/// stands on the side of -z. `planet_angles`: rad. Nothing where neither pins nor carrier give way.
[[nodiscard]] std::optional<Eigen::MatrixXd> pins_in_space(const Scene& scene, const std::vector<double>& planet_angles,
                                                           double radius);

/// Reads a carrier's stiffness from a file (docs/exchange.md): 5 coordinates per planet in the axes of the carrier,
/// along x, y, z and about x, y. Throws InputError with what is wrong in it.
[[nodiscard]] Eigen::MatrixXd read_carrier_stiffness(const std::filesystem::path& file, int planets);

}  // namespace annulus::app
