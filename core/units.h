#pragma once

#include <numbers>

/// Conversion factors to SI, for the file boundaries; inside annulus every quantity is SI (m, kg, s, N, Pa, rad).
namespace annulus::units {

inline constexpr double mm = 1e-3;
inline constexpr double um = 1e-6;
inline constexpr double GPa = 1e9;
inline constexpr double kW = 1e3;
inline constexpr double deg = std::numbers::pi / 180.0;
inline constexpr double arc_minute = deg / 60;
inline constexpr double arc_second = arc_minute / 60;
inline constexpr double hour = 3600.0;
inline constexpr double rpm = 2.0 * std::numbers::pi / 60.0;

}  // namespace annulus::units
