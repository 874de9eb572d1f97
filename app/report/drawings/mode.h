#pragma once

#include <string>
#include <vector>

namespace annulus::app {

/// A mode shape of a planetary stage: bodies as circles, at rest in grey and displaced in colour.
struct ModeDrawing {
  /// Displacement of a centre and arc of the base circle; the largest of all in the shape is 1.
  struct Motion {
    double x = 0, y = 0, u = 0;
  };
  std::string title{};
  double sun_radius = 0, planet_radius = 0, ring_radius = 0, centre_distance = 0;  ///< m
  std::vector<double> planet_angles{};                                             ///< rad
  Motion sun{}, ring{}, carrier{};
  std::vector<Motion> planets{};  ///< x radial, y tangential
};

[[nodiscard]] std::string to_svg(const ModeDrawing& mode);

}  // namespace annulus::app
