#include "app/report/report_files.h"

#include <fmt/format.h>

#include <cctype>
#include <set>
#include <vector>

#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"
#include "page_parts.h"

namespace annulus::app {

namespace {

/// "Mean mesh stiffness, N/mm" -> "mean_mesh_stiffness_n_mm"
std::string slug(const std::string& title) {
  constexpr std::size_t longest = 60;
  std::string result;
  for (const char c : title) {
    const auto u = static_cast<unsigned char>(c);
    if (u < 128 && std::isalnum(u) != 0)
      result += static_cast<char>(std::tolower(u));
    else if (!result.empty() && result.back() != '_')
      result += '_';
  }
  result = result.substr(0, longest);
  while (!result.empty() && result.back() == '_') result.pop_back();
  return result;
}

std::string between(const std::string& text, const std::string& head, std::size_t from, std::size_t until) {
  const auto begin = text.find(head, from);
  if (begin == std::string::npos || begin >= until) return {};
  const auto start = begin + head.size();
  return text.substr(start, text.find('"', start) - start);
}

struct Picture {
  std::string section, title, svg;
};

/// Behind the end of the element that begins at `at`, which may hold others of its kind.
std::size_t end_of_svg(const std::string& page, std::size_t at) {
  static const std::string opening = "<svg", closing = "</svg>";
  for (int depth = 0;;) {
    const auto open = page.find(opening, at), close = page.find(closing, at);
    require(close != std::string::npos, "a picture without an end");
    if (open < close) {
      ++depth;
      at = open + opening.size();
    } else {
      at = close + closing.size();
      if (--depth == 0) return at;
    }
  }
}

/// All outermost <svg> elements of a page; nested ones have no name space of their own.
std::vector<Picture> pictures_of(const std::string& page) {
  static const std::string opening = "<svg xmlns=", heading = "<h2 id=\"";
  std::vector<Picture> pictures;
  std::string section;
  std::size_t at = 0, heading_at = page.find(heading);
  for (std::size_t begin = 0; (begin = page.find(opening, at)) != std::string::npos;) {
    for (; heading_at < begin; heading_at = page.find(heading, heading_at + 1))
      section = between(page, heading, heading_at, begin);
    at = end_of_svg(page, begin);
    const auto svg = page.substr(begin, at - begin);
    pictures.push_back({section, between(svg, "aria-label=\"", 0, svg.find('>')), svg});
  }
  return pictures;
}

}  // namespace

std::string page_scripts(const std::string& page) {
  struct Part {
    const char* element;
    std::vector<const char*> libraries;
    const char *script, *package;
  };
  const Part parts[] = {{"<div class=\"plot\">", {ANNULUS_CHART_JS}, page_script, "libjs-chart.js"},
                        {"<div class=\"view3d\">", {ANNULUS_THREE_JS, ANNULUS_ORBIT_JS}, view3d_script, "libjs-three"}};
  std::string scripts;
  for (const auto& part : parts) {
    if (page.find(part.element) == std::string::npos) continue;
    std::string text;
    bool there = true;
    for (const char* file : part.libraries) {
      try {
        text += "<script>" + read_file(file) + "</script>\n";
      } catch (const InputError&) {
        there = false;
        log::warn(
            fmt::format("pictures of the report stay pictures: {} is not installed (Debian: {})", file, part.package));
      }
    }
    if (there) scripts += text + "<script>" + part.script + "</script>\n";
  }
  return scripts;
}

void write_report(const std::filesystem::path& file, const std::string& page, const std::string& pictures) {
  write_file(file, page);
  const auto folder = file.parent_path() / pictures;
  std::set<std::filesystem::path> names;
  for (const auto& p : pictures_of(page)) {
    const auto title = slug(p.title);
    const auto name =
        fmt::format("{:02}_{}{}.svg", names.size() + 1, slug(p.section), title.empty() ? "" : "_" + title);
    std::filesystem::create_directories(folder);
    write_file(folder / name, p.svg);
    names.insert(name);
  }
  // Those of an earlier page. Another run may be at work here: what it makes or removes meanwhile is its own.
  std::error_code ignored;
  std::vector<std::filesystem::path> old;
  for (std::filesystem::directory_iterator at(folder, ignored), end; at != end; at.increment(ignored))
    if (at->path().extension() == ".svg" && names.count(at->path().filename()) == 0) old.push_back(at->path());
  for (const auto& picture : old) std::filesystem::remove(picture, ignored);
}

}  // namespace annulus::app
