#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "dynamics/systems/two_k_v/two_k_v_modes.h"
#include "dynamics/systems/two_k_v/two_k_v_sensitivity.h"

/// What a 2K-V stage answers without time: modes over the crank angle, torsional stiffness, sensitivities.
namespace annulus::app {

/// The reducer as one mass on one spring, seen from the output held still: the bodies turn as the train without
/// deformation, against the static torsional stiffness.
struct OneDof {
  double stiffness = 0;        ///< N m/rad
  double input_inertia = 0;    ///< kg m^2, input alone, times ratio^2
  double train_inertia = 0;    ///< kg m^2, all bodies but the output
  double input_frequency = 0;  ///< Hz, of the input alone
  double train_frequency = 0;  ///< Hz
};
[[nodiscard]] OneDof one_dof(const dynamics::TwoKVStage& stage);

/// Turn of the output with the input held, rad.
struct LostMotion {
  double backlash = 0;  ///< between the flanks, without torque
  double elastic = 0;   ///< between -3 % and +3 % of the torque, as robot reducers are tested
  double wind_up = 0;   ///< under the torque
  [[nodiscard]] double total() const { return backlash + elastic; }
};
/// `arc_clearance`: m, taken off the arc flanks along their normal.
[[nodiscard]] LostMotion lost_motion(const dynamics::TwoKVStage& stage, double stiffness, double arc_clearance);

/// One real input of the model and the first frequency.
struct FrequencyInput {
  std::string name;  ///< as dynamics::frequency_inputs
  std::string key;   ///< of the scene: "input.inertia_kg_m2"
  double value = 0;  ///< SI; of a mesh its mean tangent stiffness
  std::string unit;
  double sensitivity = 0;    ///< d ln f1/d ln p
  dynamics::InputBand band;  ///< factors between which f1 stays within `frequency_band` of its value
  /// Factors that bring f1 to each of the targets; absent where none does.
  std::vector<std::optional<double>> reaching;
};
inline constexpr double frequency_band = 0.05;

/// No mesh changes its stiffness: nothing but the directions of the eccentrics turns, and that excites nothing.
[[nodiscard]] bool constant_stiffness(const dynamics::TwoKVStage& stage);
/// Positions over one turn of the crank: eight per mesh cycle where the mesh stiffness changes.
[[nodiscard]] int crank_positions(const dynamics::TwoKVStage& stage);

struct TwoKVVibration {
  dynamics::Modes modes;           ///< mean mesh stiffness, at the crank angle of the scene
  std::vector<std::string> names;  ///< "body on group" per mode
  dynamics::ModalEnergy energy;
  dynamics::CrankModes over_crank;       ///< stiffness at each position; shapes go on without changes of sign
  dynamics::TorsionalStiffness torsion;  ///< likewise
  OneDof estimate;
  LostMotion lost;
  std::vector<double> targets;         ///< published first frequencies, Hz
  std::vector<FrequencyInput> inputs;  ///< largest sensitivity first
  double seconds_per_position = 0;     ///< wall time of all modes of one crank angle

  [[nodiscard]] double first_frequency() const;  ///< Hz, above zero
};
/// `stage` with the curves of its tables at the nominal load. Throws SolverError when nothing can vibrate.
[[nodiscard]] TwoKVVibration vibration_of(const dynamics::TwoKVStage& stage, double arc_clearance,
                                          const std::vector<double>& targets);

/// modes.csv, modes_over_crank.csv, mode_shapes.csv, mode_shapes_over_crank.csv, torsional_stiffness.csv,
/// sensitivity_f1.csv in `folder`.
void write_vibration(const TwoKVVibration& vibration, const std::filesystem::path& folder);

}  // namespace annulus::app
