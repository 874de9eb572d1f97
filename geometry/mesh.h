#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geometry/profile.h"

namespace annulus::geometry {

/// A mesh of linear quadrilaterals (dimension 2, z = 0) or hexahedra (dimension 3), vertices counter-clockwise seen
/// from +z; a hexahedron lists its lower quadrilateral, then the upper one. Curved sides are the business of
/// `ToothProfile::project`: boundary vertices lie exactly on their curve.
struct Mesh {
  struct Face {
    std::array<std::uint32_t, 4> vertices{};  ///< 2 used in 2D, the body on their left
    Boundary boundary = Boundary::none;
  };
  enum class Region : int { tooth = 0, rim = 1, sleeve = 2, hoop = 3, flange = 4 };

  int dimension = 2;
  std::vector<Eigen::Vector3d> vertices;            ///< m
  std::vector<std::array<std::uint32_t, 8>> cells;  ///< 4 used in 2D
  std::vector<Region> regions;                      ///< one per cell
  std::vector<Face> faces;                          ///< boundary faces only

  /// Smallest scaled Jacobian (corner determinant over the product of the edge lengths) over all cells: 1 for
  /// rectangles, <= 0 for inverted cells.
  [[nodiscard]] double worst_scaled_jacobian() const;
  /// m^2 or m^3, exact for the straight-sided cells.
  [[nodiscard]] double area_or_volume() const;
};

/// The sector (plane or solid) repeated `count` times about the z axis counter-clockwise, the original first; shared
/// vertices merged by construction; a closed ring without sides when count = teeth. Cell c of copy k is cell
/// k * sector.cells.size() + c, and the side faces between copies disappear.
[[nodiscard]] Mesh repeat(const Mesh& sector, int teeth, int count);

/// One stack of layers for `extrude`: the cells of the plane mesh whose centre radius lies in [radius_low,
/// radius_high].
struct Layers {
  double z_low = 0, z_high = 0;  ///< m
  int cells = 1;
  double grading = 1;                         ///< ratio of the last to the first layer thickness
  Mesh::Region region = Mesh::Region::rim;    ///< rim: cells keep the region they have in the plane mesh
  bool toothed = true;                        ///< with the cells of the region tooth
  double radius_low = 0, radius_high = 1e99;  ///< m
  Mesh::Region band = Mesh::Region::hoop;     ///< of the cells beyond ExtrudeOptions::outside_radius: hoop or flange
};

struct ExtrudeOptions {
  /// Outside radius of the ring itself, where a hoop or a flange goes beyond it, m: a mesh circle of the plane mesh,
  /// whose support circle is then the outside of the hoop or flange. Infinite: nothing lies beyond.
  double outside_radius = std::numeric_limits<double>::infinity();
  /// Angle by which the section is turned counter-clockwise per metre of z, rad/m (ToothProfile::twist); the plane mesh
  /// is the section at z = 0. The sides stay images of each other under rotation by a pitch.
  double twist = 0;
  /// The twist fades out between two radii (m): beyond the second one the body runs parallel to the axis, turned as the
  /// section at `straight_z` (m). Absent: all of the section is twisted.
  struct Straight {
    double twisted_radius = 0, radius = 0, z = 0;
  };
  std::optional<Straight> straight{};
  /// The lower end of the lowest stack gets `end_low` from this radius outwards, `inner` within: a ring without a
  /// sleeve that is held by the rest of its end face, m.
  double end_low_radius = 0;
  /// Likewise the upper end of the highest stack and `end_high`.
  double end_high_radius = 0;
};

/// Hexahedra from a plane mesh, stacks from low to high z, each starting where the one before ends. Side, flank, ...
/// tags are copied; the lower end of the lowest stack gets `end_low`, the upper end of the highest `end_high`,
/// an exposed cylinder face at the ring's own outside radius `outside`, an exposed lower face of a flange beyond that
/// radius `flange_face`, every other exposed face (inside of a sleeve, toothed end beside it) `inner`. Face vertices
/// run counter-clockwise seen from outside the body.
[[nodiscard]] Mesh extrude(const Mesh& plane, const std::vector<Layers>& stacks, const ExtrudeOptions& options = {});

/// gmsh MSH 4.1 in m: one entity and one named physical group per region and per boundary. Throws Error on a failed
/// write.
void write_msh(const Mesh& mesh, const std::filesystem::path& file);

}  // namespace annulus::geometry
