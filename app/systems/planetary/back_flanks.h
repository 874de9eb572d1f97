#pragma once

#include <string>
#include <vector>

#include "dynamics/systems/planetary/response.h"

namespace annulus::app {

/// A sentence for every mesh whose back flanks carry load at times: share of the time, mean force, and what that means
/// for the results. Empty where driving flanks alone carry.
[[nodiscard]] std::vector<std::string> back_flank_warnings(const dynamics::DynamicResponse& response);

}  // namespace annulus::app
