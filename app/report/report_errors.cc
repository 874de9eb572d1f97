#include <fmt/format.h>

#include <cmath>

#include "app/report/report_parts.h"

namespace annulus::app {

namespace {

std::string share_text(double part) {
  if (!std::isfinite(part)) return "not known";
  return part == 0 ? "–" : fmt::format("{:.2g} %", 100 * part);
}

void add_mesh(HtmlTable& table, const std::string& name, const MeshResult& mesh) {
  if (!mesh.model.computed()) return;
  table.rows.push_back({name});
  const auto add = [&](const char* what, const Estimate& e) {
    table.rows.push_back({what, share_text(e.error_relative), share_text(e.parts.discretisation),
                          share_text(e.parts.contact), share_text(e.parts.condensation),
                          share_text(e.parts.interpolation), share_text(e.parts.model)});
  };
  add("mean stiffness", mesh.mean_stiffness());
  add("mean transmission error", mesh.lte_mean());
  add("range of the transmission error", mesh.lte_peak_to_peak());
}

}  // namespace

std::string stiffness_error_section(const RunResult& result) {
  HtmlTable table{
      .head = {"", "error", "discretisation", "local contact", "condensation", "table interpolation", "model choice"},
      .rows = {},
      .css_class = "numbers"};
  add_mesh(table, "sun mesh", result.sun_mesh);
  for (const auto& ring : result.rings) add_mesh(table, "ring mesh of " + escape(ring.name), ring.mesh);
  if (table.rows.empty()) return "";
  return "<h3 id=\"stiffness-errors\">What the errors of the stiffness are made of</h3>\n" + html(table) +
         "<p>Discretisation: the difference of two levels of cells. Local contact: the pressure on the flanks, against "
         "twice as many pieces. Condensation: asymmetry of the compliance between tooth pairs. Model choice: plane "
         "strain for a face of finite width, formulas for teeth; the wanted accuracy does not count plane strain, "
         "which "
         "solid elements (model = \"solid\") do without.</p>\n";
}

}  // namespace annulus::app
