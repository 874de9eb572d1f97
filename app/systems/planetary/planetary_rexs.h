#pragma once

#include <optional>
#include <string>

#include "app/rexs/rexs_reader.h"
#include "app/scene/scene.h"

namespace annulus::app {

/// REXS (export/rexs.h) of a planetary stage with the ring of that name. Throws InputError where it has none of it.
[[nodiscard]] std::string planetary_rexs(const Scene& scene, const std::string& ring);
/// The planetary stage of a file; nothing where no ring gear is in mesh. Throws InputError where there are several.
[[nodiscard]] std::optional<NewValues> planetary_from_rexs(const RexsFile& file);

}  // namespace annulus::app
