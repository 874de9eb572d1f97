#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/compare/compared_run.h"
#include "app/report/page.h"
#include "core/json.h"

/// Finished runs side by side, in every form.
namespace annulus::app {

[[nodiscard]] std::string comparison_text(const std::vector<ComparedRun>& runs);  ///< for standard output
/// Results of all variants in the units people read them in, with errors and spreads, and the inputs that differ.
[[nodiscard]] Json comparison_json(const std::vector<ComparedRun>& runs);
/// Whether a file is a table as comparison_csv() makes them. Throws InputError when it cannot be read.
[[nodiscard]] bool is_comparison_table(const std::filesystem::path& file);
/// One row per result and variant: values, errors, and what they say against the first variant.
[[nodiscard]] std::string comparison_csv(const std::vector<ComparedRun>& runs);
[[nodiscard]] Page comparison_page(const std::vector<ComparedRun>& runs);
[[nodiscard]] std::string comparison_html(const std::vector<ComparedRun>& runs);  ///< a self-contained page

}  // namespace annulus::app
