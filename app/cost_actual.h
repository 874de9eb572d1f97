#pragma once

#include <string>

#include "app/pipeline.h"

namespace annulus::app {

/// The predicted steps of a finished run with what they cost, without those that were reused and without studies, whose
/// points may be partly reused.
[[nodiscard]] PlanCost actual_costs(const RunResult& result);

/// "predicted 4.1 s and 410 MB, actual 4.4 s and 436 MB"; empty when nothing was computed. The memory is left out when
/// a mesh was reused: the peak belongs to what was computed.
[[nodiscard]] std::string cost_sentence(const RunResult& result);

/// Predicted and actual time of every step as HTML; empty when nothing was computed.
[[nodiscard]] std::string predicted_and_actual_html(const RunResult& result);

}  // namespace annulus::app
