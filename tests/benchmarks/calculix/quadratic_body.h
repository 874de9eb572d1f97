#pragma once

#include <Eigen/Core>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/profile.h"

namespace annulus::benchmarks {

/// A plane body of eight-node quadrilaterals.
struct QuadraticBody {
  struct Side {
    int cell = 0;
    int number = 0;  ///< 0 ... 3, from corner `number` to the next
    geometry::Boundary boundary = geometry::Boundary::none;
    int tooth = 0;
  };
  std::vector<Eigen::Vector2d> nodes;  ///< m
  std::vector<std::array<int, 8>>
      cells;                ///< corners counter-clockwise, then the middles of the sides after each corner
  std::vector<Side> sides;  ///< boundary sides, radial cuts included

  [[nodiscard]] std::vector<int> nodes_on(geometry::Boundary boundary) const;  ///< ascending
  /// Turned about the axis, then moved.
  void place(double angle, const Eigen::Vector2d& centre);
};

/// The teeth first ... last of a gear in its own frame, tooth 0 centred on +x. Teeth first_fine ... last_fine get the
/// mesh `fine`; the others one whose tooth is coarse and whose rim has the same cells along the radial cuts, so that
/// the meshes conform. Nodes on curved boundaries lie on the exact curve, the middles of sides too.
struct Segment {
  int first = 0, last = 0, first_fine = 0, last_fine = 0;
};
[[nodiscard]] QuadraticBody make_segment(const geometry::ToothProfile& profile, const geometry::Mesh& fine,
                                         double support_radius, const Segment& segment);
/// All teeth of a gear, a closed body; `fine_teeth` have the mesh `fine`, the others its coarse partner.
[[nodiscard]] QuadraticBody make_gear(const geometry::ToothProfile& profile, const geometry::Mesh& fine,
                                      double support_radius, const std::set<int>& fine_teeth);

}  // namespace annulus::benchmarks
