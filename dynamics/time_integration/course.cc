#include "dynamics/time_integration/course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"

namespace annulus::dynamics {

void Course::check() const {
  if (points.size() < 2) throw InputError(fmt::format("a course needs two points at least, not {}", points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& p = points[i];
    if (i == 0 ? p.time != 0 : !(p.time > points[i - 1].time))
      throw InputError(fmt::format("point {} of a course has the time {} s; times rise from 0", i + 1, p.time));
    if (!std::isfinite(p.speed) || !std::isfinite(p.torque))
      throw InputError(
          fmt::format("point {} of a course has {} of the speed and {} of the torque", i + 1, p.speed, p.torque));
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

Course Course::with_points_at(double speed) const {
  Course course;
  for (const auto& b : points) {
    if (!course.points.empty()) {
      const auto a = course.points.back();
      const double share = (speed - a.speed) / (b.speed - a.speed), time = a.time + share * (b.time - a.time);
      if ((a.speed - speed) * (b.speed - speed) < 0 && time > a.time && time < b.time)
        course.points.push_back({time, speed, a.torque + share * (b.torque - a.torque)});
    }
    course.points.push_back(b);
  }
  return course;
}

CourseCycles::CourseCycles(const Course& course, double slowest, double frequency)
    : frequency_(frequency), course_(course.with_points_at(slowest).with_points_at(-slowest)) {
  require(slowest > 0 && frequency > 0, fmt::format("cycles of {} Hz at {} of the speed at least", frequency, slowest));
  for (auto& point : course_.points) point.speed = std::max(std::abs(point.speed), slowest);
  for (const double nominal : course_.nominal_times()) cycles_.push_back(nominal * frequency);
}

double CourseCycles::time(double cycle) const {
  const auto &first = course_.points.front(), &last = course_.points.back();
  if (cycle <= 0) return cycle / (frequency_ * first.speed);
  if (cycle >= cycles_.back()) return last.time + (cycle - cycles_.back()) / (frequency_ * last.speed);
  const auto next = static_cast<std::size_t>(std::upper_bound(cycles_.begin(), cycles_.end(), cycle) - cycles_.begin());
  const auto &a = course_.points[next - 1], &b = course_.points[next];
  const double acceleration = (b.speed - a.speed) / (b.time - a.time),
               nominal = (cycle - cycles_[next - 1]) / frequency_;
  return a.time + 2 * nominal / (a.speed + std::sqrt(a.speed * a.speed + 2 * acceleration * nominal));
}

}  // namespace annulus::dynamics
