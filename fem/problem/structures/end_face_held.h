#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fem/problem/ring_body.h"

namespace annulus::fem {

/// Cantilever: a toothless sleeve continues the rim below the teeth, its end face is held, the outside is free.
struct EndFaceHeld {
  double free_length = 0;       ///< m, sleeve between the held face and the teeth; 0: they stand on the held face
  double sleeve_thickness = 0;  ///< m, at the outside diameter
  std::optional<Hoop> hoop{};   ///< stiffens the free end

  [[nodiscard]] RingBody body(double outside_radius) const;
  [[nodiscard]] RingWords words() const;
  [[nodiscard]] std::vector<std::pair<std::string, double>> parameters() const;
  [[nodiscard]] RingDrawing drawing(double outside_radius) const;
};

}  // namespace annulus::fem
