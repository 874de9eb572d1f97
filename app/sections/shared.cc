#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/model/cost_actual.h"
#include "app/results/content_id.h"
#include "app/sections/report_parts.h"

namespace annulus::app {

namespace {

std::string solution_text(const dynamics::SteadyOutcome& found) {
  std::string text = "time integration";
  if (found.periodic) {
    const auto& direct = *found.periodic;
    const std::string method = direct.method == dynamics::PeriodicMethod::piecewise
                                   ? "exact solution between jumps of the stiffness"
                                   : "harmonic balance";
    if (!direct.converged)
      text += ": the " + method + " failed (" + direct.trouble + ")";
    else if (!found.confirmed && found.total_cycles > 0)
      text += ": the " + method + " was not confirmed";
    else
      text = fmt::format("{} ({} Newton iterations; half the samples change a force by {:.1e} of the mean){}", method,
                         direct.newton_iterations, direct.sampling_difference,
                         found.confirmed ? ", confirmed by time integration over one window" : "");
  }
  return found.integrator ? text + ". Integrator: " + found.integrator->reason : text;
}

}  // namespace

std::string measured(double value, double error) {
  if (!std::isfinite(value)) return "not known";
  error = std::abs(error);
  if (!std::isfinite(error) || !(error > 0)) return to_text(value, 5);
  // Two digits of the error and the value to the same decimal, but no more than five digits of the value: beyond them
  // the inputs are not known.
  const auto first_digit = [](double x) { return static_cast<int>(std::floor(std::log10(x))); };
  const int wanted = 1 - first_digit(error);
  const int most = value == 0 ? wanted : 4 - first_digit(std::abs(value));
  const int decimals = std::clamp(std::min(wanted, most), 0, 9);
  const bool hidden = error < 0.5 * std::pow(10.0, -decimals);
  return fmt::format("{:.{}f} ± {}{:.{}f}", value, decimals, hidden ? "<" : "",
                     hidden ? std::pow(10.0, -decimals) : error, decimals);
}

std::string small_text(double x) { return std::isfinite(x) ? fmt::format("{:.1e}", x) : "–"; }

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + ", " + unit;
}

Page scene_page(const Scene& scene, const Text& stage_words, const Blocks& summary,
                const std::vector<std::vector<Section>>& groups) {
  Page page{.title = scene.title,
            .sub = phrase("annulus {} · scene {} · {}", version(), code(scene.file.filename().string()), stage_words),
            .summary = summary};
  for (const auto& sections : groups) page.sections.insert(page.sections.end(), sections.begin(), sections.end());
  return page;
}

Blocks source_blocks(const Reference& reference) {
  return paragraph(reference.source + (reference.doi.empty() ? "" : ", doi:" + reference.doi) + ".") +
         paragraph(reference.note);
}

Section model_section(const Plan& plan) {
  PageTable meshes{.head = {"mesh", "model", "why", "positions", "why so many"}};
  for (const auto& m : plan.meshes)
    meshes.rows.push_back({m.label(), m.fidelity, m.reason,
                           m.computed() ? fmt::format("{} × {}", m.problem->phases, m.positions) : "–", m.repeats});
  Blocks blocks = meshes;
  if (!plan.dofs.empty()) {
    PageTable dofs{.head = {"degree of freedom of the lumped model", "", "why"}};
    for (const auto& f : plan.dofs) dofs.rows.push_back({f.name, f.kept ? "kept" : "dropped", f.reason});
    blocks += dofs;
  }
  blocks += List{{plan.remarks.begin(), plan.remarks.end()}};
  return {"model", "What was modelled", blocks, "What was modelled, and why"};
}

Section inputs_section(const Plan& plan) {
  Blocks blocks;
  const Text assumed_tag = tag(Text::Look::assumed, "assumed");
  PageTable assumed{.head = {"assumed input", "value", "reason"}};
  std::set<std::string> seen;
  for (const auto& input : plan.inputs) {
    const std::string value = to_text(input.value) + " " + input.unit;
    if (input.assumed.empty() || !seen.insert(input.key + value).second) continue;
    assumed.rows.push_back({code(input.key), value, input.assumed});
  }
  if (!assumed.rows.empty())
    blocks += paragraph(phrase("{} {} inputs are not published and were chosen; the results depend on them.",
                               assumed_tag, assumed.rows.size())) +
              assumed;
  PageTable all{.head = {"key", "value", "origin", "meaning"}};
  const auto key_text = [](const std::string& key, const std::string& ring) {
    return code(key) + (ring.empty() ? Text() : " " + muted(ring));
  };
  for (const auto& input : plan.inputs) {
    Text origin = to_text(input.origin);
    if (!input.assumed.empty()) origin += " " + assumed_tag;
    if (input.origin != Origin::scene && !input.note.empty()) origin += ": " + input.note;
    all.rows.push_back(
        {key_text(input.key, input.ring), to_text(input.value) + " " + input.unit, origin, input.meaning});
  }
  const auto add_derived = [&](const auto& quantities, const std::string& ring) {
    for (const auto& q : quantities)
      all.rows.push_back({key_text(q.key, ring), to_text(q.value, 8) + " " + q.unit, "derived", q.meaning});
  };
  add_derived(plan.quantities, "");
  for (const auto& [ring, quantities] : plan.rings) add_derived(quantities, ring);
  return {"inputs", "Inputs", blocks + details("All inputs with their origin, and what follows from them", all)};
}

