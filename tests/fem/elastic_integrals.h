#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <Eigen/Core>
#include <cmath>
#include <utility>
#include <vector>

#include "fem/dealii/elastic_problem.h"

/// Integrals over the cells and faces of an elastic problem.
namespace annulus::tests {

/// A force density (a function of the point) over the body.
template <int dim, class Density>
Eigen::VectorXd body_load(const fem::ElasticProblem<dim>& problem, const Density& force_density) {
  const auto& element = problem.dof_handler().get_fe();
  const dealii::QGauss<dim> quadrature(element.degree + 3);
  dealii::FEValues<dim> values(problem.mapping(), element, quadrature,
                               dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(problem.dofs());
  std::vector<dealii::types::global_dof_index> indices(element.dofs_per_cell);
  for (const auto& cell : problem.dof_handler().active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(indices);
    for (unsigned int q = 0; q < quadrature.size(); ++q) {
      const auto f = force_density(values.quadrature_point(q));
      for (unsigned int i = 0; i < element.dofs_per_cell; ++i)
        load[static_cast<Eigen::Index>(indices[i])] +=
            f[element.system_to_component_index(i).first] * values.shape_value(i, q) * values.JxW(q);
    }
  }
  return load;
}

/// A traction (a function of the point and the outward normal) over one boundary.
template <int dim, class Traction>
Eigen::VectorXd surface_load(const fem::ElasticProblem<dim>& problem, geometry::Boundary boundary,
                             const Traction& traction) {
  const auto& element = problem.dof_handler().get_fe();
  const dealii::QGauss<dim - 1> quadrature(element.degree + 3);
  dealii::FEFaceValues<dim> values(problem.mapping(), element, quadrature,
                                   dealii::update_values | dealii::update_quadrature_points |
                                       dealii::update_normal_vectors | dealii::update_JxW_values);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(problem.dofs());
  std::vector<dealii::types::global_dof_index> indices(element.dofs_per_cell);
  for (const auto& cell : problem.dof_handler().active_cell_iterators())
    for (const auto face : cell->face_indices()) {
      if (!cell->face(face)->at_boundary() ||
          cell->face(face)->boundary_id() != static_cast<dealii::types::boundary_id>(boundary))
        continue;
      values.reinit(cell, face);
      cell->get_dof_indices(indices);
      for (unsigned int q = 0; q < quadrature.size(); ++q) {
        const auto t = traction(values.quadrature_point(q), values.normal_vector(q));
        for (unsigned int i = 0; i < element.dofs_per_cell; ++i)
          load[static_cast<Eigen::Index>(indices[i])] +=
              t[element.system_to_component_index(i).first] * values.shape_value(i, q) * values.JxW(q);
      }
    }
  return load;
}

/// L2 and energy (strain-energy seminorm: H1) errors against an exact solution and its gradient.
template <int dim, class Exact, class Gradient>
std::pair<double, double> solution_errors(const fem::ElasticProblem<dim>& problem, const Eigen::VectorXd& solution,
                                          const Exact& exact, const Gradient& exact_gradient) {
  const auto& element = problem.dof_handler().get_fe();
  const dealii::QGauss<dim> quadrature(element.degree + 3);
  dealii::FEValues<dim> values(
      problem.mapping(), element, quadrature,
      dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points | dealii::update_JxW_values);
  std::vector<dealii::types::global_dof_index> indices(element.dofs_per_cell);
  double l2 = 0, h1 = 0;
  for (const auto& cell : problem.dof_handler().active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(indices);
    for (unsigned int q = 0; q < quadrature.size(); ++q) {
      dealii::Tensor<1, dim> u;
      dealii::Tensor<2, dim> gradient;
      for (unsigned int i = 0; i < element.dofs_per_cell; ++i) {
        const double s = solution[static_cast<Eigen::Index>(indices[i])];
        const auto c = element.system_to_component_index(i).first;
        u[c] += s * values.shape_value(i, q);
        gradient[c] += s * values.shape_grad(i, q);
      }
      l2 += (u - exact(values.quadrature_point(q))).norm_square() * values.JxW(q);
      h1 += (gradient - exact_gradient(values.quadrature_point(q))).norm_square() * values.JxW(q);
    }
  }
  return {std::sqrt(l2), std::sqrt(h1)};
}

}  // namespace annulus::tests
