#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/face_shape.h"
#include "dynamics/spatial/stage_bearing.h"

namespace annulus::dynamics {

/// A bearing about its working point, in a place on the axis of `body`. Its coordinates d are the
/// displacement (x, y, z; m) and the tilt (about x, y; rad) of `body` against `on` there, in the axes of the body:
/// radial, tangential and axial for planets, those of the carrier for others. It acts on the body with -(K d + f).
struct LinearBearing {
  using Stiffness = Eigen::Matrix<double, 5, 5>;
  using Vector = Eigen::Matrix<double, 5, 1>;
  std::string name;
  StageBody body, on;
  double place = 0;                         ///< m, z
  Stiffness stiffness = Stiffness::Zero();  ///< K, symmetric: N/m, N, N m/rad; 0 in rigid coordinates
  std::array<bool, 5> rigid{};              ///< these coordinates stay 0
  Vector preload = Vector::Zero();          ///< f: N, N m
  /// A part of f that stands still in the housing, in the axes of the carrier at time 0; of bearings there alone.
  Vector standing = Vector::Zero();
  /// The whole bearing, where it is nonlinear (SpaceSupports::laws).
  std::optional<StageBearing> law{};
  double law_axes = 0;  ///< rad, about z: the axes of the law from those of the body
  /// Its name among springs, in columns and in groups of modal energy: "planet1_upwind_row".
  [[nodiscard]] std::string element() const;
};

/// Whole bearings and springs on something elastic, which has 5 coordinates per place.
struct BearingsInSeries {
  struct Seated {
    StageBearing bearing;
    int first = 0;     ///< coordinate of its place
    double place = 0;  ///< m, z of the bearing from there
  };
  struct Spring {
    int coordinate = 0;
    double stiffness = 0;  ///< N/m
  };
  Motions motions = Motions::in_space;
  Eigen::MatrixXd below;  ///< stiffness of what they stand on: N/m, N, N m/rad
  Eigen::MatrixXd held;   ///< rows of coordinates in which the bearings do not give way
  std::vector<Seated> bearings{};
  std::vector<Spring> springs{};
};

/// Bearings that act on each other through what they stand on, as planets do through a carrier.
struct LinearCoupling {
  std::string name;                   ///< among springs
  std::vector<std::size_t> bearings;  ///< numbers in SpaceSupports::bearings; none is rigid
  /// Between the coordinates of different bearings, 5 each: N/m, N, N m/rad. The blocks of own coordinates are zero:
  /// bearings contain them.
  Eigen::MatrixXd stiffness;
  /// A body with one more coordinate at the end, and its own entry: its rotation as a displacement on its radius (m).
  /// The coupling is then its torsional support and acts on it with -(K d + turning_preload).
  std::optional<StageBody> turned{};
  double turning_preload = 0;  ///< N
  /// Of all coordinates together, where bearings are nonlinear: their whole laws on what they stand on. It resists the
  /// motions with the forces that `stiffness` and the bearings have for small motions.
  std::optional<BearingsInSeries> law{};
};

/// Force (N) in the middle of the face and moment (N m) on a body, in its axes.
struct SpaceLoad {
  StageBody body;
  Eigen::Matrix<double, 6, 1> load = Eigen::Matrix<double, 6, 1>::Zero();
};

/// Force (N) and moment (N m) on a body that stand still in the housing, as the carrier turns past it: in the axes of
/// the body, cosine x cos(angle) + sine x sin(angle) of the carrier's angle.
struct StandingLoad {
  StageBody body;
  Eigen::Matrix<double, 6, 1> cosine = Eigen::Matrix<double, 6, 1>::Zero(), sine = cosine;
};

/// Bearings and loads of bodies that move along the axis and tilt, for small motions.
struct SpaceSupports {
  /// With whole laws, K of the coordinates of nonlinear parts serves modes and dampers alone.
  BearingLaws laws = BearingLaws::tangents;
  std::vector<LinearBearing> bearings{};
  std::vector<LinearCoupling> couplings{};
  std::vector<SpaceLoad> loads{};
  std::vector<StandingLoad> standing_loads{};

  /// Whether forces change as the carrier turns past the housing.
  [[nodiscard]] bool depends_on_carrier_angle() const;
  /// Throws InputError with name and value of the quantity that cannot be used.
  void check_supports() const;
  /// The stiffness of bearings and between them, in the coordinates of a coupling.
  [[nodiscard]] Eigen::MatrixXd whole(const LinearCoupling& coupling) const;
  /// The one that has the bearing; null: none.
  [[nodiscard]] const LinearCoupling* coupling_of(std::size_t bearing) const;
  /// The one that is the torsional support of a body; null: none.
  [[nodiscard]] const LinearCoupling* coupling_that_turns(const StageBody& body) const;
};

/// A mesh along its face.
struct SpreadFace {
  double width = 0, middle = 0;  ///< m, of the common face; `middle`: its z
  /// m, of the driving flanks before deformation, at face_places(); empty: none.
  std::vector<double> gap{};
  std::shared_ptr<const FaceShape> shape{};  ///< of solid gears; null: the law of the mesh is spread evenly

  /// Throws InputError with the value that cannot be used. `name`: "sun meshes".
  void check(const std::string& name) const;
};

/// A standing force in the axes of the carrier a quarter turn later; nothing along the axis.
[[nodiscard]] LinearBearing::Vector quarter_turn_later(const LinearBearing::Vector& standing);

/// Places at which the load along a face is found, from -1 to 1 (end to end), those of Gauss, and their weights, which
/// add up to 1. A straight approach of flanks that carry all over gives exact forces and moments. Where the contact
/// ends between two places both differ from those of whole integrals, by less than 5e-4 in the test.
struct FacePlace {
  double z = 0, weight = 0;
};
[[nodiscard]] const std::vector<FacePlace>& face_places();

/// A stiffness at z = `place` (m) as it is at z = 0.
[[nodiscard]] LinearBearing::Stiffness moved_along_axis(const LinearBearing::Stiffness& stiffness, double place);
/// d at z = `place` from d at z = 0.
[[nodiscard]] LinearBearing::Stiffness to_place(double place);

}  // namespace annulus::dynamics
