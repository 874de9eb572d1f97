#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/systems/planetary/stage_response.h"

namespace annulus::app {

/// figures.json: figures of merit and modes of one response, with the identity of its inputs.
[[nodiscard]] std::string response_json(const StageResponse& response, const std::string& id);
/// Read back; nothing when the file belongs to other inputs. Throws when it is damaged.
[[nodiscard]] std::optional<StageResponse> parse_response_json(const std::filesystem::path& file,
                                                               const std::string& id);

}  // namespace annulus::app
