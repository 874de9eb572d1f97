#pragma once

#include <string>
#include <vector>

#include "app/model/study_cases.h"
#include "app/study/study_subject.h"

/// [[sweep]], [[grid]], [load_spectrum], [[transient]], [monte_carlo], [sensitivity] and [optimise]: the dynamics of a
/// scene again, for other inputs.
namespace annulus::app {

/// Makes every changed scene of sweeps, grids, load spectrum and sensitivity and checks it, draws every sample and
/// checks its range. Throws InputError naming the study, the value and what is wrong with it. Computes nothing elastic.
void check_studies(const Scene& scene);

/// All studies of the nominal scene on its tables and others where needed. Writes OUT/<variant>/dynamics/sweep_<n>.csv,
/// sweep_<n>_poincare.csv, grid_<n>.csv, load_spectrum.csv, transient_<n>*.csv, monte_carlo.csv, optimise/ and
/// OUT/sensitivity.csv; finished points are cached.
[[nodiscard]] StudyResults run_studies(const StudySubject& subject);

/// As in the scene: "genetic", "cma_es", "differential_evolution".
[[nodiscard]] const std::vector<std::string>& optimiser_names();

// Parts of studies, whose results stay in the store of the subject's options.
/// Samples by their numbers from 0.
void compute_samples(const StudySubject& subject, const Sampling& sampling, const std::vector<int>& numbers);
[[nodiscard]] TransientResult followed_transient(const StudySubject& subject, std::size_t transient);
/// Searches by their numbers: optimiser x repeats, repeats fastest.
void compute_searches(const StudySubject& subject, const std::vector<std::size_t>& numbers);

// The studies one by one.
[[nodiscard]] SweepResult run_sweep(const StudySubject& subject, std::size_t sweep);
[[nodiscard]] GridResult run_grid(const StudySubject& subject, std::size_t grid);
[[nodiscard]] LoadSpectrumResult run_load_spectrum(const StudySubject& subject);
[[nodiscard]] TransientResult run_transient(const StudySubject& subject, std::size_t transient);
[[nodiscard]] MonteCarloResult run_monte_carlo(const StudySubject& subject, const Sampling& sampling);
[[nodiscard]] SensitivityResult run_sensitivity(const StudySubject& subject);
[[nodiscard]] OptimiseResults run_optimise(const StudySubject& subject);

}  // namespace annulus::app
