#pragma once

#include <optional>
#include <string>

#include "app/rexs/rexs_reader.h"
#include "app/scene/scene.h"

namespace annulus::app {

/// REXS (export/rexs.h) of a pair of gears.
[[nodiscard]] std::string pair_rexs(const Scene& scene);
/// The first stage of two cylindrical gears of a file; nothing where there is none.
[[nodiscard]] std::optional<NewValues> pair_from_rexs(const RexsFile& file);

}  // namespace annulus::app
