#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/model/cost_actual.h"
#include "app/model/found_motions.h"
#include "app/model/run_warnings.h"
#include "app/results/content_id.h"
#include "app/sections/report_parts.h"
#include "app/sections/shafts.h"

namespace annulus::app {

namespace {

std::string solution_text(const dynamics::SteadyOutcome& found) {
  std::string text = "time integration";
  if (found.periodic) {
    const auto& periodic = *found.periodic;
    const std::string method =
        periodic.method == dynamics::PeriodicMethod::piecewise         ? "exact solution between jumps of the stiffness"
        : periodic.method == dynamics::PeriodicMethod::two_frequencies ? "harmonic balance with two base frequencies"
                                                                       : "harmonic balance";
    if (!periodic.converged)
      text += ": the " + method + " failed (" + periodic.trouble + ")";
    else if (!found.confirmed && found.total_cycles > 0)
      text += ": the " + method + " was not confirmed";
    else
      text = fmt::format("{} ({} Newton iterations; other samplings change a force by {:.1e} of the mean){}", method,
                         periodic.newton_iterations, periodic.sampling_difference,
                         !found.confirmed ? ""
                         : periodic.longer_angle > 0
                             ? fmt::format(", confirmed by time integration over {} mesh cycles",
                                           std::min(found.window_cycles, 2 * periodic.longer_angle))
                             : ", confirmed by time integration over one window");
  }
  return found.integrator ? text + ". Integrator: " + found.integrator->reason : text;
}

Section model_section(const Plan& plan) {
  PageTable meshes{.head = {"mesh", "model", "reason", "positions", "reason for the positions"}};
  for (const auto& m : plan.meshes)
    meshes.rows.push_back({m.label(), m.fidelity, m.reason,
                           m.computed() ? fmt::format("{} × {}", m.problem->phases, m.positions) : "–", m.repeats});
  Blocks blocks = meshes;
  if (!plan.dofs.empty()) {
    PageTable dofs{.head = {"degree of freedom", "", "reason"}};
    for (const auto& f : plan.dofs) dofs.rows.push_back({f.name, f.retained ? "retained" : "dropped", f.reason});
    blocks += dofs;
  }
  blocks += List{{plan.remarks.begin(), plan.remarks.end()}};
  return {"model", "Model", blocks, "Model, with reasons"};
}

Section inputs_section(const SystemRun& run) {
  const Plan& plan = run.plan;
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
    blocks += paragraph(phrase("{} {} inputs are not published; their values were chosen. The results depend on them.",
                               assumed_tag, assumed.rows.size())) +
              assumed;
  PageTable all{.head = {"key", "value", "origin", "meaning"}};
  const auto key_text = [](const std::string& key, const std::string& variant) {
    return code(key) + (variant.empty() ? Text() : " " + muted(variant));
  };
  for (const auto& input : plan.inputs) {
    Text origin = to_text(input.origin);
    if (!input.assumed.empty()) origin += " " + assumed_tag;
    if (input.origin != Origin::scene && !input.note.empty()) origin += ": " + input.note;
    all.rows.push_back(
        {key_text(input.key, input.variant), to_text(input.value) + " " + input.unit, origin, input.meaning});
  }
  const auto add_derived = [&](const auto& quantities, const std::string& variant) {
    for (const auto& q : quantities)
      all.rows.push_back({key_text(q.key, variant), to_text(q.value, 8) + " " + q.unit, "derived", q.meaning});
  };
  add_derived(plan.quantities, "");
  for (const auto& [variant, quantities] : plan.variants) add_derived(quantities, variant);
  Blocks record = Lines{run.scene.text};
  if (!run.command.empty()) record = paragraph("Made by " + code(run.command) + ".") + record;
  return {"inputs", "Inputs",
          blocks + details("All inputs with their origin, and derived quantities", all) + details("The scene", record)};
}

Blocks cost_blocks(const SystemRun& run) {
  const auto& done = run.cost;
  Blocks blocks;
  if (!done.empty()) {
    PageTable steps{.head = {"step", "predicted time", "actual time", "predicted peak memory"},
                    .style = PageTable::Style::numbers};
    for (const auto& step : done.steps)
      steps.rows.push_back({step.label, duration_text(step.predicted.seconds), duration_text(step.actual->seconds()),
                            std::isnan(step.predicted.peak_MB) ? "–" : memory_text(step.predicted.peak_MB)});
    blocks += paragraph("Cost of the steps that were not reused, as predicted before the run and as measured: " +
                        cost_sentence(run) + ".") +
              steps;
  }
  if (run.timings.empty())
    return blocks + Paragraph{fmt::format("annulus {}. Workers computed the parts of the studies; their times are not "
                                          "stated.",
                                          version()),
                              Paragraph::Tone::muted};
  PageTable times{.head = {"stage", "wall time, s"}, .style = PageTable::Style::numbers};
  for (const auto& [stage, seconds] : run.timings) times.rows.push_back({stage, fmt::format("{:.2f}", seconds)});
  return blocks + times +
         Paragraph{fmt::format("Peak memory {:.0f} MB. annulus {}. Unchanged results of an earlier run were read from "
                               "the cache and cost no time here.",
                               run.peak_memory_MB, version()),
                   Paragraph::Tone::muted};
}

Section warnings_section(const SystemRun& run) {
  const auto warnings = run_warnings(run);
  List list, notes;
  for (const auto& w : warnings) {
    const auto look = w.severity == Severity::severe    ? Text::Look::disagrees
                      : w.severity == Severity::warning ? Text::Look::assumed
                                                        : Text::Look::undecided;
    (w.severity == Severity::note ? notes : list)
        .items.push_back(tag(look, to_text(w.severity)) + " " + (w.where.empty() ? Text() : bold(w.where) + ": ") +
                         w.text + ".");
  }
  Blocks blocks;
  if (!list.items.empty()) blocks += list;
  if (!notes.items.empty()) blocks += details(fmt::format("Notes ({})", notes.items.size()), notes);
  return {"warnings", "Warnings", blocks};
}

Section pictures_section(const NamedMeshes& meshes) {
  Pictures pictures{.layout = Pictures::Layout::meshes};
  for (const auto& [title, mesh] : meshes) {
    if (mesh->picture.empty()) continue;
    auto& picture = pictures.list.emplace_back(
        Drawing{mesh->picture}, title,
        mesh->model.fidelity.ends_with("solid")
            ? std::string("Orange: fixed faces. Blue: driven flanks.")
            : fmt::format("Blue: {}. Orange: fixed surface. Circle: pitch point.", mesh->model.pinion_body));
    picture.variant = mesh->model.variant;
  }
  return {"meshes", "Meshes", pictures.list.empty() ? Blocks() : Blocks(pictures)};
}

Section fields_section(const NamedMeshes& meshes) {
  Pictures figure{.layout = Pictures::Layout::fields};
  for (const auto& [title, mesh] : meshes)
    for (const auto& view : mesh->fields) figure.list.emplace_back(view, title).variant = mesh->model.variant;
  Section section{"fields", "Deformation and stress"};
  if (figure.list.empty()) return section;
  std::vector<DeformedMesh*> views;
  for (auto& picture : figure.list) views.push_back(&std::get<DeformedMesh>(picture.drawn));
  share_colours(views);
  section.blocks =
      paragraph(
          "Both gears in mesh, with this mesh alone at the nominal load. The position is that with the "
          "largest root stress of the second gear. Displacements are exaggerated. Displacements of a gear "
          "on a hub are relative to the hub. A planet on rollers is loaded by its other mesh as well, and "
          "is shown without its motion in the bearing. Grey: outline without load. All pictures have one colour "
          "scale. The " +
          code("_field.vtm") + " files contain more teeth, for ParaView.") +
      figure;
  return section;
}

}  // namespace

Blocks source_blocks(const Reference& reference) {
  return paragraph(reference.source + (reference.doi.empty() ? "" : ", doi:" + reference.doi) + ".") +
         paragraph(reference.note);
}

Blocks mesh_checks(const NamedMeshes& meshes) {
  PageTable table{.head = {"mesh", "Σ force × lever arm – torque", "work – strain energy", "LTE(1) – LTE(0)",
                           "reciprocity", "largest penetration, m", "largest error estimate", "worst cell", "unknowns"},
                  .style = PageTable::Style::numbers};
  for (const auto& [label, mesh] : meshes) {
    if (!mesh->model.computed()) continue;
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
             "Checks of every contact solution: worst value over all positions and loads, relative unless a unit is "
             "given. Worst cell: smallest scaled Jacobian (1 for a rectangle, 0 for a collapsed cell).") +
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
  if (table.rows.empty()) return {};
  Blocks blocks = table;
  PageTable motions{.head = {"response", "stable motion", "largest mesh force, kN", "time without contact, %",
                             "share of the starts, %", "results"}};
  for (const auto& [name, found, force_balance] : responses)
    for (const auto& m : found->motions.list)
      motions.rows.push_back({name, period_text(m), fmt::format("{:.4g}", m.largest_force / 1e3),
                              fmt::format("{:.2g}", 100 * m.contact_loss),
                              fmt::format("{:.0f}", 100.0 * m.starts / found->motions.starts), m.taken ? "shown" : ""});
  if (!motions.rows.empty())
    blocks += paragraph(
                  "Stable motions that were found from random initial conditions, because backlash is within reach "
                  "of the vibration. The results are those of one of them.") +
              motions;
  return blocks;
}

Page run_page(const SystemRun& run, const RunPage& page) {
  const auto& scene = run.scene;
  Page made{.title = scene.title,
            .sub = phrase("annulus {} · scene {} · {}", version(), code(scene.file.filename().string()), page.words),
            .summary = page.answer};
  if (!scene.project.empty()) made.sub = bold(scene.project) + " · " + made.sub;
  for (const auto* more : {&scene.author, &run.date})
    if (!more->empty()) made.sub += " · " + *more;
  for (const auto& sections : std::initializer_list<std::vector<Section>>{
           {warnings_section(run)},
           page.results,
           {spread_section(run.studies)},
           page.sections,
           {shafts_section(run)},
           study_sections(scene, run.studies),
           {fields_section(page.meshes)},
           page.geometry,
           {pictures_section(page.meshes),
            model_section(run.plan),
            inputs_section(run),
            {"quality", "Checks and cost", mesh_checks(page.meshes) + page.checks + cost_blocks(run)},
            definitions_section(run)}})
    made.sections.insert(made.sections.end(), sections.begin(), sections.end());
  // What decides stands open; the rest is a click away.
  for (auto& section : made.sections) {
    constexpr const char* open[] = {"warnings", "figures", "spread", "tolerances"};
    section.folded = std::find(std::begin(open), std::end(open), section.anchor) == std::end(open);
  }
  for (const auto& variant : run.variants()) made.variants.push_back(variant.name);
  made.variant_word = run.plan.variant_word;
  made.meshes = page.choices;
  made.line_kind = page.line_kind;
  made.lines = page.lines;
  return made;
}

}  // namespace annulus::app
