#include "app/report/page.h"

#include <fmt/format.h>

#include <cctype>
#include <cstdlib>

#include "app/report/plot/chart.h"
#include "app/report/plot/colour_scale.h"
#include "app/report/plot/ticks.h"
#include "app/report/text/packed.h"
#include "app/report/text/svg.h"
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

/// Drawn to stand beside others; alone and as wide as the page its letters would be those of a headline.
bool is_narrow(const std::string& svg) {
  constexpr double usual_width = 500;
  const auto box = attribute(svg, "viewBox");  // "0 0 430 270"
  return box.starts_with("0 0 ") && std::strtod(box.c_str() + 4, nullptr) < usual_width;
}

/// Markup around a run of text, in the order of Text::Look; fields are target and text.
constexpr const char* markup[] = {"{1}",
                                  "<b>{1}</b>",
                                  "<code>{1}</code>",
                                  "<span class=\"muted\">{1}</span>",
                                  "<sub>{1}</sub>",
                                  "<span class=\"tag agrees\">{1}</span>",
                                  "<span class=\"tag disagrees\">{1}</span>",
                                  "<span class=\"tag undecided\">{1}</span>",
                                  "<span class=\"tag assumed\">{1}</span>",
                                  "<a href=\"#{0}\">{1}</a>",
                                  "<br>"};

/// A file name from a title: "Mean mesh stiffness, N/mm" -> "mean_mesh_stiffness_n_mm".
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

/// Writes blocks as HTML; remembers what is drawn and which scripts that needs.
class BlockWriter {
 public:
  explicit BlockWriter(std::string anchor = {}) : section(std::move(anchor)) {}

  [[nodiscard]] std::string written(const std::vector<Block>& blocks) {
    std::string text;
    for (const auto& block : blocks) text += std::visit([this](const auto& b) { return written(b); }, block.content);
    return text;
  }

  std::string section;  ///< anchor of the one that is being written
  bool folded = false;  ///< its pictures are unpacked when it is opened
  bool packs = false;   ///< whether pages can unpack
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

  static std::string written(const Lines& lines) { return "<pre tabindex=\"0\">" + escape(lines.text) + "</pre>\n"; }

  std::string written(const List& list) {
    std::string items;
    for (const auto& item : list.items) items += "<li>" + app::html(item) + "</li>\n";
    return "<ul>" + items + "</ul>\n";
  }

  std::string written(const PageTable& table) {
    std::string text = "<div class=\"wide\" tabindex=\"0\"><table";
    text += table.style == PageTable::Style::numbers ? " class=\"numbers\"><tr>" : "><tr>";
    for (const auto& cell : table.head) text += cell.empty() ? "<td></td>" : "<th>" + app::html(cell) + "</th>";
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
    static constexpr const char* classes[] = {"row", "shapes", "meshes", "fields"};  // in the order of Layout
    const bool one = figure.list.size() == 1 && figure.layout == Pictures::Layout::row;
    bool narrow = false;
    std::string cells;
    for (const auto& picture : figure.list) {
      const auto first = pictures.size();
      const auto drawn = std::visit([this](const auto& d) { return written(d); }, picture.drawn);
      narrow = one && is_narrow(pictures[first].svg);
      cells += "<div" + choice("variant", picture.variant) + choice("mesh", picture.mesh) + ">";
      if (!picture.title.empty()) cells += "<h3>" + app::html(picture.title) + "</h3>";
      cells += drawn;
      if (!picture.caption.empty()) cells += "<figcaption>" + app::html(picture.caption) + "</figcaption>";
      cells += "</div>\n";
    }
    std::string text = fmt::format("<figure class=\"{}\">{}<div class=\"row{}{}\">{}</div>",
                                   classes[static_cast<std::size_t>(figure.layout)], written(figure.legend),
                                   one ? " one" : "", narrow ? " narrow" : "", cells);
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
  std::string written(const Chart& chart) {
    has_plots = true;
    return fmt::format("<div class=\"plot\">{}{}</div>", recorded(to_svg(chart)), data(plot_data(chart)));
  }

  /// Bodies: their picture, and their numbers for view3d.js.
  std::string written(const DeformedMesh& view) {
    has_views = true;
    return fmt::format(
        "<div class=\"view3d\">{}{}<div class=\"scale\">{} von Mises stress, MPa; darkest from {:g}, at most {:.0f} · "
        "displacement × "
        "{:g}, at most {:.3g} µm · mesh phase {:.4g}{}</div></div>\n",
        recorded(to_svg(view)), data(view_data(view)), colour_bar(view.top_MPa), view.top_MPa, view.largest_stress_MPa,
        view.exaggeration, 1000 * view.largest_displacement_mm, view.mesh_phase,
        view.ring_tooth > 0 ? fmt::format(", ring tooth {}", view.ring_tooth) : std::string());
  }

  /// Colours from zero to a value, with ticks.
  static std::string colour_bar(double top) {
    std::string colours, ticks;
    for (const auto& colour : scale_colours(Ways::one)) colours += "," + colour;
    const auto values = nice_ticks(0, top, 4);
    const auto labels = tick_labels(values);
    for (std::size_t i = 0; i < values.size(); ++i)
      ticks += fmt::format("<b style=\"left:{:.4g}%\">{}</b>", 100 * values[i] / top, labels[i]);
    return fmt::format("<span class=\"bar\" style=\"background:linear-gradient(to right{})\">{}</span>", colours,
                       ticks);
  }

  std::string written(const Drawing& drawing) { return recorded(drawing.svg); }

  static std::string choice(const char* what, const std::string& value) {
    return value.empty() ? "" : fmt::format(" data-{}=\"{}\"", what, escape(value));
  }

  [[nodiscard]] std::string data(const nlohmann::json& numbers) const {
    if (!packs) return {};
    return "<script type=\"text/plain\" class=\"data\">" +
           packed(numbers.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) + "</script>";
  }

  std::string recorded(const std::string& svg) {
    pictures.push_back({section, attribute(svg, "aria-label"), svg});
    constexpr std::size_t small = 4000;
    if (!folded || !packs || svg.size() < small) return svg;
    return "<script type=\"text/plain\" class=\"picture\">" + packed(svg) + "</script>";
  }
};

/// The text of a library for the page; nothing where it is not installed.
std::string library(const char* file, const char* package) {
  try {
    return read_file(file);
  } catch (const InputError&) {
    log::warn(fmt::format("the pictures of the report are not interactive: {} is not installed (Debian package: {})",
                          file, package));
    return {};
  }
}

/// Libraries with our script on top; nothing when a file of it is not installed.
std::string scripts(const std::vector<const char*>& libraries, const char* own, const char* package) {
  std::string text;
  for (const char* file : libraries) {
    const auto script = library(file, package);
    if (script.empty()) return {};
    text += "<script type=\"text/plain\" class=\"library\">" + packed(script) + "</script>\n";
  }
  return text + "<script type=\"text/plain\" class=\"own\">" + own + "</script>\n";
}

/// What a reader may choose, by name; nothing when there is one.
struct PageChoice {
  const char *key, *what;
  const std::vector<std::string>& names;
  bool all_first = false;  ///< else the first of them is shown at the beginning
};
std::string choice_html(const PageChoice& choice) {
  if (choice.names.size() < 2) return {};
  constexpr const char* all = "<option value=\"\">all</option>";
  std::string options;
  for (const auto& name : choice.names) options += fmt::format("<option value=\"{0}\">{0}</option>", escape(name));
  options = choice.all_first ? all + options : options + all;
  return fmt::format("<label>{} <select data-choose=\"{}\">{}</select></label>", choice.what, choice.key, options);
}

std::string section_html(const Section& section, const std::string& blocks) {
  const auto title = escape(section.title.empty() ? section.name : section.title), anchor = escape(section.anchor);
  if (section.folded)
    return fmt::format("<details class=\"section\" id=\"{}\"><summary><h2>{}</h2></summary>\n{}</details>\n", anchor,
                       title, blocks);
  return fmt::format("<h2 id=\"{}\">{}</h2>\n{}", anchor, title, blocks);
}

}  // namespace

