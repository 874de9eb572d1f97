#include "fem/elasticity/inertia_loads.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>

#include "core/errors.h"

namespace annulus::fem {
namespace {

/// Values of the scalar polynomials at the nodes, zero where the node is held: nodes x polynomials.
Eigen::MatrixXd polynomials(const SectorModel& model, const MotionOrder& order) {
  Eigen::Vector3d low = model.nodes.front(), high = low;
  for (const auto& p : model.nodes) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector3d middle = (low + high) / 2;
  Eigen::Vector3d half = (high - low) / 2;
  if (model.dimension == 2) half.z() = 1;
  const int axial = model.dimension == 3 ? order.axial : 0;
  const auto nodes = static_cast<Eigen::Index>(model.nodes.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(nodes, (axial + 1) * (order.section + 1) * (order.section + 2) / 2);
  for (Eigen::Index n = 0; n < nodes; ++n) {
    if (model.dof[n * model.dimension] < 0) continue;
    const Eigen::Vector3d x = (model.nodes[n] - middle).cwiseQuotient(half);
    Eigen::Index column = 0;
    for (int k = 0; k <= axial; ++k)
      for (int degree = 0; degree <= order.section; ++degree)
        for (int of_y = 0; of_y <= degree; ++of_y)
          result(n, column++) = boost::math::legendre_p(k, std::clamp(x.z(), -1.0, 1.0)) *
                                std::pow(x.x(), degree - of_y) * std::pow(x.y(), of_y);
  }
  return result;
}

}  // namespace

std::vector<NodalLoad> inertia_loads(const SectorModel& model, double width, const MotionOrder& order) {
  require(model.nodal_mass.rows() == static_cast<Eigen::Index>(model.nodes.size()), "a sector model of ",
          model.nodes.size(), " nodes has the mass of ", model.nodal_mass.rows());
  const Eigen::MatrixXd psi = polynomials(model, order);
  // Components do not couple and share one Gram matrix.
  Eigen::MatrixXd inertia = width * (model.nodal_mass * psi);
  const Eigen::LLT<Eigen::MatrixXd> gram(psi.transpose() * inertia);
  require(gram.info() == Eigen::Success, "the motions of a sector are not independent");
  inertia = gram.matrixU().solve<Eigen::OnTheRight>(inertia);
  std::vector<NodalLoad> loads;
  for (Eigen::Index k = 0; k < inertia.cols(); ++k)
    for (int c = 0; c < model.dimension; ++c) {
      NodalLoad load;
      for (Eigen::Index n = 0; n < inertia.rows(); ++n)
        if (model.dof[n * model.dimension] >= 0)
          load.push_back({static_cast<int>(n), inertia(n, k) * Eigen::Vector3d::Unit(c)});
      loads.push_back(std::move(load));
    }
  return loads;
}

}  // namespace annulus::fem
