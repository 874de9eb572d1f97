#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/content_id.h"
#include "app/plan/cost_actual.h"
#include "app/report/report_parts.h"

namespace annulus::app {

namespace {

std::string small(double x) { return std::isfinite(x) ? fmt::format("{:.1e}", x) : "–"; }

}  // namespace

std::vector<std::string> mesh_check_row(const std::string& label, const MeshResult& mesh) {
  return {escape(label),
          small(mesh.fact("force_balance_relative")),
          small(mesh.fact("energy_balance_relative")),
          small(mesh.fact("closure_relative")),
          small(mesh.fact("reciprocity_relative")),
          small(mesh.fact("max_penetration_m")),
          small(mesh.fact("worst_error_relative")),
          std::isfinite(mesh.fact("worst_scaled_jacobian")) ? fmt::format("{:.2f}", mesh.fact("worst_scaled_jacobian"))
                                                            : "–",
          std::isfinite(mesh.fact("unknowns")) ? fmt::format("{:.0f}", mesh.fact("unknowns")) : "–"};
}

HtmlTable mesh_check_table() {
  return {.head = {"mesh", "Σ force × lever arm – torque", "work – strain energy", "LTE(1) – LTE(0)", "reciprocity",
                   "largest penetration, m", "largest error estimate", "worst cell", "unknowns"},
          .rows = {},
          .css_class = "numbers"};
}

std::string cost_html(const std::vector<std::pair<std::string, double>>& timings, double peak_memory_MB) {
  HtmlTable times{.head = {"stage", "wall time, s"}, .rows = {}, .css_class = "numbers"};
  for (const auto& [stage, seconds] : timings) times.rows.push_back({stage, fmt::format("{:.2f}", seconds)});
  return html(times) + fmt::format(
                           "<p class=\"muted\">Peak memory {:.0f} MB. annulus {}. Results that were unchanged since "
                           "an earlier run were read back and cost no time here.</p>\n",
                           peak_memory_MB, version());
}

namespace {

/// How the response of each ring was found, and loads its tables do not reach.
std::string solution_notes(const RunResult& result) {
  std::string list;
  const auto beyond = [&](const std::string& where, const MeshResult& mesh, const dynamics::DynamicResponse& f,
                          const dynamics::MeshKindResult& kind) {
    if (mesh.table.loads().size() < 2) return;
    double factor = 0;
    for (const auto& branch : kind.branches) factor = std::max(factor, branch.dynamic_factor_max.value);
    const double largest = factor * f.mean_mesh_force, tabulated = mesh.table.loads().back();
    if (largest > tabulated)
      list += fmt::format(
          "<li>{}: forces up to {:.4g} kN lie beyond the tabulated {:.4g} kN, where the law goes on with its "
          "tangent.</li>\n",
          where, largest / 1e3, tabulated / 1e3);
  };
  for (const auto& ring : result.rings) {
    if (!ring.response) continue;
    const auto& f = ring.response->figures;
    std::string how = "marched for the given time";
    if (f.periodic)
      how = f.confirmed ? fmt::format(
                              "solved directly ({} Newton iterations; half the samples change a force by {:.1e} of "
                              "the mean) and confirmed by time integration over one window",
                              f.periodic->newton_iterations, f.periodic->sampling_difference)
            : f.total_cycles == 0   ? "solved directly"
            : f.periodic->converged ? "marched: the direct solution was not confirmed"
                                    : "marched: the direct solution failed (" + f.periodic->trouble + ")";
    list += fmt::format("<li>{}: {}.{}</li>\n", escape(ring.name), escape(how),
                        f.integrator ? " Integrator: " + escape(f.integrator->reason) : "");
    beyond(escape(ring.name) + ", sun meshes", result.sun_mesh, f, f.sun_planet);
    beyond(escape(ring.name) + ", ring meshes", ring.mesh, f, f.ring_planet);
  }
  return "<ul>" + list + "</ul>\n";
}

}  // namespace

std::string model_section(const RunResult& result) { return model_section(result.plan); }
std::string inputs_section(const RunResult& result) { return inputs_section(result.plan); }

std::string model_section(const Plan& plan) {
  std::string text = "<h2 id=\"model\">What was modelled, and why</h2>\n";
  HtmlTable meshes{.head = {"mesh", "model", "why", "positions", "why so many"}, .rows = {}};
  for (const auto& m : plan.meshes) {
    meshes.rows.push_back({escape(m.label()), m.fidelity, escape(m.reason),
                           m.computed() ? fmt::format("{} × {}", m.problem->phases, m.positions) : "–",
                           escape(m.repeats)});
  }
  text += html(meshes);
  if (!plan.dofs.empty()) {
    HtmlTable dofs{.head = {"degree of freedom of the lumped model", "", "why"}, .rows = {}};
    for (const auto& f : plan.dofs)
      dofs.rows.push_back({escape(f.name), f.kept ? "kept" : "dropped", escape(f.reason)});
    text += html(dofs);
  }
  text += "<ul>";
  for (const auto& remark : plan.remarks) text += "<li>" + escape(remark) + "</li>";
  return text + "</ul>\n";
}

std::string inputs_section(const Plan& plan) {
  std::string text = "<h2 id=\"inputs\">Inputs</h2>\n";
  HtmlTable assumed{.head = {"assumed input", "value", "reason"}, .rows = {}};
  std::set<std::string> seen;
  for (const auto& input : plan.inputs) {
    const std::string value = to_text(input.value) + " " + input.unit;
    if (input.assumed.empty() || !seen.insert(input.key + value).second) continue;
    assumed.rows.push_back({"<code>" + escape(input.key) + "</code>", escape(value), escape(input.assumed)});
  }
  if (!assumed.rows.empty()) {
    text += fmt::format(
        "<p><span class=\"tag assumed\">assumed</span> {} inputs are not published and were chosen; the results depend "
        "on them.</p>\n",
        assumed.rows.size());
    text += html(assumed);
  }
  HtmlTable all{.head = {"key", "value", "origin", "meaning"}, .rows = {}};
  for (const auto& input : plan.inputs) {
    std::string origin = to_text(input.origin);
    if (!input.assumed.empty()) origin += " <span class=\"tag assumed\">assumed</span>";
    if (input.origin != Origin::scene && !input.note.empty()) origin += ": " + escape(input.note);
    all.rows.push_back({"<code>" + escape(input.key) + "</code>" +
                            (input.ring.empty() ? "" : " <span class=\"muted\">" + escape(input.ring) + "</span>"),
                        escape(to_text(input.value) + " " + input.unit), origin, escape(input.meaning)});
  }
  for (const auto& q : plan.quantities) {
    all.rows.push_back({"<code>" + escape(q.key) + "</code>", escape(to_text(q.value, 8) + " " + q.unit), "derived",
                        escape(q.meaning)});
  }
  for (const auto& [ring, quantities] : plan.rings) {
    for (const auto& q : quantities) {
      all.rows.push_back({"<code>" + escape(q.key) + "</code> <span class=\"muted\">" + escape(ring) + "</span>",
                          escape(to_text(q.value, 8) + " " + q.unit), "derived", escape(q.meaning)});
    }
  }
  return text + "<details><summary>All inputs with their origin, and what follows from them</summary>" + html(all) +
         "</details>\n";
}

std::string quality_section(const RunResult& result) {
  std::string text = "<h2 id=\"quality\">Checks and cost</h2>\n";
  HtmlTable checks = mesh_check_table();
  if (result.sun_mesh.model.computed()) checks.rows.push_back(mesh_check_row("sun mesh", result.sun_mesh));
  for (const auto& ring : result.rings) {
    if (ring.mesh.model.computed()) checks.rows.push_back(mesh_check_row("ring mesh, " + ring.name, ring.mesh));
  }
  if (!checks.rows.empty()) {
    text +=
        "<p>Invariants of every contact solve, the worst over all positions and loads; relative unless a unit is "
        "given. "
        "Worst cell: scaled Jacobian, 1 for a rectangle, 0 for a collapsed cell.</p>\n" +
        html(checks);
  }
  HtmlTable dynamics{.head = {"dynamics", "steady state", "evaluated window", "integrated", "force balance",
                              "energy balance", "steps"},
                     .rows = {},
                     .css_class = "numbers"};
  for (const auto& ring : result.rings) {
    if (!ring.response) continue;
    const auto& f = ring.response->figures;
    const std::string steady = f.steady ? "reached" : "not reached";
    dynamics.rows.push_back(
        {escape(ring.name), steady + (f.steady_difference ? fmt::format(" ({:.1e})", *f.steady_difference) : ""),
         fmt::format("{} mesh cycles{}", f.window_cycles, f.whole_period ? "" : ", less than an error period"),
         fmt::format("{} mesh cycles", f.total_cycles), small(f.force_balance_relative), small(f.energy.relative),
         fmt::format("{}", f.statistics.steps)});
  }
  if (!dynamics.rows.empty()) text += html(dynamics) + solution_notes(result);
  return text + predicted_and_actual_html(result) + cost_html(result.timings, result.peak_memory_MB);
}

}  // namespace annulus::app
