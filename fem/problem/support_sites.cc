#include "fem/problem/support_sites.h"

#include <cmath>

namespace annulus::fem {

std::vector<double> equal_angles(int count, double first) {
  std::vector<double> angles;
  angles.reserve(count);
  for (int i = 0; i < count; ++i) angles.push_back(first + 2 * M_PI * i / count);
  return angles;
}

}  // namespace annulus::fem
