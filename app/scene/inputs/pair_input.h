#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/inputs/common_input.h"

namespace annulus::app {

enum class ErrorDivisor { printed, exact };
enum class ErrorAmount { sample, exact };

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

/// What the scene of a helical pair has besides stage, material, errors and dynamics.
struct PairInput {
  PairGearInput pinion, wheel;
  MeshInput pinion_wheel;
  std::optional<ManufacturingErrorInput> manufacturing_error;
  std::optional<TransmissionErrorInput> transmission_error;
};

}  // namespace annulus::app
