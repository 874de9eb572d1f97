#pragma once

#include <string>

#include "app/study/study_result.h"

/// The studies as JSON objects (text), to be merged into summary.json.
namespace annulus::app {

/// "monte_carlo", "sweeps" and "grids" of one variant.
[[nodiscard]] std::string variant_studies_json(const StudyResults& studies, std::size_t variant);
/// "monte_carlo" (orders of the variants) and "sensitivity".
[[nodiscard]] std::string studies_json(const StudyResults& studies);

}  // namespace annulus::app
