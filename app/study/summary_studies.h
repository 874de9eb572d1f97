#pragma once

#include "app/model/study_result.h"
#include "core/json.h"

/// The studies as JSON objects, to be merged into summary.json.
namespace annulus::app {

/// "order_of_rings_stays": whether the variants, of that word, keep their order.
[[nodiscard]] std::string order_column(const std::string& variant_word);
[[nodiscard]] Json interval_json(const dynamics::Interval& interval);
/// "monte_carlo", "sweeps", "grids" and "load_spectrum" of one variant.
[[nodiscard]] Json variant_studies_json(const StudyResults& studies, std::size_t variant);
/// "monte_carlo" (orders of the variants) and "sensitivity".
[[nodiscard]] Json studies_json(const StudyResults& studies);

}  // namespace annulus::app
