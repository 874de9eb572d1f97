#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/systems/planetary/response.h"

/// What strain gauges on the ring show as planets pass them. A curve is the strain at a gauge under the mean mesh force
/// of one planet, over its turns against the ring, from the place on where the table of the ring mesh begins.
namespace annulus::dynamics {

/// Strain over one turn of the carrier against the ring at `samples` equal steps from planet 1 at angle 0 on. Every
/// planet carries the mean mesh force, and strains the ring as if it were alone. `angles`: rad, of the planets;
/// `first`: rad, the angle of a planet at the beginning of the curve.
[[nodiscard]] std::vector<double> strain_over_turn(const PeriodicCurve& curve, const Eigen::VectorXd& angles,
                                                   double first, int samples);

/// Amplitudes over the mesh order, without the mean.
struct StrainLines {
  Eigen::VectorXd order;
  Eigen::MatrixXd amplitude;  ///< gauges x orders, in the unit of the curves
};
/// Every planet strains the ring in proportion to its force at that moment. Passing planets and their forces so make
/// sidebands about the multiples of the mesh frequency [McFaddenSmith1985]. Lines up to an order of 3.5, without those
/// below 1e-4 of the highest. Nothing without curves, and where motion and turn do not repeat together within 20 000
/// mesh cycles. `response`: with its series.
[[nodiscard]] std::optional<StrainLines> strain_lines(const PlanetaryStage& stage,
                                                      const std::vector<PeriodicCurve>& curves,
                                                      const DynamicResponse& response);

}  // namespace annulus::dynamics
