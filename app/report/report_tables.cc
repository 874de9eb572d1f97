#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/report/interactive_plot.h"
#include "app/report/report_parts.h"
#include "app/stage/comparison.h"

namespace annulus::app {

namespace {

std::string estimate_text(const Estimate& e, double scale) {
  return measured(e.value * scale, e.error_relative * e.value * scale);
}
std::string figure_text(const Figure& f) { return measured(f.value, f.error); }

/// "a", "a and b", "a, b and c"
std::string enumerate(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  }
  return text;
}

const RingQuantity* quantity(const std::vector<RingQuantity>& list, const std::string& key) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const RingQuantity& q) { return q.key == key; });
  return found == list.end() ? nullptr : &*found;
}

std::vector<Measured> sorted(const RingQuantity& q) {
  auto rings = q.rings;
  std::stable_sort(rings.begin(), rings.end(), [](const Measured& a, const Measured& b) { return a.value > b.value; });
  return rings;
}

std::string stiffness_sentence(const RingQuantity& q) {
  const auto rings = sorted(q);
  if (rings.size() < 2) {
    return fmt::format("<p>The ring mesh of <b>{}</b> has a mean stiffness of {} N/µm.</p>\n",
                       escape(rings.front().ring), measured(rings.front().value / 1e6, rings.front().error / 1e6));
  }
  std::vector<std::string> others;
  for (std::size_t i = 1; i < rings.size(); ++i) {
    const std::string name = "<b>" + escape(rings[i].ring) + "</b> is ";
    others.push_back(same(rings[i], rings.front())
                         ? name + "as stiff"
                         : name + fmt::format("{:.1f} % softer", 100 * (1 - rings[i].value / rings.front().value)));
  }
  return fmt::format("<p>Stiffness of the ring mesh: <b>{}</b> is the stiffest ({} N/µm); {}.</p>\n",
                     escape(rings.front().ring), measured(rings.front().value / 1e6, rings.front().error / 1e6),
                     enumerate(others));
}

std::string sharing_sentence(const RingQuantity& q) {
  const auto rings = sorted(q);
  std::string text = "<p>Load sharing (" + q.name.substr(q.name.find(',') + 2) + "): ";
  if (rings.size() == 1) return text + fmt::format("{}.</p>\n", measured(rings.front().value, rings.front().error));
  text += fmt::format(
      "the most loaded planet carries {:.1f} % more than its share with <b>{}</b> and {:.1f} % with <b>{}</b>",
      100 * (rings.back().value - 1), escape(rings.back().ring), 100 * (rings.front().value - 1),
      escape(rings.front().ring));
  if (!std::isfinite(rings.front().error + rings.back().error)) return text + "; the error is not known.</p>\n";
  return text +
         (told_apart(rings.front(), rings.back()) ? ".</p>\n" : "; the difference is within the error bars.</p>\n");
}

std::string factor_sentence(const RingQuantity& q) {
  const auto rings = sorted(q);
  std::vector<std::string> words;
  words.reserve(rings.size());
  for (const auto& r : rings)
    words.push_back(measured(r.value, r.error) + (rings.size() > 1 ? " with <b>" + escape(r.ring) + "</b>" : ""));
  return fmt::format("<p>Dynamic factor ({}): {}.</p>\n", q.name.substr(q.name.find(',') + 2), enumerate(words));
}

std::string outcome_tag(Verdict::Outcome outcome) {
  switch (outcome) {
    case Verdict::Outcome::agrees:
      return "<span class=\"tag agrees\">agrees</span>";
    case Verdict::Outcome::disagrees:
      return "<span class=\"tag disagrees\">does not agree</span>";
    case Verdict::Outcome::undecided:
      break;
  }
  return "<span class=\"tag undecided\">not decided</span>";
}

std::vector<Verdict> verdicts(const RunResult& result) {
  if (!result.reference) return {};
  return compare(*result.reference, result);
}

/// A row of the key figures: one cell per ring.
template <class Cell>
void add_row(HtmlTable& table, const std::string& label, const RunResult& result, Cell cell) {
  std::vector<std::string> row = {label};
  for (const auto& ring : result.rings) row.push_back(cell(ring));
  table.rows.push_back(std::move(row));
}

/// What the positions may tell beyond the transmission error: label and column.
std::vector<std::pair<std::string, std::string>> peak_rows(bool sun) {
  std::vector<std::pair<std::string, std::string>> rows = {
      {"face load factor K<sub>Hβ</sub>, largest", "face_load_factor"}};
  for (const std::string body : {"planet", sun ? "sun" : "ring"}) {
    rows.emplace_back("root stress of the " + body + ", tension, largest, MPa", body + "_root_tension_MPa");
    rows.emplace_back("root stress of the " + body + ", von Mises, largest, MPa", body + "_root_von_mises_MPa");
  }
  if (!sun) rows.emplace_back("rim stress of the ring, von Mises, largest, MPa", "ring_rim_von_mises_MPa");
  return rows;
}

