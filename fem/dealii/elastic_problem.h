#pragma once

// Private to annulus_elements and its tests: the only header that shows deal.II.

#include <deal.II/base/point.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/tria.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <functional>
#include <vector>

#include "fem/elasticity/nodal_load.h"
#include "fem/elasticity/sector_model.h"
#include "fem/problem/material.h"
#include "geometry/mesh.h"

namespace annulus::fem {

/// Nearest point of the exact boundary curve in the cross-section at the point's z; identity where the boundary is
/// straight.
using BoundaryProjection = std::function<Eigen::Vector3d(geometry::Boundary, const Eigen::Vector3d&)>;

/// Small-strain isotropic elasticity (plane strain in 2D) on isoparametric Lagrange elements, any degree and dimension.
template <int dim>
class ElasticProblem {
 public:
  /// The mesh is refined `refinements` times with new points on the exact boundary.
  ElasticProblem(const geometry::Mesh& mesh, const BoundaryProjection& project, const Material& material, int degree,
                 int refinements = 0);

  /// Symmetric stiffness matrix over all DOFs, held or not (N/m; in 2D per metre of width: N/m^2).
  [[nodiscard]] Eigen::SparseMatrix<double> stiffness() const;
  /// Consistent mass of one displacement component over the nodes (kg; in 2D per metre of width: kg/m).
  [[nodiscard]] Eigen::SparseMatrix<double> nodal_mass() const;
  /// Stress at all nodes of a free surface made of some boundaries, the mean of the adjacent elements; ascending nodes.
  [[nodiscard]] std::vector<SurfaceStress> surface_stress(const std::vector<geometry::Boundary>& boundaries) const;
  /// The cells' vertices with the stress there.
  [[nodiscard]] VertexField vertex_field() const;
  [[nodiscard]] int dofs() const { return static_cast<int>(dofs_.n_dofs()); }
  /// DOFs of every node: [node][component]; nodes are numbered in order of their first DOF.
  [[nodiscard]] const std::vector<std::array<int, dim>>& node_dofs() const { return node_dofs_; }
  [[nodiscard]] const std::vector<dealii::Point<dim>>& node_points() const { return node_points_; }
  /// Nodes lying on a boundary, each once, ascending.
  [[nodiscard]] std::vector<int> boundary_nodes(geometry::Boundary boundary) const;
  [[nodiscard]] const dealii::Mapping<dim>& mapping() const { return mapping_; }
  [[nodiscard]] const dealii::DoFHandler<dim>& dof_handler() const { return dofs_; }

 private:
  Material material_;
  int degree_;
  dealii::Triangulation<dim> triangulation_;
  dealii::MappingQ<dim> mapping_;
  dealii::FESystem<dim> element_;
  dealii::DoFHandler<dim> dofs_;
  std::vector<std::array<int, dim>> node_dofs_;
  std::vector<dealii::Point<dim>> node_points_;
  std::vector<int> node_of_dof_;
};

extern template class ElasticProblem<2>;
extern template class ElasticProblem<3>;

}  // namespace annulus::fem
