#pragma once

#include <filesystem>
#include <optional>

#include "app/scene/scene.h"
#include "dynamics/systems/helical_pair/manufacturing_error.h"

namespace annulus::app {

/// The random law a scene with [manufacturing_error] asks for.
[[nodiscard]] dynamics::ErrorProblem error_problem(const Scene& scene);

/// What [manufacturing_error] states, and the error at mesh frequency that follows.
struct PairErrors {
  std::optional<dynamics::ErrorProblem> problem{};  ///< absent: the scene has no such table
  std::optional<dynamics::ErrorResult> law{};
  double amplitude = 0;  ///< m, at mesh frequency
  /// nullptr when the scene gives the amplitude itself, or there is none.
  [[nodiscard]] const dynamics::ErrorReading* taken(const Scene& scene) const;
};
/// Draws the errors; the last law is remembered, because studies ask for the same one again and again.
[[nodiscard]] PairErrors pair_errors(const Scene& scene);

/// Draws stored in samples.csv at most; the figures are those of all of them.
inline constexpr int stored_samples = 100'000;
/// samples.csv, histogram.csv, readings.csv; nothing without a law.
void save_pair_errors(const PairErrors& errors, const std::filesystem::path& folder);

}  // namespace annulus::app
