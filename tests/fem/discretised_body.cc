#include "discretised_body.h"

#include <memory>

#include "core/errors.h"
#include "fem/condensation/lapack.h"
#include "fem/dealii/elastic_problem.h"

namespace annulus::tests {
namespace {

template <int dim>
DiscretisedBody discretise_in(const geometry::Mesh& mesh, const Projection& project, const fem::Material& material,
                              int degree) {
  const auto exact = [project](geometry::Boundary boundary, const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const Eigen::Vector2d on_curve = project(boundary, p.head<2>());
    return {on_curve.x(), on_curve.y(), p.z()};
  };
  const auto problem = std::make_shared<fem::ElasticProblem<dim>>(mesh, exact, material, degree);
  DiscretisedBody body;
  body.dimension = dim;
  for (std::size_t n = 0; n < problem->node_points().size(); ++n) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (int c = 0; c < dim; ++c) {
      point[c] = problem->node_points()[n][c];
      body.dof.push_back(problem->node_dofs()[n][c]);
    }
    body.nodes.push_back(point);
  }
  body.stiffness = problem->stiffness();
  body.nodal_mass = problem->nodal_mass();
  body.boundary_nodes = [problem](geometry::Boundary boundary) { return problem->boundary_nodes(boundary); };
  return body;
}

}  // namespace

DiscretisedBody discretise_body(const geometry::Mesh& mesh, const Projection& project, const fem::Material& material,
                                int degree) {
  return mesh.dimension == 2 ? discretise_in<2>(mesh, project, material, degree)
                             : discretise_in<3>(mesh, project, material, degree);
}

FreeSystem::FreeSystem(const Eigen::SparseMatrix<double>& full, const std::vector<bool>& fixed)
    : row(fixed.size(), -1) {
  int rows = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) row[i] = rows++;
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < full.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(full, column); it; ++it)
      if (row[it.row()] >= 0 && row[column] >= 0) entries.emplace_back(row[it.row()], row[column], it.value());
  matrix.resize(rows, rows);
  matrix.setFromTriplets(entries.begin(), entries.end());
}

Eigen::MatrixXd FreeSystem::restrict_rows(const Eigen::MatrixXd& full) const {
  Eigen::MatrixXd result(matrix.rows(), full.cols());
  for (std::size_t i = 0; i < row.size(); ++i)
    if (row[i] >= 0) result.row(row[i]) = full.row(static_cast<Eigen::Index>(i));
  return result;
}

Eigen::MatrixXd FreeSystem::extend_rows(const Eigen::MatrixXd& free) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(row.size()), free.cols());
  for (std::size_t i = 0; i < row.size(); ++i)
    if (row[i] >= 0) result.row(static_cast<Eigen::Index>(i)) = free.row(row[i]);
  return result;
}

SparseCholesky::SparseCholesky(const Eigen::SparseMatrix<double>& matrix) {
  fem::lapack::use_one_thread();
  factor_.compute(matrix);
  require(factor_.info() == Eigen::Success, "a matrix that is not positive definite");
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& right_hand_sides) const {
  return factor_.solve(right_hand_sides);
}

}  // namespace annulus::tests
