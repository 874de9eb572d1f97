#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/steady_state/steady_response.h"
#include "dynamics/time_integration/pacing.h"

/// Motions of a system whose speed and torque change: start, run-up, run-down, stop, overload, reversal.
namespace annulus::dynamics {

struct TransientOptions {
  Course course;
  AcceleratedBy accelerated_by = AcceleratedBy::drive;
  IntegratorOptions integrator{};
  int samples_per_cycle = 32;
  double steady_tolerance = 1e-3;  ///< of the motion from which the course starts
  int most_settling_cycles = 400;
  double highest_order = 6;                     ///< of the mesh frequency, in the spectra
  static constexpr double most_cycles = 50000;  ///< of a course: what its samples take of the memory
  /// Factor of the speed. Slower parts of a course and standstills are sampled as at this speed.
  static constexpr double slowest = 0.05;
};

/// What meshes do in every cycle of the fastest mesh; below TransientOptions::slowest in the time of one at that speed.
struct TransientResponse {
  std::vector<std::string> meshes;  ///< one row each: those of gears, then shafts
  int gears = 0;                    ///< rows that are meshes of gears
  /// N, per row, at the nominal torque: the mean of a period, of gears that differ in their number alone of all.
  Eigen::VectorXd nominal;
  Eigen::VectorXd time, speed, torque;      ///< in the middle of each cycle: s; factors
  Eigen::MatrixXd largest, smallest, mean;  ///< N, meshes x cycles
  Eigen::VectorXd open;                     ///< share of the time without contact, per mesh of gears
  Eigen::VectorXd open_error;               ///< of it, as changes lie anywhere between two samples
  /// By how much less the largest amount of a mesh is in the other half of the samples, relative.
  Eigen::VectorXd between_samples;
  int settling_cycles = 0;        ///< before the course
  std::optional<bool> settled{};  ///< the course begins from a steady motion; absent: its period is too long to show it
  /// Spectra of the gear mesh with the largest force over windows of `window_cycles`, each half over the one before.
  /// Where the speed comes below TransientOptions::slowest in a window, there are no orders, and its amplitudes are
  /// not_known.
  int spectrum_of = 0;
  static constexpr int window_cycles = 16;
  Eigen::VectorXd order, window_time, window_speed;  ///< of the mesh frequency; s; factor in the middle
  Eigen::MatrixXd amplitude;                         ///< N, orders x windows
  bool other_loads = false;                          ///< some follow neither torque nor speed: they keep their size
  bool without_sticking = false;                     ///< friction in a course that comes to a standstill, or near it
  IntegratorStatistics statistics{};

  struct Peak {
    int mesh = 0;
    double force = 0, time = 0, speed = 1;  ///< N, s, factor
  };
  /// The largest force of any mesh of gears, by amount.
  [[nodiscard]] Peak peak() const;
  /// Of a shaft (row), over the whole course.
  [[nodiscard]] double largest_of(int mesh) const;
};

/// Throws InputError for a course of too many mesh cycles, and what Pacing and integrate() throw.
[[nodiscard]] TransientResponse follow_course(const LumpedCase& of, const TransientOptions& options);

}  // namespace annulus::dynamics
