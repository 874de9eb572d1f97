#pragma once

namespace annulus::geometry {
class GearPair;
}

namespace annulus::dynamics {

/// Coefficient (N s m^(1/2)) of the oil that is squeezed out between two flanks along their common normal: with the
/// curvature 1/R of both in the pitch point and the common face width b,
///
///   F = 3 sqrt(2) pi eta b (R/h)^(3/2) h'
///
/// by Reynolds' equation for parallel rolls without a pressure below that of the surroundings [Hamrock2004, ch. 9].
/// One tooth pair. `viscosity`: Pa s. Throws InputError when it is not positive.
[[nodiscard]] double squeeze_coefficient(const geometry::GearPair& pair, double viscosity);
/// The same along the transverse line of action.
[[nodiscard]] double transverse_squeeze_coefficient(const geometry::GearPair& pair, double viscosity);

}  // namespace annulus::dynamics
