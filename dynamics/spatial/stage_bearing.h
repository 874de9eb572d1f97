#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/elastic_law.h"
#include "dynamics/spatial/rolling_rows.h"
#include "dynamics/spatial/stage_bodies.h"
#include "dynamics/system/support.h"

namespace annulus::dynamics {

/// A bearing between two bodies in a place on the axis of the first, or beside it: force and moment from the
/// displacement (x, y, z) and the tilt (about x, y) of `body` against `on` there. It has no torque about its own axis.
struct StageBearing {
  std::string name;
  StageBody body, on;
  double place = 0;                         ///< m, z
  Eigen::Vector2d beside{0, 0};             ///< m, x and y in its frame, of a mount beside the axis
  double x = 0, y = 0;                      ///< N/m; `rigid`: does not move
  double axial = 0;                         ///< N/m
  double tilt = 0;                          ///< N m/rad, about x and y
  double play = 0;                          ///< m, half the radial clearance; x and y are then equal and finite
  bool load_zone = true;                    ///< with play: RadialBearing; else a stop (StopLaw)
  double axial_play = 0;                    ///< m, half the axial clearance
  double tilt_play = 0;                     ///< rad, half the tilt clearance, of a finite tilt stiffness
  std::vector<double> distance{}, force{};  ///< m, N: radial, over each other, instead of x, y and play (TableLaw)
  std::optional<RollingRow> row{};          ///< instead of x, y, tilt and play, with a contact angle of axial too
  double seat = rigid;                      ///< N/m, in series with a bearing that has play and a load zone
  /// In which x and y point: that of what it stands on; planets and their pins have their own.
  [[nodiscard]] StageFrame frame() const;
  /// Whether it resists a turn of its body: it holds across the axis, beside it.
  [[nodiscard]] bool resists_turning() const { return beside.any() && holds_radially(); }
  [[nodiscard]] bool holds_radially() const { return matrix || row || !distance.empty() || x > 0 || y > 0; }
  std::optional<Eigen::Matrix<double, 5, 5>> matrix{};  ///< instead of the stiffnesses; SI
};

/// What of a bearing gives way, on some of x, y, z (0, 1, 2), about x and about y (3, 4).
struct BearingPart {
  std::vector<int> coordinates;
  std::shared_ptr<const ElasticLaw> law;
  bool nonlinear = false;                      ///< in its deflections
  std::shared_ptr<const RollingRowLaw> row{};  ///< the law, where it has rolling elements
};
/// All parts. Throws InputError for sizes that no bearing has.
[[nodiscard]] std::vector<BearingPart> parts_of(const StageBearing& bearing, Motions motions);
[[nodiscard]] bool is_nonlinear(const StageBearing& bearing);

/// A force and a moment on a body at a point (m, from the middle of the stage's axis, or a planet's).
struct StageLoad {
  std::string name;
  StageBody body;
  StageFrame frame = StageFrame::housing;
  Eigen::Vector3d point = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  /// Whether it keeps its direction in the housing, past which the carrier turns.
  [[nodiscard]] bool stands_in_housing() const;
};

/// Weight of a body in its centre of mass, which is on its axis.
struct StageWeight {
  StageBody body;
  double mass = 0;   ///< kg
  double place = 0;  ///< m, z
};

/// Does a displacement in the plane call for no axial force and no tilting moment? Five coordinates per body; rounding
/// counts as nothing.
[[nodiscard]] bool keeps_plane(const Eigen::MatrixXd& stiffness);
/// Adds why loads and weights, or bearings, move bodies along the axis or tilt them. `gravity`: m/s^2.
void add_reasons(std::vector<std::string>& reasons, const std::vector<StageLoad>& loads,
                 const std::vector<StageWeight>& weights, const Eigen::Vector3d& gravity);
void add_reasons(std::vector<std::string>& reasons, const std::vector<StageBearing>& bearings);

}  // namespace annulus::dynamics
