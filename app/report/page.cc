#include "app/report/page.h"

#include <fmt/format.h>

#include <cstdlib>
#include <map>

#include "app/report/plot/plot_data.h"
#include "app/report/text/xml.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"
#include "page_parts.h"

namespace annulus::app {

namespace {

std::string attribute(const std::string& element, const std::string& name) {
  const std::string head = name + "=\"";
  const auto at = element.substr(0, element.find('>')).find(head);
  if (at == std::string::npos) return {};
  const auto begin = at + head.size();
  return element.substr(begin, element.find('"', begin) - begin);
}

/// Behind the end of the <svg> element that begins at `at`, which may hold others of its kind.
std::size_t end_of_svg(const std::string& text, std::size_t at) {
  static const std::string opening = "<svg", closing = "</svg>";
  for (int depth = 0;;) {
    const auto open = text.find(opening, at), close = text.find(closing, at);
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

/// Drawn to stand beside others; alone and as wide as the page its letters would be those of a headline.
bool is_narrow(const std::string& svg) {
  constexpr double usual_width = 500;
  const auto box = attribute(svg, "viewBox");  // "0 0 430 270"
  return box.starts_with("0 0 ") && std::strtod(box.c_str() + 4, nullptr) < usual_width;
}

const char* css_class(Text::Look look) {
  switch (look) {
    case Text::Look::agrees:
      return "tag agrees";
    case Text::Look::disagrees:
      return "tag disagrees";
    case Text::Look::undecided:
      return "tag undecided";
    case Text::Look::assumed:
      return "tag assumed";
    default:
      return "muted";
  }
}

std::string html(const Text::Run& run) {
  const std::string text = escape(run.text);
  switch (run.look) {
    case Text::Look::plain:
      return text;
    case Text::Look::bold:
      return "<b>" + text + "</b>";
    case Text::Look::code:
      return "<code>" + text + "</code>";
    case Text::Look::subscript:
      return "<sub>" + text + "</sub>";
    case Text::Look::link:
      return "<a href=\"#" + escape(run.target) + "\">" + text + "</a>";
    case Text::Look::line_break:
      return "<br>";
    default:
      return fmt::format("<span class=\"{}\">{}</span>", css_class(run.look), text);
  }
}

/// Writes blocks as HTML; remembers what is drawn and which scripts that needs.
class BlockWriter {
 public:
  explicit BlockWriter(std::string section) : section_(std::move(section)) {}

  [[nodiscard]] std::string written(const std::vector<Block>& blocks) {
    std::string text;
    for (const auto& block : blocks) text += std::visit([this](const auto& b) { return written(b); }, block.content);
    return text;
  }

  std::vector<PictureFile> pictures;
  bool has_plots = false, has_views = false;

 private:
  std::string written(const Heading& heading) {
    return fmt::format("<h3{}>{}</h3>\n", heading.anchor.empty() ? "" : " id=\"" + escape(heading.anchor) + "\"",
                       app::html(heading.text));
  }

  std::string written(const Paragraph& paragraph) {
    return fmt::format("<p{}>{}</p>\n", paragraph.tone == Paragraph::Tone::muted ? " class=\"muted\"" : "",
                       app::html(paragraph.text));
  }

  std::string written(const List& list) {
    std::string items;
    for (const auto& item : list.items) items += "<li>" + app::html(item) + "</li>\n";
    return "<ul>" + items + "</ul>\n";
  }

  std::string written(const PageTable& table) {
    std::string text = "<div class=\"wide\"><table";
    text += table.style == PageTable::Style::numbers ? " class=\"numbers\"><tr>" : "><tr>";
    for (const auto& cell : table.head) text += "<th>" + app::html(cell) + "</th>";
    text += "</tr>\n";
    for (const auto& row : table.rows) {
      text += "<tr>";
      if (row.size() == 1)
        text += fmt::format("<td class=\"group\" colspan=\"{}\">{}</td>", table.head.size(), app::html(row.front()));
      else
        for (const auto& cell : row) text += "<td>" + app::html(cell) + "</td>";
      text += "</tr>\n";
    }
    return text + "</table></div>\n";
  }

  std::string written(const Pictures& figure) {
    static const std::map<Pictures::Layout, const char*> classes = {{Pictures::Layout::row, ""},
                                                                    {Pictures::Layout::shapes, " class=\"shapes\""},
                                                                    {Pictures::Layout::meshes, " class=\"meshes\""},
                                                                    {Pictures::Layout::fields, " class=\"fields\""}};
    const bool one = figure.list.size() == 1 && figure.layout == Pictures::Layout::row;
    bool narrow = false;
    std::string cells;
    for (const auto& picture : figure.list) {
      const auto first = pictures.size();
      const auto drawn = std::visit([this](const auto& d) { return written(d); }, picture.drawn);
      narrow = one && pictures.size() > first && is_narrow(pictures[first].svg);
      if (std::holds_alternative<StoredViews>(picture.drawn)) {
        cells += drawn;  // cells already
        continue;
      }
      cells += "<div>";
      if (!picture.title.empty()) cells += "<h3>" + app::html(picture.title) + "</h3>";
      cells += drawn;
      if (!picture.caption.empty()) cells += "<figcaption>" + app::html(picture.caption) + "</figcaption>";
      cells += "</div>\n";
    }
    std::string text = fmt::format("<figure{}>{}<div class=\"row{}{}\">{}</div>", classes.at(figure.layout),
                                   written(figure.legend), one ? " one" : "", narrow ? " narrow" : "", cells);
    if (!figure.caption.empty()) text += "<figcaption>" + app::html(figure.caption) + "</figcaption>";
    return text + "</figure>\n";
  }

  std::string written(const Legend& legend) {
    if (legend.empty()) return {};
    std::string text = "<div class=\"legend\">";
    for (const auto& [label, colour] : legend)
      text += fmt::format("<span><i style=\"background:{}\"></i>{}</span>", palette(colour), escape(label));
    return text + "</div>";
  }

  std::string written(const Box& box) {
    if (box.kind == Box::Kind::verdict) return "<div class=\"verdict\">\n" + written(box.blocks) + "</div>\n";
    return "<details><summary>" + app::html(box.summary) + "</summary>" + written(box.blocks) + "</details>\n";
  }

  /// A plot: its picture, and its numbers for page.js.
  template <class Kind>
  std::string written(const Kind& plot) {
    has_plots = true;
    const std::string svg = recorded(to_svg(plot));
    return "<div class=\"plot\">" + svg + "<script type=\"application/json\">" + script_text(plot_data(plot)) +
           "</script></div>";
  }

  std::string written(const Drawing& drawing) { return recorded(drawing.svg); }

  std::string written(const StoredViews& views) {
    has_views = true;
    static const std::string opening = "<svg xmlns=";
    for (std::size_t at = 0; (at = views.html.find(opening, at)) != std::string::npos;) {
      const auto end = end_of_svg(views.html, at);
      (void)recorded(views.html.substr(at, end - at));
      at = end;
    }
    return views.html;
  }

  std::string recorded(const std::string& svg) {
    pictures.push_back({section_, attribute(svg, "aria-label"), svg});
    return svg;
  }

  std::string section_;
};

/// The page template with the names between {{ and }} replaced.
std::string filled_template(const std::map<std::string, std::string>& parts) {
  const std::string pattern = page_template;
  std::string text;
  std::size_t begin = 0;
  for (std::size_t at = 0; (at = pattern.find("{{", begin)) != std::string::npos;) {
    const auto end = pattern.find("}}", at);
    text += pattern.substr(begin, at - begin) + parts.at(pattern.substr(at + 2, end - at - 2));
    begin = end + 2;
  }
  return text + pattern.substr(begin);
}

/// A library with our script on top; nothing when a file of it is not installed.
std::string scripts(const std::vector<const char*>& libraries, const char* own, const char* package) {
  std::string text;
  for (const char* file : libraries) {
    try {
      text += "<script>" + read_file(file) + "</script>\n";
    } catch (const InputError&) {
      log::warn(fmt::format("pictures of the report stay pictures: {} is not installed (Debian: {})", file, package));
      return {};
    }
  }
  return text + "<script>" + own + "</script>\n";
}

std::string heading_html(const Section& section) {
  return fmt::format("<h2 id=\"{}\">{}</h2>\n", escape(section.anchor),
                     escape(section.title.empty() ? section.name : section.title));
}

}  // namespace

std::string html(const Text& text) {
  std::string all;
  for (const auto& run : text.runs()) all += html(run);
  return all;
}

std::string html(const Section& section) {
  if (section.blocks.empty()) return {};
  return heading_html(section) + BlockWriter(section.anchor).written(section.blocks.list());
}

RenderedPage rendered(const Page& page) {
  RenderedPage result;
  bool has_plots = false, has_views = false;
  const auto write = [&](const std::string& anchor, const Blocks& blocks) {
    BlockWriter writer(anchor);
    auto text = writer.written(blocks.list());
    has_plots = has_plots || writer.has_plots;
    has_views = has_views || writer.has_views;
    result.pictures.insert(result.pictures.end(), writer.pictures.begin(), writer.pictures.end());
    return text;
  };
  const auto summary = write({}, page.summary);
  std::string links, sections;
  for (const auto& section : page.sections) {
    if (section.blocks.empty()) continue;
    links += fmt::format("<a href=\"#{}\">{}</a>", escape(section.anchor), escape(section.name));
    sections += heading_html(section) + write(section.anchor, section.blocks);
  }
  std::string script;
  if (has_plots) script += scripts({ANNULUS_CHART_JS}, page_script, "libjs-chart.js");
  if (has_views) script += scripts({ANNULUS_THREE_JS, ANNULUS_ORBIT_JS}, view3d_script, "libjs-three");
  result.html = filled_template({{"title", escape(page.title)},
                                 {"style", page_style},
                                 {"sub", html(page.sub)},
                                 {"summary", summary},
                                 {"links", links},
                                 {"sections", sections},
                                 {"scripts", script}});
  return result;
}

std::string page_html(const Page& page) { return rendered(page).html; }

}  // namespace annulus::app
