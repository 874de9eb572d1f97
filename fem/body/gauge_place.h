#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/problem/material.h"
#include "fem/problem/strain_gauge.h"

namespace annulus::fem {

struct GearBody;

/// A gauge that a body is asked for, in the frame of the solve: its angle is counted from tooth 0 of the body.
struct WantedGauge {
  StrainGauge gauge;
  Material material{};      ///< of the body
  double mirror_width = 0;  ///< m, of the whole face of a body solved on the lower half of it; else 0
};

/// The strain of a gauge as weights of the observed loads of one sector, from the first one of GearBody::root_low on.
struct GaugePart {
  int sector = 0;
  Eigen::VectorXd weights;
};
/// Of the lines of `body` alone. Throws InputError where the body has no such place.
[[nodiscard]] std::vector<GaugePart> gauge_parts(const WantedGauge& wanted, const GearBody& body);

/// A gauge on a whole body.
struct GaugeProbe {
  std::vector<GaugePart> parts;
  Eigen::MatrixXd at_interfaces;  ///< strain under unit loads of interface j, the j-th column: m x teeth
};

}  // namespace annulus::fem
