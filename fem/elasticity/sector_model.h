#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "core/not_known.h"
#include "fem/elasticity/nodal_load.h"
#include "fem/problem/material.h"
#include "geometry/mesh.h"
#include "geometry/profile.h"

namespace annulus::fem {

/// The element nodes on a boundary as a tensor grid: a profile coordinate (roll length on a flank, polar angle on a
/// circle) times the axial coordinate. In the plane there is one axial station of unit width.
struct TraceGrid {
  int degree = 2;
  std::vector<double> profile;  ///< ascending; m or rad
  std::vector<double> axial;    ///< ascending, m; {0} in the plane
  std::vector<int> nodes;       ///< [profile index * axial.size() + axial index]
  [[nodiscard]] int size() const { return static_cast<int>(nodes.size()); }
};

/// Nodes of a free surface, by polar angle in the sector's frame and z, with their stress; [as `trace.nodes`].
struct StressSurface {
  TraceGrid trace;
  std::vector<SurfaceStress> stress;
};

/// The vertices and cells of the refined mesh with the stress at every vertex, the mean of the adjacent cells.
struct VertexField {
  std::vector<int> nodes;                           ///< of every vertex
  std::vector<std::array<std::uint32_t, 8>> cells;  ///< of vertices, numbered as in geometry::Mesh
  /// Rows [vertex][xx, yy, zz, xy and, of a solid, yz, zx], columns [node][component]: Pa/m.
  Eigen::SparseMatrix<double, Eigen::RowMajor> stress;
};

/// Which boundary of a sector is held.
enum class HeldBoundary { none, support, end_low, flange_face, both_ends };
/// Whether any boundary of a sector is held: a floating ring moves rigidly.
enum class SectorSupport { held, floating };
[[nodiscard]] inline SectorSupport support_of(HeldBoundary held) {
  return held == HeldBoundary::none ? SectorSupport::floating : SectorSupport::held;
}

/// One discretised tooth sector, free of deal.II: stiffness over the DOFs that are not held, and the nodes that
/// matter to the outside.
struct SectorModel {
  int dimension = 2;
  double pitch_angle = 0;
  Eigen::SparseMatrix<double> stiffness;
  std::vector<Eigen::Vector3d> nodes;
  std::vector<int> dof;                    ///< [node * dimension + component] -> row of `stiffness`, or -1 when held
  std::vector<int> low_nodes, high_nodes;  ///< matched pairs on the two cyclic interfaces, wholly held nodes left out
  TraceGrid flank;                         ///< of the contact flank
  TraceGrid other_flank;                   ///< opposite to the contact flank, on the same tooth
  TraceGrid outside;                       ///< of the support circle where it is free
  StressSurface root_low, root_high;       ///< root land and fillet of the trailing (y < 0) and of the leading side
  StressSurface rim;                       ///< of the support circle (empty when held)
  Eigen::SparseMatrix<double> nodal_mass;  ///< of one component, nodes x nodes; see ElasticProblem
  VertexField field;
};

/// Members of a SectorModel that are filled on demand.
enum class SectorOutput {
  outside,      ///< outside
  other_flank,  ///< other_flank
  stress,       ///< root_low, root_high, and rim where the support circle is free
  mass,         ///< nodal_mass
  field         ///< field
};

struct SectorModelOptions {
  int degree = 2;
  int refinements = 0;
  HeldBoundary held = HeldBoundary::support;
  /// The upper end of a solid is a plane of symmetry: its nodes stay in it. The sector is then half of a body.
  bool symmetric_end = false;
  /// end_low or end_high of a solid: its nodes stay in its plane, on which it slides. Absent: none.
  std::optional<geometry::Boundary> axial_support{};
  geometry::Boundary flank = geometry::Boundary::leading_flank;
  /// Outside radius of a ring whose hoop or flange goes beyond it, m (see geometry::ExtrudeOptions).
  double outside_radius = not_known;
  /// z (m) whose section the free outside of a helical ring keeps (geometry::ExtrudeOptions::straight): its polar
  /// angles count from there. Absent: it is twisted like the teeth.
  std::optional<double> straight_z{};
  std::set<SectorOutput> outputs{};
};

[[nodiscard]] SectorModel make_sector_model(const geometry::Mesh& mesh, const geometry::ToothProfile& profile,
                                            double support_radius, const Material& material,
                                            const SectorModelOptions& options);

}  // namespace annulus::fem
