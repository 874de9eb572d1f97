#pragma once

#include <filesystem>
#include <string>

namespace annulus::app {

/// The scripts at the end of a page: what its interactive plots need, and nothing for a page without any. A library
/// that is not installed is told of once; the plots are then pictures.
[[nodiscard]] std::string page_scripts(const std::string& page);

/// A page (report_page), and every picture of it as a file of its own, `<pictures>/<number>_<section>_<title>.svg`
/// beside it. Pictures of an earlier page are removed.
void write_report(const std::filesystem::path& file, const std::string& page, const std::string& pictures = "pictures");

}  // namespace annulus::app
