#pragma once

#include <vector>

namespace annulus::dynamics {

/// A course of speed and torque in time, in factors of those for which a system was built; straight between its points,
/// constant before the first and behind the last one.
struct Course {
  struct Point {
    double time = 0;               ///< s, from 0 on, rising
    double speed = 1, torque = 1;  ///< speed > 0
  };
  std::vector<Point> points;
  /// Throws InputError naming the point that cannot be used.
  void check() const;
  /// s, the nominal time of each point: its rate over the time is the factor of the speed.
  [[nodiscard]] std::vector<double> nominal_times() const;
};

/// Which bodies bear the torque that turns the inertias faster.
enum class AcceleratedBy { drive, load };

}  // namespace annulus::dynamics
