#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace annulus::app {

enum class ErrorDivisor { printed, exact };
enum class ErrorAmount { sample, exact };

/// Keys of [stage] that pairs alone have: N m, rad/s.
struct PairStageInput {
  double pinion_torque = 0, pinion_speed = 0;
};

/// Waves along the normal of the flanks, at mesh frequency and once per turn; misalignment over the face width.
struct PairErrorInput {
  std::optional<double> mesh_error;
  double mesh_error_phase = 0;
  double pinion_error = 0, pinion_error_phase = 0, wheel_error = 0, wheel_error_phase = 0;
  double pinion_wheel_misalignment = 0;
};

/// A gear of a helical pair; its bearings: `rigid` drops the DOF.
struct PairGearInput : HubGearInput {
  double bearing_transverse = rigid, bearing_axial = rigid;
  std::optional<double> damping_ratio;  ///< of its bearings; absent: that of [dynamics]
};

/// Composite deviations of both gears of a pair as random amplitudes (dynamics/manufacturing_error.h).
struct ManufacturingErrorInput {
  double pinion_total = 0, pinion_tooth_to_tooth = 0, wheel_total = 0, wheel_tooth_to_tooth = 0;
  int samples = 0, seed = 0;
  double probability = 0, confidence = 0;
  ErrorDivisor divisor = ErrorDivisor::printed;
  std::string reading;  ///< name of the one that becomes the error at mesh frequency; "none"
  ErrorAmount amount = ErrorAmount::sample;
};

/// Requests the causes of the transmission error of a pair, at these torques and speeds of the pinion.
struct TransmissionErrorInput {
  std::vector<double> pinion_torques, pinion_speeds;
};

/// What the scene of a helical pair has of its own.
struct PairInput {
  PairStageInput stage;
  PairGearInput pinion, wheel;
  MeshInput pinion_wheel;
  PairErrorInput errors;
  std::optional<ManufacturingErrorInput> manufacturing_error;
  std::optional<TransmissionErrorInput> transmission_error;
};

[[nodiscard]] inline PairInput& helical_pair(Scene& scene) { return scene.own<PairInput>(); }
[[nodiscard]] inline const PairInput& helical_pair(const Scene& scene) { return scene.own<PairInput>(); }

}  // namespace annulus::app
