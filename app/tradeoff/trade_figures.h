#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "app/scene/scene.h"
#include "app/stage/mesh_result.h"

namespace annulus::app {

/// A figure users decide by.
struct TradeFigure {
  const char* column;  ///< sun_planet_mean_stiffness_N_per_m
  const char* title;   ///< for people
  /// Whether the wanted accuracy of a scene covers it. It is one of the stiffness; a range of the transmission error is
  /// a small difference of large values and carries a bar of its own.
  bool promised = true;
  /// Covered only while the teeth stay in contact: where they part and meet again, the motion follows small changes of
  /// the stiffness by more than they are.
  bool while_teeth_touch = false;
  /// It stands for every entry of the table of that mesh.
  std::optional<std::size_t> entries_of{};
};
/// Those of the meshes, then those of the motion.
[[nodiscard]] const std::vector<TradeFigure>& trade_figures(StageKind kind);

/// Value and relative estimate of some of them in their order.
using Figures = std::vector<Estimate>;
inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
inline constexpr std::size_t traded_frequencies = 3;

}  // namespace annulus::app
