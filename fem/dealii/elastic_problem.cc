#include "fem/dealii/elastic_problem.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/errors.h"

namespace annulus::fem {
namespace {

/// New points of a refined or curved boundary: the mean of the surrounding points moved onto the exact curve.
template <int dim>
class ExactBoundary : public dealii::Manifold<dim> {
 public:
  ExactBoundary(geometry::Boundary boundary, BoundaryProjection project)
      : boundary_(boundary), project_(std::move(project)) {}

  std::unique_ptr<dealii::Manifold<dim>> clone() const override {
    return std::make_unique<ExactBoundary<dim>>(boundary_, project_);
  }

  dealii::Point<dim> get_new_point(const dealii::ArrayView<const dealii::Point<dim>>& points,
                                   const dealii::ArrayView<const double>& weights) const override {
    dealii::Point<dim> mean;
    for (std::size_t i = 0; i < points.size(); ++i) mean += weights[i] * points[i];
    const Eigen::Vector3d exact = project_(boundary_, {mean[0], mean[1], dim == 3 ? mean[dim - 1] : 0});
    mean[0] = exact.x();
    mean[1] = exact.y();
    return mean;
  }

 private:
  geometry::Boundary boundary_;
  BoundaryProjection project_;
};

bool is_curved(geometry::Boundary boundary) {
  using geometry::Boundary;
  switch (boundary) {
    case Boundary::support:
    case Boundary::tip:
    case Boundary::leading_flank:
    case Boundary::trailing_flank:
    case Boundary::leading_fillet:
    case Boundary::trailing_fillet:
    case Boundary::root:
    case Boundary::outside:
      return true;
    default:
      return false;
  }
}

template <int dim>
void build_triangulation(const geometry::Mesh& mesh, const BoundaryProjection& project,
                         dealii::Triangulation<dim>& triangulation) {
  require(mesh.dimension == dim, "a mesh of dimension ", mesh.dimension, " where ", dim, " is computed");
  std::vector<dealii::Point<dim>> vertices(mesh.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
    for (int c = 0; c < dim; ++c) vertices[i][c] = mesh.vertices[i][c];

  constexpr int corners = dealii::GeometryInfo<dim>::vertices_per_cell;
  // Counter-clockwise to lexicographic numbering.
  constexpr std::array<int, 8> order = {0, 1, 3, 2, 4, 5, 7, 6};
  std::vector<dealii::CellData<dim>> cells(mesh.cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (int v = 0; v < corners; ++v) cells[i].vertices[v] = mesh.cells[i][order[v]];

  dealii::SubCellData boundary;
  for (const auto& face : mesh.faces) {
    if constexpr (dim == 2) {
      dealii::CellData<1> line;
      line.vertices[0] = face.vertices[0];
      line.vertices[1] = face.vertices[1];
      line.boundary_id = static_cast<dealii::types::boundary_id>(face.boundary);
      boundary.boundary_lines.push_back(line);
    } else {
      dealii::CellData<2> quad;
      for (int v = 0; v < 4; ++v) quad.vertices[v] = face.vertices[order[v]];
      quad.boundary_id = static_cast<dealii::types::boundary_id>(face.boundary);
      boundary.boundary_quads.push_back(quad);
    }
  }
  dealii::GridTools::consistently_order_cells(cells);
  triangulation.create_triangulation(vertices, cells, boundary);

  if (!project) return;
  for (const auto id : triangulation.get_boundary_ids()) {
    const auto tag = static_cast<geometry::Boundary>(id);
    if (is_curved(tag)) triangulation.set_manifold(id, ExactBoundary<dim>(tag, project));
  }
  // With the edges of every face: an edge shared with an end face carries the boundary id of either, so that
  // Triangulation::set_all_manifold_ids_on_boundary would leave it straight.
  for (const auto& cell : triangulation.active_cell_iterators())
    for (const auto face : cell->face_indices())
      if (cell->face(face)->at_boundary() &&
          is_curved(static_cast<geometry::Boundary>(cell->face(face)->boundary_id())))
        cell->face(face)->set_all_manifold_ids(cell->face(face)->boundary_id());
}

}  // namespace

template <int dim>
ElasticProblem<dim>::ElasticProblem(const geometry::Mesh& mesh, const BoundaryProjection& project,
                                    const Material& material, int degree, int refinements)
    : material_(material),
      degree_(degree),
      mapping_(degree),
      element_(dealii::FE_Q<dim>(degree), dim),
      dofs_(triangulation_) {
  build_triangulation(mesh, project, triangulation_);
  triangulation_.refine_global(refinements);
  dofs_.distribute_dofs(element_);

  std::vector<dealii::Point<dim>> points(dofs_.n_dofs());
  dealii::DoFTools::map_dofs_to_support_points(mapping_, dofs_, points);
  std::vector<int> component(dofs_.n_dofs(), -1), node_key(dofs_.n_dofs(), -1);
  std::vector<dealii::types::global_dof_index> indices(element_.dofs_per_cell);
  // Lagrange DOFs of one node share the base index on every cell that sees the node.
  std::vector<std::vector<int>> base_to_system(element_.dofs_per_cell / dim, std::vector<int>(dim));
  for (unsigned int i = 0; i < element_.dofs_per_cell; ++i) {
    const auto [c, base] = element_.system_to_component_index(i);
    base_to_system[base][c] = static_cast<int>(i);
  }
  node_of_dof_.assign(dofs_.n_dofs(), -1);
  for (const auto& cell : dofs_.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    for (const auto& system : base_to_system) {
      if (node_of_dof_[indices[system[0]]] >= 0) continue;
      std::array<int, dim> dofs{};
      for (int c = 0; c < dim; ++c) {
        dofs[c] = static_cast<int>(indices[system[c]]);
        node_of_dof_[dofs[c]] = static_cast<int>(node_dofs_.size());
      }
      node_dofs_.push_back(dofs);
      node_points_.push_back(points[dofs[0]]);
    }
  }
}

template <int dim>
Eigen::SparseMatrix<double> ElasticProblem<dim>::stiffness() const {
  const double E = material_.youngs_modulus, nu = material_.poisson_ratio;
  const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
  const dealii::QGauss<dim> quadrature(degree_ + 1);
  dealii::FEValues<dim> values(mapping_, element_, quadrature, dealii::update_gradients | dealii::update_JxW_values);
  const unsigned int n = element_.dofs_per_cell, nodes = n / dim;
  std::vector<unsigned int> component(n), base(n), scalar_of_base(nodes);
  for (unsigned int i = 0; i < n; ++i) {
    std::tie(component[i], base[i]) = element_.system_to_component_index(i);
    if (component[i] == 0) scalar_of_base[base[i]] = i;
  }
  // Integrals of all products of scalar gradients give every component block; that is dim^2 times less work than
  // integrating vector-valued shape functions.
  Eigen::MatrixXd gradients(nodes * dim, quadrature.size()), weighted(nodes * dim, quadrature.size());
  Eigen::MatrixXd products(nodes * dim, nodes * dim);
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(static_cast<std::size_t>(triangulation_.n_active_cells()) * n * n);
  std::vector<dealii::types::global_dof_index> indices(n);
  for (const auto& cell : dofs_.active_cell_iterators()) {
    values.reinit(cell);
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      for (unsigned int a = 0; a < nodes; ++a)
        for (int c = 0; c < dim; ++c) {
          const double g = values.shape_grad(scalar_of_base[a], q)[c];
          gradients(a * dim + c, q) = g;
          weighted(a * dim + c, q) = g * values.JxW(q);
        }
    products.noalias() = gradients * weighted.transpose();
    cell->get_dof_indices(indices);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j) {
        const unsigned int ci = component[i], cj = component[j];
        const unsigned int a = base[i] * dim, b = base[j] * dim;
        double k = lambda * products(a + ci, b + cj) + mu * products(a + cj, b + ci);
        if (ci == cj)
          for (int c = 0; c < dim; ++c) k += mu * products(a + c, b + c);
        triplets.emplace_back(static_cast<int>(indices[i]), static_cast<int>(indices[j]), k);
      }
  }
  Eigen::SparseMatrix<double> matrix(dofs(), dofs());
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

template <int dim>
Eigen::SparseMatrix<double> ElasticProblem<dim>::nodal_mass() const {
  const dealii::QGauss<dim> quadrature(degree_ + 1);
  dealii::FEValues<dim> values(mapping_, element_, quadrature, dealii::update_values | dealii::update_JxW_values);
  const unsigned int nodes = element_.dofs_per_cell / dim;
  std::vector<unsigned int> first;  // DOFs of the first component, one per node
  for (unsigned int i = 0; i < element_.dofs_per_cell; ++i)
    if (element_.system_to_component_index(i).first == 0) first.push_back(i);
  Eigen::MatrixXd shape(nodes, quadrature.size()), weighted(nodes, quadrature.size());
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(static_cast<std::size_t>(triangulation_.n_active_cells()) * nodes * nodes);
  std::vector<dealii::types::global_dof_index> indices(element_.dofs_per_cell);
  for (const auto& cell : dofs_.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(indices);
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      for (unsigned int a = 0; a < nodes; ++a) {
        shape(a, q) = values.shape_value(first[a], q);
        weighted(a, q) = material_.density * values.JxW(q) * shape(a, q);
      }
    const Eigen::MatrixXd products = shape * weighted.transpose();
    for (unsigned int a = 0; a < nodes; ++a)
      for (unsigned int b = 0; b < nodes; ++b)
        triplets.emplace_back(node_of_dof_[indices[first[a]]], node_of_dof_[indices[first[b]]], products(a, b));
  }
  const auto size = static_cast<Eigen::Index>(node_points_.size());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

template <int dim>
std::vector<SurfaceStress> ElasticProblem<dim>::surface_stress(
    const std::vector<geometry::Boundary>& boundaries) const {
  const double E = material_.youngs_modulus, nu = material_.poisson_ratio;
  const double plane_stress = E / (1 - nu * nu), shear_modulus = E / (2 * (1 + nu));
  // Evaluated at the nodes of each face.
  const dealii::Quadrature<dim - 1> at_nodes(dealii::FE_Q<dim - 1>(degree_).get_unit_support_points());
  dealii::FEFaceValues<dim> values(mapping_, element_, at_nodes,
                                   dealii::update_values | dealii::update_gradients | dealii::update_normal_vectors);
  /// Forces on the surrounding nodes for tangential, axial and shear stress, summed over the adjacent elements.
  struct Sum {
    int elements = 0;
    std::array<std::map<int, Eigen::Vector3d>, 3> forces;
  };
  std::map<int, Sum> sums;
  std::vector<dealii::types::global_dof_index> indices(element_.dofs_per_cell);
  for (const auto& cell : dofs_.active_cell_iterators())
    for (const auto face : cell->face_indices()) {
      const auto on = static_cast<geometry::Boundary>(cell->face(face)->boundary_id());
      if (!cell->face(face)->at_boundary() || std::find(boundaries.begin(), boundaries.end(), on) == boundaries.end())
        continue;
      values.reinit(cell, face);
      cell->get_dof_indices(indices);
      for (unsigned int q = 0; q < at_nodes.size(); ++q) {
        const auto normal = values.normal_vector(q);
        const Eigen::Vector3d along = Eigen::Vector3d(-normal[1], normal[0], 0).normalized();
        std::array<std::map<int, Eigen::Vector3d>, 3> here;
        int node = -1;
        for (unsigned int i = 0; i < element_.dofs_per_cell; ++i) {
          if (element_.system_to_component_index(i).first != 0) continue;
          const int other = node_of_dof_[indices[i]];
          if (values.shape_value(i, q) > 0.9) node = other;  // of all nodes one has 1, the others 0
          const auto gradient = values.shape_grad(i, q);
          const double d_along = gradient[0] * along.x() + gradient[1] * along.y();
          double d_axial = 0;
          if constexpr (dim == 3) d_axial = gradient[2];
          if (d_along == 0 && d_axial == 0) continue;
          const Eigen::Vector3d eps_t = d_along * along, eps_z(0, 0, d_axial);
          const Eigen::Vector3d gamma = d_axial * along + Eigen::Vector3d(0, 0, d_along);
          here[0][other] = plane_stress * (eps_t + nu * eps_z);
          here[1][other] = plane_stress * (eps_z + nu * eps_t);
          here[2][other] = shear_modulus * gamma;
        }
        auto& sum = sums[node];
        sum.elements += 1;
        for (int k = 0; k < 3; ++k)
          for (const auto& [other, force] : here[k])
            sum.forces[k].try_emplace(other, Eigen::Vector3d::Zero()).first->second += force;
      }
    }
  std::vector<SurfaceStress> result;
  for (const auto& [node, sum] : sums) {
    SurfaceStress stress;
    stress.node = node;
    NodalLoad* loads[3] = {&stress.tangential, &stress.axial, &stress.shear};
    for (int k = 0; k < (dim == 3 ? 3 : 1); ++k)
      for (const auto& [other, force] : sum.forces[k]) loads[k]->push_back({other, force / sum.elements});
    result.push_back(std::move(stress));
  }
  return result;
}

template <int dim>
VertexField ElasticProblem<dim>::vertex_field() const {
  const double E = material_.youngs_modulus, nu = material_.poisson_ratio;
  const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
  constexpr int corners = dealii::GeometryInfo<dim>::vertices_per_cell, stresses = dim == 3 ? 6 : 4;
  // Lexicographic to counter-clockwise numbering.
  constexpr std::array<int, 8> order = {0, 1, 3, 2, 4, 5, 7, 6};
  const dealii::QTrapezoid<dim> at_vertices;
  dealii::FEValues<dim> values(mapping_, element_, at_vertices, dealii::update_gradients);

  VertexField field;
  std::map<int, std::uint32_t> vertex_of_node;
  std::vector<int> cells_at;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<dealii::types::global_dof_index> indices(element_.dofs_per_cell);
  for (const auto& cell : dofs_.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(indices);
    auto& corners_of_cell = field.cells.emplace_back();
    corners_of_cell.fill(0);
    for (int v = 0; v < corners; ++v) {
      const int node = node_of_dof_[cell->vertex_dof_index(v, 0)];
      const auto [found, fresh] = vertex_of_node.try_emplace(node, static_cast<std::uint32_t>(field.nodes.size()));
      if (fresh) {
        field.nodes.push_back(node);
        cells_at.push_back(0);
      }
      const std::uint32_t vertex = found->second;
      ++cells_at[vertex];
      corners_of_cell[order[v]] = vertex;
      const int row = static_cast<int>(vertex) * stresses;
      for (unsigned int i = 0; i < element_.dofs_per_cell; ++i) {
        if (element_.system_to_component_index(i).first != 0) continue;
        const int column = node_of_dof_[indices[i]] * dim;
        const auto g = values.shape_grad(i, v);
        for (int c = 0; c < dim; ++c) {
          if (g[c] == 0) continue;
          for (int normal = 0; normal < 3; ++normal)
            entries.emplace_back(row + normal, column + c, (lambda + (normal == c ? 2 * mu : 0)) * g[c]);
        }
        // xy, yz, zx
        constexpr int shear[3][2] = {{0, 1}, {1, 2}, {2, 0}};
        for (int k = 0; k < stresses - 3; ++k) {
          const auto [a, b] = shear[k];
          entries.emplace_back(row + 3 + k, column + a, mu * g[b]);
          entries.emplace_back(row + 3 + k, column + b, mu * g[a]);
        }
      }
    }
  }
  const auto rows = static_cast<Eigen::Index>(field.nodes.size()) * stresses;
  for (auto& e : entries) e = {e.row(), e.col(), e.value() / cells_at[e.row() / stresses]};
  field.stress.resize(rows, static_cast<Eigen::Index>(node_points_.size()) * dim);
  field.stress.setFromTriplets(entries.begin(), entries.end());
  return field;
}

template <int dim>
std::vector<int> ElasticProblem<dim>::boundary_nodes(geometry::Boundary boundary) const {
  std::vector<bool> on(node_dofs_.size(), false);
  std::vector<dealii::types::global_dof_index> indices(element_.dofs_per_face);
  for (const auto& cell : dofs_.active_cell_iterators())
    for (const auto face : cell->face_indices())
      if (cell->face(face)->at_boundary() &&
          cell->face(face)->boundary_id() == static_cast<dealii::types::boundary_id>(boundary)) {
        cell->face(face)->get_dof_indices(indices);
        for (const auto i : indices) on[node_of_dof_[i]] = true;
      }
  std::vector<int> nodes;
  for (std::size_t i = 0; i < on.size(); ++i)
    if (on[i]) nodes.push_back(static_cast<int>(i));
  return nodes;
}

template class ElasticProblem<2>;
template class ElasticProblem<3>;

}  // namespace annulus::fem
