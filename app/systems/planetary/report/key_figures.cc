#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/comparison.h"
#include "app/systems/planetary/report/stage_report_parts.h"

namespace annulus::app {

namespace {

std::string estimate_text(const Estimate& e, double scale) {
  return measured(e.value * scale, e.error_relative * e.value * scale);
}
std::string figure_text(const Figure& f) { return measured(f.value, f.error); }

Text outcome_tag(Verdict::Outcome outcome) {
  if (outcome == Verdict::Outcome::agrees) return tag(Text::Look::agrees, "agrees");
  if (outcome == Verdict::Outcome::disagrees) return tag(Text::Look::disagrees, "does not agree");
  return tag(Text::Look::undecided, "not decided");
}

std::vector<Verdict> verdicts(const RunResult& result) {
  if (!result.reference) return {};
  return compare(*result.reference, result);
}

/// A row of the key figures: one cell per ring.
template <class Cell>
void add_row(PageTable& table, const Text& label, const RunResult& result, Cell cell) {
  std::vector<Text> row = {label};
  for (const auto& ring : result.rings) row.emplace_back(cell(ring));
  table.rows.push_back(std::move(row));
}

/// What the positions may tell beyond the transmission error: label and column.
std::vector<std::pair<Text, std::string>> peak_rows(bool sun) {
  std::vector<std::pair<Text, std::string>> rows = {
      {"face load factor K" + subscript("Hβ") + ", largest", "face_load_factor"}};
  for (const std::string body : {"planet", sun ? "sun" : "ring"}) {
    rows.emplace_back("root stress of the " + body + ", tension, largest, MPa", body + "_root_tension_MPa");
    rows.emplace_back("root stress of the " + body + ", von Mises, largest, MPa", body + "_root_von_mises_MPa");
  }
  if (!sun) rows.emplace_back("rim stress of the ring, von Mises, largest, MPa", "ring_rim_von_mises_MPa");
  return rows;
}

void add_mesh_rows(PageTable& table, const RunResult& result, bool sun) {
  const auto mesh = [&](const RingResult& ring) -> const MeshResult& { return sun ? result.sun_mesh : ring.mesh; };
  table.rows.push_back({sun ? "Sun mesh (the same for all rings)" : "Ring mesh"});
  add_row(table, "model", result, [&](const auto& r) { return mesh(r).model.fidelity; });
  add_row(table, "contact ratio", result, [&](const auto& r) { return fmt::format("{:.4f}", mesh(r).contact_ratio); });
  add_row(table, "mean stiffness, secant, N/µm", result,
          [&](const auto& r) { return estimate_text(mesh(r).mean_stiffness(), 1e-6); });
  add_row(table, "transmission error, mean, µm", result,
          [&](const auto& r) { return estimate_text(mesh(r).lte_mean(), 1e6); });
  add_row(table, "transmission error, peak to peak, µm", result,
          [&](const auto& r) { return estimate_text(mesh(r).lte_peak_to_peak(), 1e6); });
  for (const auto& [label, column_of_row] : peak_rows(sun)) {
    const auto& column = column_of_row;  // bindings cannot be captured everywhere
    const auto there = [&](const RingResult& r) { return mesh(r).peak(column).has_value(); };
    if (std::none_of(result.rings.begin(), result.rings.end(), there)) continue;
    add_row(table, label, result, [&](const auto& r) {
      const auto peak = mesh(r).peak(column);
      return peak ? to_text(peak->value, 4) : std::string("–");
    });
  }
}

void add_dynamic_rows(PageTable& table, const RunResult& result, bool sun) {
  const auto kind = [&](const RingResult& ring) -> const dynamics::MeshKindResult& {
    return sun ? ring.response->figures.sun_planet : ring.response->figures.ring_planet;
  };
  const auto dynamic = [&](auto cell) {
    return [cell, &kind](const RingResult& ring) { return ring.response ? cell(kind(ring)) : std::string("–"); };
  };
  table.rows.push_back(
      {sun ? "Load sharing and dynamic factor, sun meshes" : "Load sharing and dynamic factor, ring meshes"});
  add_row(table, "load sharing, averaged over a mesh cycle", result,
          dynamic([](const auto& k) { return figure_text(k.load_sharing.averaged); }));
  add_row(table, "load sharing, instantaneous", result,
          dynamic([](const auto& k) { return figure_text(k.load_sharing.instantaneous); }));
  add_row(table, "load sharing, quasi-static", result,
          dynamic([](const auto& k) { return figure_text(k.load_sharing.quasi_static); }));
  for (std::size_t n = 0; n < static_cast<std::size_t>(result.scene.stage.planets); ++n) {
    add_row(table, fmt::format("dynamic factor, planet {}", n + 1), result,
            dynamic([n](const auto& k) { return figure_text(k.branches[n].dynamic_factor_max); }));
  }
  add_row(table, "time without contact, worst planet", result, dynamic([](const auto& k) {
            double loss = 0;
            for (const auto& b : k.branches) loss = std::max(loss, b.contact_loss);
            return loss > 0 ? fmt::format("{:.2g} %", 100 * loss) : std::string("none");
          }));
}

}  // namespace

Blocks stage_verdict(const RunResult& result) {
  const auto quantities = ring_quantities(result);
  Blocks blocks = answer_sentences(quantities);
  const auto all = verdicts(result);
  if (!all.empty()) {
    const auto count = [&](Verdict::Outcome o) {
      return std::count_if(all.begin(), all.end(), [&](const Verdict& v) { return v.outcome == o; });
    };
    blocks += paragraph(
        phrase("Published statements compared with these numbers: {} agree, {} do not, {} cannot be decided ({}).",
               count(Verdict::Outcome::agrees), count(Verdict::Outcome::disagrees), count(Verdict::Outcome::undecided),
               link("details", "comparison")));
  }
  std::vector<Text> unsteady;
  std::vector<std::string> names;
  for (const auto& ring : result.rings) {
    names.push_back(ring.name);
    if (ring.response && !ring.response->figures.steady) unsteady.push_back(bold(ring.name));
  }
  if (!unsteady.empty())
    blocks += paragraph(
        phrase("No periodic steady state was reached with {}; the figures hold for the evaluated window only.",
               enumerated(unsteady)));
  return verdict_box(blocks) + answer_picture(quantities, names);
}

Section key_figures_section(const RunResult& result) {
  PageTable table{.head = {""}, .style = PageTable::Style::numbers};
  for (const auto& ring : result.rings) table.head.emplace_back(ring.name);
  add_mesh_rows(table, result, false);
  add_mesh_rows(table, result, true);
  if (!rings_with_response(result).empty()) {
    add_dynamic_rows(table, result, true);
    add_dynamic_rows(table, result, false);
  }
  return {"figures", "Key figures",
          paragraph(phrase(
              "At the nominal mean mesh force of {} kN. ± is the estimated numerical error: of the discretisation for "
              "stiffness and transmission error; for load sharing and dynamic factor of the solution in time, of the "
              "stiffness and of the interpolation between the positions together ({}). It does not contain the "
              "uncertainty of the inputs.",
              to_text(result.geometry.operating_point.mean_mesh_force / 1e3, 5), link("parts", "error-bars"))) +
              table};
}

Section comparison_section(const RunResult& result) {
  Section section{"comparison", "Comparison with the source"};
  if (!result.reference) return section;
  PageTable table{.head = {"published statement", "published", "computed", "", "why"}};
  for (const auto& v : verdicts(result))
    table.rows.push_back({v.statement + (v.where.empty() ? Text() : " " + muted("(" + v.where + ")")), v.published,
                          muted(v.quantity) + line_break() + v.computed, outcome_tag(v.outcome), v.why});
  PageTable paths{.head = {"planet path, centres held", "stiffness, N/µm", "compliance of the ring mesh",
                           "of the sun mesh", "of the planet bearing"},
                  .style = PageTable::Style::numbers};
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto p = path_stiffness(result, i);
    paths.rows.push_back({result.rings[i].name, to_text(p.total / 1e6, 4), fmt::format("{:.1f} %", 100 * p.ring_part),
                          fmt::format("{:.1f} %", 100 * p.sun_part), fmt::format("{:.1f} %", 100 * p.bearing_part)});
  }
  section.blocks =
      source_blocks(*result.reference) + table +
      paragraph("What a ring can do to load sharing is bounded by its part in the compliance of a planet's path:") +
      paths;
  return section;
}

}  // namespace annulus::app
