#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/stiffness_table.h"
#include "fem/problem/loaded_mesh_problem.h"
#include "geometry/mesh.h"

namespace annulus::fem {

/// State of one pin (or spline tooth) at one position.
struct PinState {
  bool touching = false;        ///< always, when held both ways
  double radial_force = 0;      ///< N, positive presses the pin outwards
  double tangential_force = 0;  ///< N, counter-clockwise on the pin
};

/// Mean contact pressure over one piece of a flank.
struct PressurePatch {
  int pair = 0;                        ///< index into LoadedPosition::pair_share
  double z_low = 0, z_high = 0;        ///< m
  double roll_low = 0, roll_high = 0;  ///< m, roll lengths of the pinion
  double pressure = 0;                 ///< Pa
};

/// Largest stresses of one body at one position, Pa, on its free surfaces: tangential ones along the surface in the
/// cross-section, compression negative.
struct BodyStress {
  double root_tension = 0, root_compression = 0, root_von_mises = 0;  ///< in the fillets and root lands
  double rim_tension = 0, rim_compression = 0, rim_von_mises = 0;     ///< on the other side of the rim
};

inline constexpr double BodyStress::*stress_values[] = {&BodyStress::root_tension,    &BodyStress::root_compression,
                                                        &BodyStress::root_von_mises,  &BodyStress::rim_tension,
                                                        &BodyStress::rim_compression, &BodyStress::rim_von_mises};

struct RecoveredStress : BodyStress {
  /// How far the largest stresses of a plane body stand out from the mean of their neighbours along the line, Pa,
  /// positive: where cells change their shape, spikes of the elements shrink too slowly for two levels to tell.
  BodyStress roughness;
  BodyStress error;  ///< by discretisation, Pa, positive; NaN: not known
};

/// One position of the mesh under one load.
struct LoadedPosition {
  double mesh_phase = 0;  ///< [0, 1], 1 included once as the closure check
  int ring_tooth = 0;     ///< whole mesh cycles before this one
  double ring_angle = 0;  ///< rad, of the pitch point in the wheel's own frame
  double load = 0;        ///< N
  StiffnessEntry entry;
  /// Load share of the tooth pairs near enough to touch, in order of rising pinion roll length.
  std::vector<double> pair_share;
  std::vector<double> pair_roll;  ///< m, pinion roll length of each pair's theoretical contact point
  double max_pressure = 0;        ///< Pa
  bool tip_edge_contact = false;  ///< the peak pressure stands at a tip edge: singular, not to be compared
  std::vector<PinState> pins;
  std::vector<PinState> housing;  ///< patches of the housing bore, one behind every tooth; empty without
  /// Of a planet on rollers: forces of the equal patches around its bore, N, as many behind every tooth, those of tooth
  /// 0 first; and the angle of tooth 0 against the direction from the axis of the stage to the planet, rad, in the
  /// frame of the solve.
  std::vector<double> rollers;
  double pinion_angle = 0;
  /// Of a planet on rollers: m/N, by which a force of its other mesh deflects this mesh while the force of this one
  /// stays, less what a planet with a round rim would do. Part of the compliance behind the tangent stiffness, with
  /// which both forces change.
  double partner_compliance = 0;
  std::vector<double> line_load;        ///< N/m, of all pairs together, per slice of the face width from low to high z
  double face_load_factor = 1;          ///< K_H_beta [ISO6336-1]: largest over mean line load
  std::vector<PressurePatch> pressure;  ///< touching pieces, at the middle load of the table only
  std::optional<RecoveredStress> pinion_stress{}, wheel_stress{};  ///< none of resolved models
  /// Under the middle load: strains of each gauge turned by 0, 1, ... teeth in the frame of the solve.
  std::vector<Eigen::VectorXd> gauge_strains{};
  double force_balance_relative = 0;  ///< |sum of force x lever arm - torque| / torque
  /// |work - 2 x strain energy - work against the gaps| / the larger of work and energy
  double energy_balance_relative = 0;
  double reciprocity_relative = 0;  ///< asymmetry of the compliance between tooth pairs, formed both ways
  double max_penetration = 0;       ///< m
};

/// Surface stress along a line, for pictures.
struct StressCurve {
  enum class Along { root, rim };  ///< rim: of a ring its outside, of a planet on rollers its bore

