#include "fem/condensation/condensed_sector.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>

#include "core/errors.h"
#include "fem/condensation/lapack.h"
#include "fem/condensation/sparse_schur.h"

namespace annulus::fem {
namespace {

/// Loads as columns over the DOFs that are not held.
Eigen::SparseMatrix<double> load_columns(const SectorModel& model, const SectorLoads& loads) {
  std::vector<Eigen::Triplet<double>> entries;
  int column = 0;
  for (const auto* group : {&loads.acting, &loads.observed})
    for (const auto& load : *group) {
      for (const auto& f : load)
        for (int c = 0; c < model.dimension; ++c) {
          const int row = model.dof[f.node * model.dimension + c];
          if (row >= 0 && f.force[c] != 0) entries.emplace_back(row, column, f.force[c]);
        }
      ++column;
    }
  Eigen::SparseMatrix<double> result(model.stiffness.rows(), column);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace

bool CondensedSector::axially_held() const {
  return std::any_of(interface_dofs.begin(), interface_dofs.end(), [this](int free) { return free < dimension; });
}

void CondensedSector::turn_columns(Eigen::MatrixXd& matrix, Eigen::Index first) const {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(pitch_angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const int free : interface_dofs) {
    matrix.middleCols(first, free) = (matrix.middleCols(first, free) * turn.topLeftCorner(free, free)).eval();
    first += free;
  }
}

CondensedSector condense(const SectorModel& model, const SectorLoads& loads, SectorSupport support) {
  const int dim = model.dimension;
  CondensedSector sector;
  sector.dimension = dim;
  sector.pitch_angle = model.pitch_angle;
  sector.ports = static_cast<int>(loads.ports.size());

  // Retained: the DOFs of both interfaces first, then what only the ports touch.
  std::vector<int> retained;
  std::map<int, int> place;
  const auto keep = [&](int row) {
    if (row >= 0 && place.emplace(row, static_cast<int>(retained.size())).second) retained.push_back(row);
  };
  for (const auto* side : {&model.low_nodes, &model.high_nodes})
    for (const int node : *side)
      for (int c = 0; c < dim; ++c) keep(model.dof[node * dim + c]);
  const int interfaces = static_cast<int>(retained.size());
  const auto free_components = [&](int node) {
    int count = 0;
    while (count < dim && model.dof[node * dim + count] >= 0) ++count;
    return count;
  };
  for (const int node : model.low_nodes) {
    sector.interface_points.push_back(model.nodes[node]);
    sector.interface_dofs.push_back(free_components(node));
  }
  bool matching = interfaces == 2 * std::accumulate(sector.interface_dofs.begin(), sector.interface_dofs.end(), 0);
  for (std::size_t i = 0; i < model.high_nodes.size(); ++i)
    matching &= sector.interface_dofs[i] >= 2 && free_components(model.high_nodes[i]) == sector.interface_dofs[i];
  require(matching, "the cyclic interfaces have unequal degrees of freedom");
  for (const auto& port : loads.ports)
    for (int c = 0; c < dim; ++c)
      if (port.direction[c] != 0) keep(model.dof[port.node * dim + c]);
  const int kept = static_cast<int>(retained.size()), inner = kept - interfaces;

  // A floating sector can move rigidly: its complement is singular and needs the shift, of the size of its entries.
  const double shift = support == SectorSupport::floating ? model.stiffness.diagonal().mean() : 0.0;
  const int acting = static_cast<int>(loads.acting.size());
  const SchurComplement s = schur_complement(model.stiffness, retained, shift, load_columns(model, loads), acting);

  const int ports = sector.ports, others = loads.columns() - ports;
  Eigen::MatrixXd on_retained = Eigen::MatrixXd::Zero(kept, loads.columns());
  for (int p = 0; p < ports; ++p)
    for (int c = 0; c < dim; ++c) {
      const int row = model.dof[loads.ports[p].node * dim + c];
      if (loads.ports[p].direction[c] != 0 && row >= 0) on_retained(place.at(row), p) = loads.ports[p].direction[c];
    }
  if (others > 0) on_retained.rightCols(others) = s.loads;

  Eigen::MatrixXd factor = s.matrix.bottomRightCorner(inner, inner);
  if (!lapack::cholesky(factor))
    throw SolverError(
        fmt::format("the stiffness of a tooth superelement ({} inner degrees of freedom) is not positive "
                    "definite",
                    inner));
  Eigen::MatrixXd to_interfaces = s.matrix.bottomLeftCorner(inner, interfaces);
  lapack::solve_lower(factor, to_interfaces);
  Eigen::MatrixXd from_loads = on_retained.bottomRows(inner);
  lapack::solve_lower(factor, from_loads);
  sector.interface_stiffness = s.matrix.topLeftCorner(interfaces, interfaces) - lapack::gram(to_interfaces);
  sector.interface_load = on_retained.topRows(interfaces) - lapack::transpose_product(to_interfaces, from_loads);
  sector.compliance =
      lapack::transpose_product(from_loads, Eigen::MatrixXd(from_loads.leftCols(loads.acting_columns())));
  if (others > 0) sector.compliance.bottomRightCorner(others, acting) += s.compliance;
  return sector;
}

CondensedSector combine_loads(CondensedSector sector, int first, const Eigen::MatrixXd& weights) {
  const auto old = weights.rows(), combined = weights.cols();
  require(first + old <= sector.compliance.cols(), "a combination of the loads ", first, " to ", first + old, " of ",
          sector.compliance.cols());
  const auto in_columns = [&](const Eigen::MatrixXd& matrix) {
    const auto after = matrix.cols() - first - old;
    Eigen::MatrixXd result(matrix.rows(), matrix.cols() - old + combined);
    result.leftCols(first) = matrix.leftCols(first);
    result.middleCols(first, combined) = lapack::product(matrix.middleCols(first, old), weights);
    result.rightCols(after) = matrix.rightCols(after);
    return result;
  };
  sector.interface_load = in_columns(sector.interface_load);
  const Eigen::MatrixXd transposed = in_columns(sector.compliance).transpose();
  sector.compliance = in_columns(transposed).transpose();
  return sector;
}

}  // namespace annulus::fem
