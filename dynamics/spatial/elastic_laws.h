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

/// A row of cylindrical rollers.
struct RollerRow {
  int rollers = 0;
  double length = 0, diameter = 0;  ///< m, effective, of the rollers
  bool operator==(const RollerRow&) const = default;
};

/// A row of cylindrical rollers in Hertz contact after [ISO16281]: every roller in slices along its length, whose force
/// is c_s delta^(10/9) with c_s = 35948 N/mm^(10/9) (L_we / mm)^(8/9) over the number of slices, of steel. delta is the
/// approach of the raceways at the slice less half the radial clearance (negative: preload) and the roller's
/// logarithmic profile. The first roller stands on the x axis.
class RollerRowLaw final : public ElasticLaw {
 public:
  /// Coordinates: displacement along x and y, and where `tilts`, tilt about x and y. Throws InputError for sizes that
  /// are not positive and fewer than three rollers.
  RollerRowLaw(const RollerRow& row, double clearance, bool tilts);
  [[nodiscard]] int size() const override { return tilts_ ? 4 : 2; }
  [[nodiscard]] State at(const Eigen::VectorXd& deflection) const override;
  [[nodiscard]] Eigen::MatrixXd in_contact() const override { return in_contact_; }
  /// N, of the most loaded roller.
  [[nodiscard]] double largest_roller_load(const Eigen::VectorXd& deflection) const;

 private:
  RollerRow row_;
  double stiffness_ = 0;  ///< c_s, N/m^(10/9)
  bool tilts_;
  Eigen::MatrixXd measures_;  ///< slices x coordinates: approach of the raceways; roller after roller
  Eigen::VectorXd gaps_;      ///< m, per slice
  Eigen::MatrixXd in_contact_;
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
