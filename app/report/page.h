#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/report/section.h"

/// The one place where reports become HTML.
namespace annulus::app {

/// A picture of a page as a file of its own.
struct PictureFile {
  std::string section;  ///< anchor
  std::string label;    ///< for those who cannot see it
  std::string svg;
};

/// One self-contained page without external references, and every picture on it in order.
struct RenderedPage {
  std::string html;
  std::vector<PictureFile> pictures;
};
/// Libraries of the interactive plots that are not installed are logged once; the plots then stay pictures.
[[nodiscard]] RenderedPage rendered(const Page& page);
[[nodiscard]] std::string page_html(const Page& page);

/// Parts of a page alone.
[[nodiscard]] std::string html(const Text& text);
[[nodiscard]] std::string html(const Section& section);

/// A page, and every picture of it as a file of its own, `<pictures>/<number>_<section>_<title>.svg` beside it.
/// Throws FileError when a file cannot be written.
void write_report(const std::filesystem::path& file, const Page& page, const std::string& pictures = "pictures");

}  // namespace annulus::app
