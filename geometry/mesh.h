#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "geometry/profile.h"

namespace annulus::geometry {

/// A mesh of linear quadrilaterals (dimension 2, z = 0) or hexahedra (dimension 3), vertices counter-clockwise seen
/// from +z; a hexahedron lists its lower quadrilateral, then the upper one. Curved sides are the business of
/// `ToothProfile::project`: boundary vertices lie exactly on their curve.
struct Mesh {
  struct Face {
    std::array<std::uint32_t, 4> vertices{};  ///< 2 used in 2D
    Boundary boundary = Boundary::none;
  };
  enum class Region : int { tooth = 0, rim = 1, sleeve = 2, hoop = 3 };

  int dimension = 2;
  std::vector<Eigen::Vector3d> vertices;               ///< m
  std::vector<std::array<std::uint32_t, 8>> cells;     ///< 4 used in 2D
  std::vector<Region> regions;                         ///< one per cell
  std::vector<Face> faces;                             ///< boundary faces only

  /// Smallest scaled Jacobian over all cells: 1 for rectangles, <= 0 for inverted cells.
  [[nodiscard]] double worst_scaled_jacobian() const;
  [[nodiscard]] double area_or_volume() const;
};

/// The sector repeated `count` times about the z axis, shared vertices merged; a full ring when count = teeth.
[[nodiscard]] Mesh repeat(const Mesh& sector, int teeth, int count);

/// One stack of layers for `extrude`.
struct Layers {
  double z_low = 0, z_high = 0;  ///< m
  int cells = 1;
  double grading = 1;  ///< ratio of the last to the first layer thickness
  Mesh::Region region = Mesh::Region::rim;
  bool toothed = true;        ///< whole cross-section
  double radius_low = 0;      ///< not toothed: only cells whose centre radius lies in [radius_low, radius_high]
  double radius_high = 1e99;
};
/// Hexahedra from a plane mesh, stacks from low to high z. Side, flank, ... tags are carried over; free ends get
/// end_low / end_high, newly exposed annular faces get `inner`.
[[nodiscard]] Mesh extrude(const Mesh& plane, const std::vector<Layers>& stacks);

void write_msh(const Mesh& mesh, const std::filesystem::path& file);  ///< gmsh 4.1, physical groups by boundary
void write_vtu(const Mesh& mesh, const std::filesystem::path& file);  ///< VTK XML unstructured grid

}  // namespace annulus::geometry
