#include "dynamics/time_integration/course.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"

namespace annulus::dynamics {

void Course::check() const {
  if (points.size() < 2) throw InputError(fmt::format("a course needs two points at least, not {}", points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& p = points[i];
    if (i == 0 ? p.time != 0 : !(p.time > points[i - 1].time))
      throw InputError(fmt::format("point {} of a course has the time {} s; times rise from 0", i + 1, p.time));
    if (!(p.speed > 0) || !std::isfinite(p.speed) || !std::isfinite(p.torque))
      throw InputError(
          fmt::format("point {} of a course has {} of the speed and {} of the torque; the speed has to "
                      "stay above 0",
                      i + 1, p.speed, p.torque));
  }
}

std::vector<double> Course::nominal_times() const {
  std::vector<double> list{0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto &a = points[i - 1], &b = points[i];
    list.push_back(list.back() + (a.speed + b.speed) / 2 * (b.time - a.time));
  }
  return list;
}

}  // namespace annulus::dynamics
