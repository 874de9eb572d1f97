#pragma once

#include <string>
#include <vector>

#include "app/plan/warning.h"
#include "core/json.h"
#include "dynamics/steady_state/other_motions.h"

/// Stable motions that a run found, for summary, warnings and report.
namespace annulus::app {

/// "with the excitation", "every 2 periods of the excitation", "irregular".
[[nodiscard]] std::string period_text(const dynamics::FoundMotion& motion);

/// Null where none were looked for.
[[nodiscard]] Json to_json(const dynamics::FoundMotions& motions);

/// What a user must know of them. `contact_loss`: share of the time, of the response.
[[nodiscard]] std::vector<Warning> motion_warnings(const dynamics::FoundMotions& motions, double contact_loss,
                                                   const std::string& variant);

}  // namespace annulus::app