Blocks mesh_checks(const std::vector<std::pair<std::string, const MeshResult*>>& meshes) {
  PageTable table{.head = {"mesh", "Σ force × lever arm – torque", "work – strain energy", "LTE(1) – LTE(0)",
                           "reciprocity", "largest penetration, m", "largest error estimate", "worst cell", "unknowns"},
                  .style = PageTable::Style::numbers};
  for (const auto& [label, mesh] : meshes) {
    if (mesh == nullptr || !mesh->model.computed()) continue;
    std::vector<Text> row = {label};
    for (const char* fact : {"force_balance_relative", "energy_balance_relative", "closure_relative",
                             "reciprocity_relative", "max_penetration_m", "worst_error_relative"})
      row.emplace_back(small_text(mesh->fact(fact)));
    const double cell = mesh->fact("worst_scaled_jacobian"), unknowns = mesh->fact("unknowns");
    row.emplace_back(std::isfinite(cell) ? fmt::format("{:.2f}", cell) : "–");
    row.emplace_back(std::isfinite(unknowns) ? fmt::format("{:.0f}", unknowns) : "–");
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) return {};
  return paragraph(
             "Invariants of every contact solve, the worst over all positions and loads; relative unless a unit is "
             "given. Worst cell: scaled Jacobian, 1 for a rectangle, 0 for a collapsed cell.") +
         table;
}

Blocks solution_checks(const std::vector<NamedOutcome>& responses) {
  PageTable table{.head = {"response", "found by", "steady state", "evaluated window", "integrated", "force balance",
                           "energy balance", "steps"}};
  for (const auto& [name, found, force_balance] : responses)
    table.rows.push_back({name, solution_text(*found),
                          std::string(found->steady ? "reached" : "not reached") +
                              (found->steady_difference ? fmt::format(" ({:.1e})", *found->steady_difference) : ""),
                          fmt::format("{} mesh cycles{}", found->window_cycles,
                                      found->whole_period ? "" : ", less than an error period"),
                          fmt::format("{} mesh cycles", found->total_cycles), small_text(force_balance),
                          small_text(found->energy.relative), fmt::format("{}", found->statistics.steps)});
  return table.rows.empty() ? Blocks() : Blocks(table);
}

Blocks cost_blocks(const SystemRun& run) {
  const auto& done = run.cost;
  Blocks blocks;
  if (!done.empty()) {
    PageTable steps{.head = {"step", "predicted time", "actual time", "predicted peak memory"},
                    .style = PageTable::Style::numbers};
    for (const auto& step : done.steps)
      steps.rows.push_back({step.label, duration_text(step.predicted.seconds), duration_text(step.actual->seconds()),
                            step.kind == CostKind::coupling ? "–" : memory_text(step.predicted.peak_MB)});
    blocks += paragraph("Cost of the steps that were not reused, as predicted before the run and as measured: " +
                        cost_sentence(run) + ".") +
              steps;
  }
  PageTable times{.head = {"stage", "wall time, s"}, .style = PageTable::Style::numbers};
  for (const auto& [stage, seconds] : run.timings) times.rows.push_back({stage, fmt::format("{:.2f}", seconds)});
  return blocks + times +
         Paragraph{fmt::format("Peak memory {:.0f} MB. annulus {}. Results that were unchanged since an earlier run "
                               "were read back and cost no time here.",
                               run.peak_memory_MB, version()),
                   Paragraph::Tone::muted};
}

std::vector<Section> study_sections(const Scene& scene, const StudyResults& studies) {
  return {spread_section(studies), sweeps_section(scene, studies), grids_section(scene, studies),
          sensitivity_section(studies), optimise_section(studies)};
}

}  // namespace annulus::app
