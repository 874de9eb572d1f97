#pragma once

#include <optional>
#include <string>

#include "app/model/system_run.h"
#include "core/json.h"

namespace annulus::app {

/// The planned steps of a finished run with what they cost, without those that were reused and without studies, whose
/// points may be partly reused.
[[nodiscard]] PlanCost actual_costs(const SystemRun& run);
/// What a mesh cost; nothing when it was reused or not computed.
[[nodiscard]] std::optional<CostRun> actual_mesh(CostRun size, const MeshResult& mesh);
/// A step of which only the wall time (s) is known.
[[nodiscard]] CostRun actual_time(CostRun size, double seconds);
/// Later predictions on this machine learn its pace from it.
void keep_costs(const PlanCost& done);

/// "predicted 4.1 s and 410 MB, actual 4.4 s and 436 MB"; empty when nothing was computed. The memory is left out when
/// a mesh was reused: the peak belongs to what was computed.
[[nodiscard]] std::string cost_sentence(const SystemRun& run);
/// Predicted and actual time of every step as a JSON object.
[[nodiscard]] Json cost_json(const PlanCost& done);

}  // namespace annulus::app
