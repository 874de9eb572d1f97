#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/elastic_law.h"
#include "core/radial_bearing.h"

namespace annulus::dynamics {

/// F = K d.
class LinearLaw final : public ElasticLaw {
 public:
  /// `stiffness`: symmetric, positive semi-definite (N/m, N, N m/rad). Throws InputError with the least eigenvalue
  /// otherwise.
  explicit LinearLaw(Eigen::MatrixXd stiffness);
  [[nodiscard]] int size() const override { return static_cast<int>(stiffness_.rows()); }
  [[nodiscard]] State at(const Eigen::VectorXd& deflection) const override;
  [[nodiscard]] Eigen::MatrixXd in_contact() const override { return stiffness_; }

 private:
  Eigen::MatrixXd stiffness_;
};

/// Of the stiffness of a bearing or stop, left within its play, so that a body without load has a place.
inline constexpr double stiffness_in_play = 1e-7;

/// A stop around a centre in one or two directions: F = k (|d| - play) along d beyond the play, of either sign.
class StopLaw final : public ElasticLaw {
 public:
  /// `stiffness`: N/m. `play`: m, from the middle to the stop. Throws InputError unless the stiffness is positive and
  /// the play not negative.
  StopLaw(int directions, double stiffness, double play);
  [[nodiscard]] int size() const override { return directions_; }
  [[nodiscard]] State at(const Eigen::VectorXd& deflection) const override;
  [[nodiscard]] Eigen::MatrixXd in_contact() const override;

 private:
  int directions_;
  double stiffness_, play_;
};

/// Two radial directions of a measured or computed bearing: force over the distance of its rings, along it, in straight
/// pieces. Beyond the last point the last piece goes on.
class TableLaw final : public ElasticLaw {
 public:
  /// `distance`: m, rising, not negative. `force`: N, not falling, not negative; 0 at a distance of 0. Throws
  /// InputError with the first point that breaks this.
  TableLaw(std::vector<double> distance, std::vector<double> force);
  [[nodiscard]] int size() const override { return 2; }
  [[nodiscard]] State at(const Eigen::VectorXd& deflection) const override;
  [[nodiscard]] Eigen::MatrixXd in_contact() const override { return steepest_ * Eigen::Matrix2d::Identity(); }

 private:
  std::vector<double> distance_, force_;
  double steepest_ = 0;  ///< N/m
};

/// Two radial directions of a rolling bearing with a load zone.
class LoadZoneLaw final : public ElasticLaw {
 public:
  LoadZoneLaw(const RadialBearing& bearing, double stiffness) : bearing_(bearing), stiffness_(stiffness) {}
  [[nodiscard]] int size() const override { return 2; }
  [[nodiscard]] State at(const Eigen::VectorXd& deflection) const override;
  [[nodiscard]] Eigen::MatrixXd in_contact() const override { return stiffness_ * Eigen::Matrix2d::Identity(); }

 private:
  RadialBearing bearing_;
  double stiffness_;  ///< N/m, without play
};

}  // namespace annulus::dynamics
