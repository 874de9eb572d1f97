#include "app/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "app/content_id.h"
#include "app/report/report_drawings.h"
#include "app/report/report_files.h"
#include "app/report/report_parts.h"
#include "core/units.h"

namespace annulus::app {

namespace {

constexpr const char* style = R"css(
:root { color-scheme: light; }
body { margin: 0; font: 15px/1.5 system-ui, -apple-system, "Segoe UI", sans-serif; color: #222; background: #fff; }
main { max-width: 1320px; margin: 0 auto; padding: 24px 28px 80px; }
h1 { font-size: 27px; line-height: 1.25; margin: 12px 0 4px; }
h2 { font-size: 20px; margin: 44px 0 10px; padding-bottom: 4px; border-bottom: 1px solid #ddd; }
h3 { font-size: 16px; margin: 26px 0 6px; }
p, li { max-width: 84ch; }
.sub { color: #666; margin: 0 0 18px; }
.verdict { background: #f4f7fa; border-left: 4px solid #0072B2; padding: 10px 18px; margin: 18px 0; }
.verdict p { margin: 6px 0; }
nav { font-size: 14px; margin: 8px 0 0; } nav a { margin-right: 14px; color: #0072B2; text-decoration: none; }
table { border-collapse: collapse; font-size: 14px; margin: 10px 0; font-variant-numeric: tabular-nums; }
th, td { padding: 4px 12px 4px 0; text-align: left; vertical-align: top; border-bottom: 1px solid #eee; }
th { font-weight: 600; border-bottom: 1px solid #bbb; }
table.numbers td:not(:first-child), table.numbers th:not(:first-child) { text-align: right; white-space: nowrap; padding: 4px 0 4px 18px; }
table.numbers td.group { text-align: left; font-weight: 600; padding-top: 12px; }
.wide { overflow-x: auto; }
figure { margin: 14px 0 26px; }
figure .row { display: grid; grid-template-columns: repeat(auto-fit, minmax(360px, 1fr)); gap: 10px 14px; align-items: end; }
figure .row.one { grid-template-columns: minmax(360px, 900px); } figure .row.one.narrow { grid-template-columns: minmax(360px, 560px); }
figure .row > div { min-width: 0; } figure svg { width: 100%; height: auto; display: block; }
figure.meshes .row { align-items: start; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 24px; } figure.meshes svg { max-height: 470px; } figure.meshes h3 { margin-top: 0; }
figure.shapes .row { grid-template-columns: repeat(auto-fill, minmax(190px, 1fr)); max-width: 1320px; }
@keyframes swing { to { transform: translate(var(--x), var(--y)) rotate(var(--a)); } }
.swing { animation: swing 0.7s ease-in-out infinite alternate paused; } figure.shapes .row > div:hover .swing { animation-play-state: running; }
figcaption { color: #555; font-size: 13.5px; max-width: 110ch; margin-top: 6px; }
.legend { font-size: 13px; color: #333; margin: 2px 0 4px; } .legend span { margin-right: 16px; white-space: nowrap; }
.legend i { display: inline-block; width: 18px; height: 3px; vertical-align: middle; margin-right: 6px; }
.tag { display: inline-block; border-radius: 3px; padding: 0 7px; font-size: 13px; font-weight: 600; white-space: nowrap; }
.agrees { background: #d9efe7; color: #00563f; } .disagrees { background: #fbe0d1; color: #8a3a00; }
.undecided { background: #ececec; color: #444; } .assumed { background: #fdf0d5; color: #7a4f00; }
.muted { color: #777; } code { font-size: 13px; }
details { margin: 10px 0; } summary { cursor: pointer; color: #0072B2; }
.view3d { position: relative; } .view3d canvas { display: block; cursor: grab; } .view3d.awake > svg { display: none; }
.view3d .turn { position: absolute; top: 4px; right: 4px; font: inherit; font-size: 13px; color: #0072B2; background: #fffc; border: 1px solid #0072B2; border-radius: 3px; cursor: pointer; }
.view3d .tools.shown { display: block; font-size: 12px; color: #777; } .view3d .scale { font-size: 12.5px; color: #555; margin-top: 4px; }
.view3d .scale i { display: inline-block; width: 120px; height: 9px; vertical-align: middle; }
figure.fields .row { grid-template-columns: repeat(auto-fit, minmax(430px, 1fr)); align-items: start; }
.plot { position: relative; outline-offset: 2px; } .plot .live { display: flex; } .plot .chart { position: relative; flex: 1; min-width: 0; } .plot .scale { font-size: 12.5px; color: #555; } .plot .scale i { display: inline-block; width: 120px; height: 9px; margin: 0 4px; vertical-align: middle; } .plot.awake > svg { display: none; }
.plot .tools { font-size: 12px; color: #999; opacity: 0; transition: opacity 0.15s; height: 20px; margin-top: -4px; }
.plot:hover .tools, .plot:focus-within .tools { opacity: 1; }
.plot .tools button { font: inherit; color: #0072B2; background: none; border: 0; padding: 0 10px 0 0; cursor: pointer; }
@media print { .view3d canvas, .view3d .turn, .view3d .tools { display: none; } .view3d.awake > svg { display: block; } .plot .tools, .plot .live, .plot .scale { display: none; } .plot.awake > svg { display: block; } main { max-width: none; } nav { display: none; } figure { break-inside: avoid; }
  h2, h3 { break-after: avoid; } figure.fields, figure.meshes { break-inside: auto; } .view3d, figure.meshes .row > div { break-inside: avoid; }
  figure .row:not(.one), figure.fields .row { grid-template-columns: repeat(2, minmax(0, 1fr)); } .wide { overflow: visible; }
  table { font-size: 12px; } table.numbers th { white-space: normal !important; } tr { break-inside: avoid; } }
)css";

}  // namespace

std::string measured(double value, double error) {
  if (!std::isfinite(value)) return "not known";
  error = std::abs(error);
  if (!std::isfinite(error) || !(error > 0)) return to_text(value, 5);
  // Two digits of the error and the value to the same place, but no more than five digits of the value: beyond them the
  // inputs are not known.
  const auto place = [](double x) { return static_cast<int>(std::floor(std::log10(x))); };
  const int wanted = 1 - place(error);
  const int most = value == 0 ? wanted : 4 - place(std::abs(value));
  const int decimals = std::clamp(std::min(wanted, most), 0, 9);
  if (error < 0.5 * std::pow(10.0, -decimals))
    return fmt::format("{:.{}f} ± &lt;{:.{}f}", value, decimals, std::pow(10.0, -decimals), decimals);
  return fmt::format("{:.{}f} ± {:.{}f}", value, decimals, error, decimals);
}

std::string html(const HtmlTable& table) {
  std::string text =
      "<div class=\"wide\"><table" + (table.css_class.empty() ? "" : " class=\"" + table.css_class + "\"") + "><tr>";
  for (const auto& cell : table.head) text += "<th>" + cell + "</th>";
  text += "</tr>\n";
  for (const auto& row : table.rows) {
    text += "<tr>";
    if (row.size() == 1) {
      text += fmt::format("<td class=\"group\" colspan=\"{}\">{}</td>", table.head.size(), row.front());
    } else {
      for (const auto& cell : row) text += "<td>" + cell + "</td>";
    }
    text += "</tr>\n";
  }
  return text + "</table></div>\n";
}

namespace {

/// Drawn to stand beside others; alone and as wide as the page its letters would be those of a headline.
bool is_narrow(const std::string& picture) {
  constexpr double usual_width = 500;
  const std::string box = "viewBox=\"0 0 ";
  const auto at = picture.find(box);
  return at != std::string::npos && std::strtod(picture.c_str() + at + box.size(), nullptr) < usual_width;
}

}  // namespace

std::string figure(const std::vector<std::string>& pictures, const std::string& legend, const std::string& caption) {
  const bool one = pictures.size() == 1;
  std::string text = "<figure>" + legend + "<div class=\"row" + (one ? " one" : "") +
                     (one && is_narrow(pictures.front()) ? " narrow" : "") + "\">";
  for (const auto& picture : pictures) text += "<div>" + picture + "</div>\n";
  return text + "</div><figcaption>" + caption + "</figcaption></figure>\n";
}

std::string legend_html(const std::vector<std::pair<std::string, std::size_t>>& entries) {
  std::string text = "<div class=\"legend\">";
  for (const auto& [label, colour] : entries) {
    text += fmt::format("<span><i style=\"background:{}\"></i>{}</span>", palette(colour), escape(label));
  }
  return text + "</div>";
}

std::vector<std::pair<std::string, const MeshResult*>> all_meshes(const RunResult& result) {
  std::vector<std::pair<std::string, const MeshResult*>> list;
  for (const auto& ring : result.rings) list.emplace_back(ring.name, &ring.mesh);
  list.emplace_back("sun mesh", &result.sun_mesh);
  return list;
}

std::string report_page(const std::string& title, const std::string& sub, const std::string& verdict,
                        const std::vector<std::vector<Section>>& groups) {
  std::string page = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + title +
                     "</title><meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><style>" + style +
                     "</style></head><body><main>\n";
  page += "<h1>" + title + "</h1>\n<p class=\"sub\">" + sub + "</p>\n" + verdict;
  std::string links, body;
  for (const auto& sections : groups) {
    for (const auto& section : sections) {
      if (section.text.empty()) continue;
      links += fmt::format("<a href=\"#{}\">{}</a>", section.anchor, section.name);
      body += section.text;
    }
  }
  page += "<nav>" + links + "</nav>\n" + body + "</main>\n";
  return page + page_scripts(page) + "</body></html>\n";
}

std::vector<Section> study_sections(const Scene& scene, const StudyResults& studies) {
  return {{"spread", "Spread", spread_section(studies)},
          {"sweeps", "Sweeps", sweeps_section(scene, studies)},
          {"grids", "Grids", grids_section(scene, studies)},
          {"sensitivity", "Sensitivity", sensitivity_section(studies)},
          {"optimisation", "Optimisation", optimise_section(studies)}};
}

std::string report_html(const RunResult& result) {
  const std::string sub = fmt::format("annulus {} · scene <code>{}</code> · {} planets, {} kW at {} r/min of the sun",
                                      version(), escape(result.scene.file.filename().string()),
                                      result.scene.stage.planets, to_text(result.scene.stage.power / 1e3),
                                      to_text(result.geometry.operating_point.sun_speed / units::rpm, 6));
  return report_page(escape(result.scene.title), sub, verdict_section(result),
                     {{{"drawings", "Geometry", drawings_section(result)},
                       {"figures", "Key figures", key_figures_section(result)},
                       {"comparison", "Comparison with the source", comparison_section(result)},
                       {"meshes", "Meshes", meshes_section(result)},
                       {"fields", "Deformation and stress", fields_section(result)},
                       {"stiffness", "Transmission error and stiffness", stiffness_section(result)},
                       {"supports", "Pins and splines", supports_section(result)},
                       {"contact", "Face width, pressure, stress", contact_section(result)},
                       {"dynamics", "Load sharing and dynamic factors", dynamics_section(result)}},
                      study_sections(result.scene, result.studies),
                      {{"coupling", "Coupling through the ring", coupling_section(result)},
                       {"motion", "Bearings and sun orbit", motion_section(result)},
                       {"modes", "Natural frequencies", modes_section(result)},
                       {"model", "What was modelled", model_section(result)},
                       {"inputs", "Inputs", inputs_section(result)},
                       {"quality", "Checks and cost", quality_section(result)}}});
}

}  // namespace annulus::app
