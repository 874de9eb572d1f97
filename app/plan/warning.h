#pragma once

#include <string>
#include <vector>

#include "core/json.h"

namespace annulus::app {

/// note: good to know; warning: to be known before a number is trusted; severe: numbers that are wrong or mean nothing.
enum class Severity { note, warning, severe };
[[nodiscard]] const char* to_text(Severity severity);

/// What a user must know of a scene or of results.
struct Warning {
  std::string key;  ///< what it is about, for programs: "tip_clearance"
  Severity severity = Severity::warning;
  std::string text;     ///< sentences, with the remedy
  std::string where{};  ///< ring or mesh; empty: the whole
};

/// "ring 'a': ..." behind its severity.
[[nodiscard]] std::string to_text(const Warning& warning);
[[nodiscard]] Json to_json(const std::vector<Warning>& warnings);
/// The severe ones first, otherwise in their order.
[[nodiscard]] std::vector<Warning> by_severity(std::vector<Warning> warnings);
/// Whether any is more than a note.
[[nodiscard]] bool any_warning(const std::vector<Warning>& warnings);

}  // namespace annulus::app
