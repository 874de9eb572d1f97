#pragma once

#include <vector>

#include "app/model/study_result.h"
#include "core/json.h"

namespace annulus::app {

/// Results of a design and its steady motions from several initial conditions, as JSON: a search that is read back need
/// not follow its best design again. The declarations are referred to by the design.
[[nodiscard]] Json design_json(const Design& design, const std::vector<FigureSpec>& figures);
[[nodiscard]] Design design_of(const Json& json, const std::vector<double>& x, const std::vector<FigureSpec>& figures);

}  // namespace annulus::app
