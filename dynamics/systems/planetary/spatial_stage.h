#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/elastic_law.h"
#include "dynamics/spatial/bearing_assembly.h"
#include "dynamics/spatial/coupled_faces.h"
#include "dynamics/spatial/mechanism.h"
#include "dynamics/systems/planetary/planetary_stage.h"

namespace annulus::dynamics {

/// What the housing gives way behind bearings that stand on it, in its frame.
struct HousingStructure {
  std::vector<std::size_t> bearings;  ///< numbers in SpatialStage::bearings
  /// Between the places of these bearings on the axis: x, y, z, about x, about y of the first one, then of the next
  /// ...; with `ring_bearing` one more, the rotation of its place about z.
  Eigen::MatrixXd stiffness;
  /// The torque of the ring enters the housing there: position in `bearings`. Absent: the housing does not turn.
  std::optional<std::size_t> ring_bearing{};
};

/// A kind of mesh along its face.
struct StageFace {
  enum class Flank { driving, back };
  /// The law at a mesh phase (mesh cycles, whole ones count the teeth of the ring).
  std::function<std::shared_ptr<const FaceLaw>(double mesh_cycles, Flank flank)> law;
  double middle = 0;               ///< m, z of the middle of the common face
  std::optional<double> backlash;  ///< m, j_bn, normal to the flanks; absent: back flanks never touch
  bool symmetric = true;           ///< about the middle of the face, without load
};

/// A planetary stage in space: that of the plane with the widths of its faces, the places of its bearings, and loads
/// that are no torques. SI.
///
/// Axes as in PlanetaryStage; the external torque on the sun is counter-clockwise. Meshes with the unit normal n of the
/// driving flank from the driving body into the driven one, c = cos(base helix angle), s = sin(base helix angle), sigma
/// = +1 for right-handed planets:
///
///   sun -> planet    n = c (cos a_s t + sin a_s r) + sigma s z
///   planet -> ring   n = c (-cos a_r t + sin a_r r) + sigma s z
///   delta(z) = n . [u_1 + phi_1 x rho_1(z) - u_2 - phi_2 x rho_2(z)] - c e
///
/// rho(z) ends in the working pitch point at z; e is the transmission error of the plane (sun_mesh_errors()). Back
/// flanks have cos a, and sigma s, of the other sign.
///
/// With `plane.ring_coupling` the driving flanks of the ring meshes act on each other through the ring (CoupledFaces);
/// its modes have no part in an equilibrium.
///
/// A body that `bearings` name is held by these; where none of them holds it radially, by the radial support of `plane`
/// in the middle of the face as well. Others have that support, and neither move along the axis nor tilt: planets
/// against their pin.
struct SpatialStage {
  PlanetaryStage plane;
  double base_helix_angle = 0;                                           ///< rad, signed: > 0 for right-handed planets
  double planet_working_radius_sun = 0, planet_working_radius_ring = 0;  ///< m, of the pitch points from planet axes
  StageFace sun_face, ring_face;
  /// Stiffness of the pins on the carrier and of its structure, at the planets' middles and in their frames: x, y, z,
  /// about x, about y of planet 0, then of planet 1 ... Bearings of planets then stand on the pins. Absent: pins are
  /// part of a rigid carrier.
  std::optional<Eigen::MatrixXd> pins{};
  std::vector<StageBearing> bearings;
  std::optional<HousingStructure> housing{};  ///< absent: it is rigid
  std::vector<StageLoad> loads;
  std::vector<StageWeight> weights;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< m/s^2, in the housing's frame

  [[nodiscard]] int planets() const { return plane.planets(); }
  [[nodiscard]] bool has_bearings(const StageBody& body) const;
  [[nodiscard]] bool has_radial_bearings(const StageBody& body) const;
  /// Whether mounts beside the axis hold the ring, instead of a support of its rotation alone.
  [[nodiscard]] bool ring_turns_in_mounts() const;
  /// Why bodies move along the axis and tilt; empty: nothing makes them, and these degrees of freedom are left out.
  [[nodiscard]] std::vector<std::string> reasons_for_space() const;
  /// Whether anything stands still in the housing that is not the same in all directions, so that the forces depend on
  /// the angle of the carrier.
  [[nodiscard]] bool depends_on_carrier_angle() const;
};

/// A stage as a mechanism in one position.
struct StageMechanism {
  Mechanism mechanism;
  struct Mesh {
    int driving = -1, back = -1;  ///< elements; -1: none
    int first = 0;                ///< coordinate of the driving element that is the first station of this mesh
    std::shared_ptr<const FaceLaw> law, back_law;
  };
  std::vector<Mesh> meshes{};  ///< sun meshes of planets 0 ... N-1, then ring meshes
  std::vector<int> shared{};   ///< per hold: bearings that hold the same, and share what it bears
  std::vector<MadeBearing> bearings{};
  std::shared_ptr<const CoupledFaces> coupling{};  ///< of the driving flanks of the ring meshes; null without
  int ring_support = -1;                           ///< element of its torsional support; -1: none that gives way
  int carrier_hold = -1;                           ///< of its rotation, which bears its torque
  int ring_hold = -1;  ///< of its rotation; -1: it has an elastic torsional support, or mounts beside the axis
};
/// At time t (s). Throws InputError where bearings, loads and bodies do not fit.
[[nodiscard]] StageMechanism assemble(const SpatialStage& stage, double t);
/// Number of a body in it; Mechanism::ground for the housing.
[[nodiscard]] int body_number(const SpatialStage& stage, const StageBody& body);
/// Axes of a frame (columns) at time t, in the carrier's.
[[nodiscard]] Eigen::Matrix3d frame_axes(const SpatialStage& stage, StageFrame frame, const StageBody& body, double t);

}  // namespace annulus::dynamics
