#pragma once

namespace annulus {

/// A result with its estimated absolute numerical error, both in the unit of the result.
struct Figure {
  double value = 0;
  double error = 0;
};

}  // namespace annulus
