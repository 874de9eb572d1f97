#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/elastic_law.h"
#include "dynamics/spatial/linear_supports.h"

namespace annulus::dynamics {

/// A basis (columns) of the coordinates that rows (held x coordinates) leave free; without columns where they hold all.
[[nodiscard]] Eigen::MatrixXd free_coordinates(const Eigen::MatrixXd& held);

/// Elastic parts on something elastic, as bearings on pins: they give way together until the forces are equal. The
/// coordinates d are those of what is below. The parts have the deflections s, what is below has d - s.
class SeriesLaw final : public ElasticLaw {
 public:
  struct Part {
    Eigen::MatrixXd measures;  ///< its coordinates from s
    std::shared_ptr<const ElasticLaw> law;
  };
  /// `below`: stiffness, symmetric, positive semi-definite (N/m, N, N m/rad). `held`: rows (held x coordinates) of s
  /// that stay zero. Throws InputError where parts do not fit, or nothing resists a deflection s.
  SeriesLaw(Eigen::MatrixXd below, std::vector<Part> parts, const Eigen::MatrixXd& held);
  [[nodiscard]] int size() const override { return static_cast<int>(below_.rows()); }
  /// Newton's method with a search along each step. Throws SolverError where it finds no equilibrium of the parts.
  [[nodiscard]] State at(const Eigen::VectorXd& deflection) const override;
  [[nodiscard]] Eigen::MatrixXd in_contact() const override;

 private:
  /// Of all parts and what is below, over the free coordinates of s.
  struct Inner {
    double energy = 0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd tangent;
  };
  [[nodiscard]] Inner inner(const Eigen::VectorXd& free_deflection, const Eigen::VectorXd& deflection) const;

  Eigen::MatrixXd below_, free_;
  std::vector<Part> parts_;
  Eigen::MatrixXd first_guess_;  ///< free coordinates of s over d while everything touches
};

/// Throws what parts_of() and SeriesLaw throw.
[[nodiscard]] std::shared_ptr<const ElasticLaw> series_law(const BearingsInSeries& bearings);

}  // namespace annulus::dynamics
