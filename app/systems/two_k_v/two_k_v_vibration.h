#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "dynamics/systems/two_k_v/two_k_v_modes.h"
#include "dynamics/systems/two_k_v/two_k_v_sensitivity.h"

/// Results of a 2K-V stage without time: modes over the crank angle, torsional stiffness, sensitivities.
namespace annulus::app {

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

struct TwoKVVibration {
  dynamics::Modes modes;           ///< mean mesh stiffness, at the crank angle of the scene
  std::vector<std::string> names;  ///< "body on group" per mode
  dynamics::ModalEnergy energy;
  dynamics::CrankModes over_crank;       ///< stiffness at each position
  dynamics::TorsionalStiffness torsion;  ///< likewise
  dynamics::OneDof estimate;
  dynamics::LostMotion lost;
  std::vector<double> targets;         ///< published first frequencies, Hz
  std::vector<FrequencyInput> inputs;  ///< largest sensitivity first

  [[nodiscard]] double first_frequency() const { return dynamics::first_frequency(modes); }  ///< Hz, above zero
};
/// `stage` with the curves of its tables at the nominal load. Throws SolverError when nothing can vibrate.
[[nodiscard]] TwoKVVibration vibration_of(const dynamics::TwoKVStage& stage, double arc_clearance,
                                          const std::vector<double>& targets);

/// modes.csv, modes_over_crank.csv, mode_shapes.csv, mode_shapes_over_crank.csv, torsional_stiffness.csv,
/// sensitivity_f1.csv in `folder`.
void write_vibration(const TwoKVVibration& vibration, const std::filesystem::path& folder);

}  // namespace annulus::app
