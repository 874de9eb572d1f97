#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "fem/loaded_mesh.h"

namespace annulus::app {

/// A deformed body near its contact: vertices and faces that are seen, turned so that the contact lies in the direction
/// of x.
struct BodyView {
  std::string name{};
  std::vector<Eigen::Vector3d> place{}, moved{};  ///< m: at rest, and displacement
  std::vector<double> stress{};                   ///< von Mises, Pa, of every vertex
  std::vector<std::array<std::uint32_t, 4>> faces{};
  int dimension = 2;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();   ///< rows: to the right, upwards, to the eye
  double largest_displacement = 0, largest_stress = 0;  ///< m, Pa
  double size = 0;                                      ///< m, of the largest side of its box
  double exaggeration = 1;                              ///< of the displacements
  double colour_top = 1;                                ///< Pa, upper end of the colours
  double mesh_phase = 0;
  int ring_tooth = 0;
};

/// `name`: of the body, for readers. Without faces when the field has no cells.
[[nodiscard]] BodyView body_view(const fem::BodyField& field, const fem::LoadedPosition& position,
                                 const std::string& name);

}  // namespace annulus::app