  geometry::GearRole body = geometry::GearRole::pinion;
  Along along = Along::root;
  std::size_t position = 0;  ///< index into LoadedMeshResult::positions: where its largest von Mises stress occurs
  std::vector<double> abscissa{};  ///< root: arc length counter-clockwise through the tooth space, from form circle to
                                   ///< form circle, m; rim: polar angle in the wheel's own frame, rad
  std::vector<double> tangential{}, von_mises{};  ///< Pa
};

/// What a strain gauge shows while the mesh moves once around the wheel under its middle load.
struct GaugeHistory {
  std::string name;
  /// Pitch points of the mesh in the wheel's own frame (LoadedPosition::ring_angle), not reduced to a turn: one per
  /// phase of all mesh cycles.
  std::vector<double> angle;
  std::vector<double> strain;
};

/// Displacement and stress of a body under the contact forces of one position, in the frame of its tooth 0.
struct BodyField {
  geometry::GearRole body = geometry::GearRole::pinion;
  std::size_t position = 0;  ///< index into LoadedMeshResult::positions
  /// Sectors around the contact, each with vertices of its own, as many as make a file of some megabytes: of coarse
  /// plane bodies all. Of a symmetric face the lower half.
  geometry::Mesh mesh;
  int sectors = 1;
  std::vector<Eigen::Vector3d> displacement;  ///< m, per vertex; of the pinion relative to its hub
  /// Pa, per vertex: xx, yy, zz, xy, yz, zx; means of the adjacent cells, so that peaks at edges are cut.
  std::vector<std::array<double, 6>> stress;

  [[nodiscard]] double von_mises(std::size_t vertex) const;  ///< Pa
};

/// Both bodies as one level of resolution solved them, with their supports, and what was recovered in them.
struct SolvedBodies {
  geometry::Mesh pinion_sector{}, wheel_sector{};
  bool half_face = false;             ///< solved on half of the face width; all figures are those of the whole
  long unknowns = 0;                  ///< DOFs of the two sectors
  double pin_stiffness = 0;           ///< N/m per pin or spline flank as used; 0 without
  std::vector<double> pin_angles{};   ///< rad, from the centre of tooth 0; empty without pins
  std::vector<double> slice_edges{};  ///< m, z of the slices of the face width
  std::vector<StressCurve> stress_curves{};
  std::vector<GaugeHistory> gauges{};  ///< as in the problem
  std::vector<BodyField> fields{};     ///< of both bodies at one position after the other, as wanted (Recovery)
};

/// Time of a solve and its tooth superelements.
struct SolveCost {
  double mesh_seconds = 0, condense_seconds = 0, contact_seconds = 0;  ///< wall
  double processor_seconds = 0;               ///< of all threads of the process, over the whole solve
  int condensed_teeth = 0, reused_teeth = 0;  ///< made, and read from the store; none by resolved models

  SolveCost& operator+=(const SolveCost& other);
};

/// A loaded mesh; its cost is that of all levels, its bodies those of the last one.
struct LoadedMeshResult : SolvedBodies, SolveCost {
  LoadedMeshResult(StiffnessTable stiffness, std::vector<LoadedPosition> solved)
      : table(std::move(stiffness)), positions(std::move(solved)) {}

  StiffnessTable table;
  std::vector<LoadedPosition> positions;  ///< at every load, [ring tooth][phase][load], then the closure positions
  double closure_relative = 0;            ///< |LTE(phase 1) - LTE(phase 0)| / LTE over all loads
  double reciprocity_relative = 0;        ///< largest over the positions
  int level = 1;                          ///< level of resolution reached
  int degree = 2;                         ///< of the elements of that level
  /// Largest estimated error at the middle load, plane strain not counted: what the accuracy is about.
  double worst_error_relative = 0;
  /// Estimated errors by discretisation of the largest stresses over all positions at the middle load, Pa, positive.
  /// NaN where two levels did not have them.
  BodyStress pinion_stress_error{}, wheel_stress_error{};
  double face_load_factor_error = 0;  ///< of the largest one, estimated in the same way
};

/// The stiffness table of solved positions, with closure and reciprocity. `positions`: [cycle][phase][load] over all
/// cycles after which the structure repeats, then the closure positions, one per load.
[[nodiscard]] LoadedMeshResult tabulated(const LoadedMeshProblem& problem, std::vector<LoadedPosition> positions);

}  // namespace annulus::fem