void add_mesh_rows(HtmlTable& table, const RunResult& result, bool sun) {
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

void add_dynamic_rows(HtmlTable& table, const RunResult& result, bool sun) {
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

namespace {

std::vector<std::string> names_of(const RunResult& result) {
  std::vector<std::string> names;
  for (const auto& ring : result.rings) names.push_back(ring.name);
  return names;
}

}  // namespace

std::string answer_sentences(const std::vector<RingQuantity>& quantities) {
  std::string text;
  if (const auto* q = quantity(quantities, "ring_stiffness")) text += stiffness_sentence(*q);
  if (const auto* q = quantity(quantities, "load_sharing")) text += sharing_sentence(*q);
  if (const auto* q = quantity(quantities, "dynamic_factor")) text += factor_sentence(*q);
  return text;
}

std::string answer_picture(const std::vector<RingQuantity>& quantities, const std::vector<std::string>& names) {
  constexpr double letter = 6;
  double longest = 0;
  for (const auto& name : names) longest = std::max(longest, letter * static_cast<double>(name.size() + 18));
  const int label_width = std::max(220, static_cast<int>(longest));
  BarChart chart{.title = "Above the ideal, %",
                 .x_label = "%",
                 .width = 420 + label_width,
                 .label_width = label_width,
                 .row_height = 22};
  for (const auto& [key, name] : {std::pair{"load_sharing", "load sharing"}, {"dynamic_factor", "dynamic factor"}}) {
    const auto* q = quantity(quantities, key);
    if (q == nullptr) continue;
    for (const auto& m : q->rings) {
      if (!std::isfinite(m.value)) continue;
      chart.bars.push_back(
          {.label = std::string(name) + ", " + m.ring,
           .value = 100 * (m.value - 1),
           .colour = static_cast<std::size_t>(std::find(names.begin(), names.end(), m.ring) - names.begin()),
           .note = fmt::format("{:.3g} %", 100 * (m.value - 1)),
           .error = 100 * m.error});
    }
  }
  if (chart.bars.empty()) return "";
  return figure({plot_html(chart)}, "",
                "Excess of the most loaded planet over its share, and of the largest mesh force over its mean; "
                "whiskers: estimated numerical error.");
}

std::string verdict_section(const RunResult& result) {
  const auto quantities = ring_quantities(result);
  std::string text = "<div class=\"verdict\">\n" + answer_sentences(quantities);
  const auto all = verdicts(result);
  if (!all.empty()) {
    const auto count = [&](Verdict::Outcome o) {
      return std::count_if(all.begin(), all.end(), [&](const Verdict& v) { return v.outcome == o; });
    };
    text += fmt::format(
        "<p>Published statements held against these numbers: {} agree, {} do not, {} cannot be decided (<a "
        "href=\"#comparison\">details</a>).</p>\n",
        count(Verdict::Outcome::agrees), count(Verdict::Outcome::disagrees), count(Verdict::Outcome::undecided));
  }
  std::vector<std::string> unsteady;
  for (const auto& ring : result.rings) {
    if (ring.response && !ring.response->figures.steady) unsteady.push_back("<b>" + escape(ring.name) + "</b>");
  }
  if (!unsteady.empty())
    text += "<p>No periodic steady state was reached with " + enumerate(unsteady) +
            "; the figures hold for the evaluated window only.</p>\n";
  return text + "</div>\n" + answer_picture(quantities, names_of(result));
}

std::string key_figures_section(const RunResult& result) {
  HtmlTable table{.head = {""}, .rows = {}, .css_class = "numbers"};
  bool dynamic = false;
  for (const auto& ring : result.rings) {
    table.head.push_back(escape(ring.name));
    dynamic = dynamic || ring.response;
  }
  add_mesh_rows(table, result, false);
  add_mesh_rows(table, result, true);
  if (dynamic) {
    add_dynamic_rows(table, result, true);
    add_dynamic_rows(table, result, false);
  }
  return "<h2 id=\"figures\">Key figures</h2>\n<p>At the nominal mean mesh force of " +
         to_text(result.geometry.operating_point.mean_mesh_force / 1e3, 5) +
         " kN. ± is the estimated numerical error: of the discretisation for stiffness and transmission error; for "
         "load sharing and dynamic factor of the solution in time, of the stiffness and of the interpolation between "
         "the positions together (<a href=\"#error-bars\">parts</a>). It does not contain the uncertainty of the "
         "inputs.</p>\n" +
         html(table);
}

std::string comparison_section(const RunResult& result) {
  if (!result.reference) return {};
  const auto& reference = *result.reference;
  std::string text = "<h2 id=\"comparison\">Comparison with the source</h2>\n<p>" + escape(reference.source);
  if (!reference.doi.empty()) text += ", doi:" + escape(reference.doi);
  text += ".</p>\n<p>" + escape(reference.note) + "</p>\n";
  HtmlTable table{.head = {"published statement", "published", "computed", "", "why"}, .rows = {}};
  for (const auto& v : verdicts(result)) {
    table.rows.push_back(
        {escape(v.statement) + (v.where.empty() ? "" : " <span class=\"muted\">(" + escape(v.where) + ")</span>"),
         escape(v.published), "<span class=\"muted\">" + escape(v.quantity) + "</span><br>" + escape(v.computed),
         outcome_tag(v.outcome), escape(v.why)});
  }
  text += html(table);
  HtmlTable paths{.head = {"planet path, centres held", "stiffness, N/µm", "compliance of the ring mesh",
                           "of the sun mesh", "of the planet bearing"},
                  .rows = {},
                  .css_class = "numbers"};
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto p = path_stiffness(result, i);
    paths.rows.push_back({escape(result.rings[i].name), to_text(p.total / 1e6, 4),
                          fmt::format("{:.1f} %", 100 * p.ring_part), fmt::format("{:.1f} %", 100 * p.sun_part),
                          fmt::format("{:.1f} %", 100 * p.bearing_part)});
  }
  return text +
         "<p>What a ring can do to load sharing is bounded by its part in the compliance of a planet's path:</p>\n" +
         html(paths);
}

}  // namespace annulus::app