std::string html(const Text& text) {
  std::string all;
  for (const auto& run : text.runs())
    all += fmt::format(fmt::runtime(markup[static_cast<std::size_t>(run.look)]), escape(run.target), escape(run.text));
  return all;
}

std::string html(const Section& section) {
  if (section.blocks.empty()) return {};
  return section_html(section, BlockWriter(section.anchor).written(section.blocks.list()));
}

RenderedPage rendered(const Page& page) {
  BlockWriter writer;
  const auto unpacker = library(ANNULUS_PAKO_JS, "node-pako");
  writer.packs = !unpacker.empty();
  const auto summary = writer.written(page.summary.list());
  std::string links, sections;
  for (const auto& section : page.sections) {
    if (section.blocks.empty()) continue;
    writer.section = section.anchor;
    writer.folded = section.folded;
    links += fmt::format("<li><a href=\"#{}\">{}</a></li>", escape(section.anchor), escape(section.name));
    sections += section_html(section, writer.written(section.blocks.list()));
  }
  std::string script;
  if (writer.packs) script = "<script>" + unpacker + "</script>\n<script>" + base_script + "</script>\n";
  if (writer.packs && writer.has_plots) script += scripts({ANNULUS_CHART_JS}, page_script, "libjs-chart.js");
  if (writer.packs && writer.has_views)
    script += scripts({ANNULUS_THREE_JS, ANNULUS_ORBIT_JS}, view3d_script, "libjs-three");
  if (writer.packs) script += "<script>annulus.begin();</script>\n";
  return {fmt::format(fmt::runtime(page_template), fmt::arg("title", escape(page.title)), fmt::arg("style", page_style),
                      fmt::arg("sub", html(page.sub)), fmt::arg("summary", summary), fmt::arg("links", links),
                      fmt::arg("choices", choice_html({"variant", page.variant_word.c_str(), page.variants}) +
                                              choice_html({"mesh", "Mesh", page.meshes}) +
                                              choice_html({"line", page.line_kind.c_str(), page.lines, true})),
                      fmt::arg("sections", sections), fmt::arg("scripts", script)),
          std::move(writer.pictures)};
}

std::string page_html(const Page& page) { return rendered(page).html; }

void write_report(const std::filesystem::path& file, const Page& page, const std::string& pictures) {
  const auto made = rendered(page);
  write_file(file, made.html);
  const auto folder = file.parent_path() / pictures;
  int number = 0;
  for (const auto& p : made.pictures) {
    const auto title = slug(p.label);
    const auto name = fmt::format("{:02}_{}{}.svg", ++number, slug(p.section), title.empty() ? "" : "_" + title);
    std::filesystem::create_directories(folder);
    write_file(folder / name, p.svg);
  }
}

}  // namespace annulus::app
