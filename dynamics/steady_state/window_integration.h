#pragma once

#include <optional>

#include "dynamics/steady_state/response_run.h"
#include "dynamics/steady_state/steady_response.h"

namespace annulus::dynamics {

/// Effort of the search for windows that repeat.
enum class Effort {
  until_out_of_reach,  ///< ends as soon as the decay of the differences shows that `max_windows` will not do
  all_windows          ///< goes on to `max_windows`
};

/// A run integrated window by window; the last two windows are stored.
class WindowIntegration {
 public:
  WindowIntegration(ResponseRun run, int cycles_per_window) : run_(std::move(run)), cycles_(cycles_per_window) {}

  /// Integrates over whole mesh cycles without a window.
  void skip(int cycles) { run_.advance(cycles, nullptr); }
  /// Integrates one window.
  void advance();
  /// Integrates windows until two successive ones agree to `options.steady_tolerance`. Returns whether they do.
  [[nodiscard]] bool reach_steady_state(const SimulationOptions& options, double force_scale, Effort effort);

  [[nodiscard]] const ResponseWindow& last() const { return last_; }
  /// Largest force difference of the last two windows / `force_scale` (N).
  [[nodiscard]] double difference_to_before(double force_scale) const;
  /// Relative energy that the last window lost; absent where that is no more than every integration loses.
  [[nodiscard]] std::optional<double> lost_energy(const SteadyProblem& problem, const IntegratorOptions& integrator);
  /// Puts the last window, its energies and (with `estimate_error`) its looser integration into the response. Call
  /// `lost_energy` before. The object is used up afterwards.
  void finish(const SimulationOptions& options, SteadyResponse& response);

 private:
  ResponseRun run_;
  std::optional<ResponseRun> at_begin_;  ///< of the last window
  SystemState begin_;
  EnergyBalance energy_;  ///< of the last window
  ResponseWindow before_, last_;
  int cycles_ = 0, windows_ = 0;
};

/// Largest difference of a mesh force between two windows / `force_scale` (N), over the times of the first.
[[nodiscard]] double largest_difference(const ResponseWindow& a, const ResponseWindow& b, double force_scale);

}  // namespace annulus::dynamics
