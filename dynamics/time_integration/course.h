#pragma once

#include <vector>

namespace annulus::dynamics {

/// A course of speed and torque in time, in factors of those for which a system was built; straight between its points,
/// constant before the first and behind the last one.
struct Course {
  struct Point {
    double time = 0;               ///< s, from 0 on, rising
    double speed = 1, torque = 1;  ///< speed 0: a standstill; below 0: backwards
  };
  std::vector<Point> points;
  /// Throws InputError naming the point that cannot be used.
  void check() const;
  /// s, the nominal time of each point: its rate over the time is the factor of the speed.
  [[nodiscard]] std::vector<double> nominal_times() const;
  /// The same course with a point wherever its speed passes this factor.
  [[nodiscard]] Course with_points_at(double speed) const;
};

/// Counts the mesh cycles of a course, forwards and backwards alike. Where the course is slower than `slowest`, a cycle
/// lasts as long as at that speed.
class CourseCycles {
 public:
  /// `slowest`: factor of the speed, > 0. `frequency`: Hz, mesh cycles at factor 1.
  CourseCycles(const Course& course, double slowest, double frequency);
  [[nodiscard]] double last() const { return cycles_.back(); }  ///< number at the last point of the course
  [[nodiscard]] double time(double cycle) const;                ///< s; before 0 and behind the end at the speed there

 private:
  double frequency_;
  Course course_;               // its speed is never below `slowest`
  std::vector<double> cycles_;  // of the points
};

/// Which bodies bear the torque that turns the inertias faster.
enum class AcceleratedBy { drive, load };

}  // namespace annulus::dynamics
