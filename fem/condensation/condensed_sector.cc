#include "fem/condensation/condensed_sector.h"

#include <map>

#include "core/errors.h"
#include "fem/condensation/lapack.h"
#include "fem/condensation/sparse_schur.h"

namespace annulus::fem {

CondensedSector condense(const SectorModel& model, const std::vector<Port>& ports, bool floating) {
  const int dim = model.dimension;
  CondensedSector sector;
  sector.dimension = dim;
  sector.pitch_angle = model.pitch_angle;

  // Retained: the freedoms of both cuts first, then what only the ports touch.
  std::vector<int> retained;
  std::map<int, int> place;
  const auto keep = [&](int row) {
    if (row >= 0 && place.emplace(row, static_cast<int>(retained.size())).second) retained.push_back(row);
  };
  for (const auto* side : {&model.low_nodes, &model.high_nodes})
    for (const int node : *side)
      for (int c = 0; c < dim; ++c) keep(model.freedom[node * dim + c]);
  for (const int node : model.low_nodes) sector.cut_points.push_back(model.nodes[node]);
  const int cuts = static_cast<int>(retained.size());
  require(cuts == 2 * dim * static_cast<int>(model.low_nodes.size()), "the radial cuts have unequal freedoms");
  for (const auto& port : ports)
    for (int c = 0; c < dim; ++c)
      if (port.direction[c] != 0) keep(model.freedom[port.node * dim + c]);
  const int inner = static_cast<int>(retained.size()) - cuts;

  Eigen::MatrixXd loads =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(retained.size()), static_cast<Eigen::Index>(ports.size()));
  for (std::size_t p = 0; p < ports.size(); ++p)
    for (int c = 0; c < dim; ++c) {
      const int row = model.freedom[ports[p].node * dim + c];
      if (ports[p].direction[c] != 0 && row >= 0)
        loads(place.at(row), static_cast<Eigen::Index>(p)) = ports[p].direction[c];
    }

  // A floating sector can move rigidly: its complement is singular and needs the shift, of the size of its entries.
  const double shift = floating ? model.stiffness.diagonal().mean() : 0.0;
  const Eigen::MatrixXd s = schur_complement(model.stiffness, retained, shift);

  Eigen::MatrixXd factor = s.bottomRightCorner(inner, inner);
  if (!lapack::cholesky(factor)) throw SolverError("the condensed stiffness of a tooth is not positive definite");
  Eigen::MatrixXd to_cuts = s.bottomLeftCorner(inner, cuts);
  lapack::solve_lower(factor, to_cuts);
  Eigen::MatrixXd from_ports = loads.bottomRows(inner);
  lapack::solve_lower(factor, from_ports);
  sector.cut_stiffness = s.topLeftCorner(cuts, cuts) - lapack::gram(to_cuts);
  sector.cut_load = loads.topRows(cuts) - lapack::transpose_product(to_cuts, from_ports);
  sector.port_compliance = lapack::gram(from_ports);
  return sector;
}

}  // namespace annulus::fem
