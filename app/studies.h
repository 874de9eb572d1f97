#pragma once

#include "app/pipeline.h"

/// [[sweep]], [monte_carlo] and [sensitivity]: the dynamics of a scene again, for other inputs.
namespace annulus::app {

/// Makes every changed scene of sweeps and sensitivity and checks it, draws every sample and checks its range. Throws
/// InputError naming the study, the value and what is wrong with it. Computes nothing elastic.
void check_studies(const Scene& scene);

/// All studies of the nominal scene on its tables and others where needed. Writes OUT/<ring>/dynamics/sweep_<n>.csv,
/// sweep_<n>_poincare.csv, monte_carlo.csv and OUT/sensitivity.csv; finished points are kept and reused.
[[nodiscard]] StudyResults run_studies(const RunResult& nominal, const RunOptions& options);

// The studies one by one.
[[nodiscard]] SweepResult run_sweep(const RunResult& nominal, const RunOptions& options, std::size_t sweep);
[[nodiscard]] MonteCarloResult run_monte_carlo(const RunResult& nominal, const RunOptions& options);
[[nodiscard]] SensitivityResult run_sensitivity(const RunResult& nominal, const RunOptions& options);

}  // namespace annulus::app
