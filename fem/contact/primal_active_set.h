#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/contact/complementarity.h"

namespace annulus::fem {

/// What is taken for zero: round-off of the largest elastic deflection and of the load, and of the rigid motions that
/// close wide gaps first.
class ContactTolerances {
 public:
  explicit ContactTolerances(const ComplementarityProblem& p)
      : problem_(p),
        gap_(1e-13 * p.compliance.diagonal().maxCoeff() * p.load.cwiseAbs().maxCoeff()),
        force_(1e-13 * p.load.cwiseAbs().maxCoeff()) {}

  void set_motion(const Eigen::VectorXd& rigid) { motion_ = 4e-15 * (problem_.rigid * rigid).cwiseAbs().maxCoeff(); }
  [[nodiscard]] double gap() const { return gap_ + motion_; }
  [[nodiscard]] double force(Eigen::Index contact) const {
    return force_ + motion_ / problem_.compliance(contact, contact);
  }

 private:
  const ComplementarityProblem& problem_;
  double gap_, force_, motion_ = 0;
};

/// Numbers of those that are active, rising.
[[nodiscard]] std::vector<int> indices_of(const std::vector<bool>& active);

/// The active set of a solution by the primal method for convex quadratic programmes [NocedalWright2006,
/// algorithm 16.3]: from forces in equilibrium to ever smaller complementary energy. One contact at a time, so slow,
/// but it always ends. Throws SolverError when no forces carry the load.
[[nodiscard]] std::vector<bool> primal_active_set(const ComplementarityProblem& problem);

}  // namespace annulus::fem
