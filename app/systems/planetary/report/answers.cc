#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/systems/planetary/comparison.h"
#include "app/systems/planetary/report/stage_report_parts.h"

namespace annulus::app {

namespace {

Text outcome_tag(Verdict::Outcome outcome) {
  if (outcome == Verdict::Outcome::agrees) return tag(Text::Look::agrees, "agrees");
  if (outcome == Verdict::Outcome::disagrees) return tag(Text::Look::disagrees, "does not agree");
  return tag(Text::Look::undecided, "not decided");
}

std::vector<Verdict> verdicts(const RunResult& result) {
  if (!result.reference) return {};
  return compare(*result.reference, result);
}

/// K_γ that nearly all assemblies keep, beside what standards tabulate.
Blocks assemblies_sentence(const RunResult& result) {
  std::vector<Text> rings;
  for (const auto& ring : result.rings)
    if (ring.tolerances) {
      const auto p95 = ring.tolerances->figure(&dynamics::SharingQuantiles::p95, ring.tolerances->sharing.nominal());
      rings.push_back(result.rings.size() > 1 ? phrase("{} with {}", measured(p95, 1), bold(ring.name))
                                              : Text(measured(p95, 1)));
    }
  if (rings.empty()) return {};
  const auto tabulated = tabulated_sharing(result.scene.stage.planets);
  const auto standards =
      tabulated ? fmt::format(" Standards tabulate {} for {} planets.", text(*tabulated), tabulated->planets) : "";
  return paragraph(phrase("Within the tolerances, 95 % of the assemblies have a K_γ of at most {} ({}).{}",
                          joined(rings, ", "), link("details", "tolerances"), standards));
}

}  // namespace

Blocks stage_verdict(const RunResult& result) {
  const auto quantities = ring_quantities(result);
  Blocks blocks = answer_sentences(quantities) + assemblies_sentence(result);
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
  std::vector<std::string> names;
  for (const auto& ring : result.rings) names.push_back(ring.name);
  return verdict_box(blocks) + answer_picture(quantities, names);
}

Section comparison_section(const RunResult& result) {
  Section section{"comparison", "Comparison with the source"};
  if (!result.reference) return section;
  PageTable table{.head = {"published statement", "published", "computed", "", "reason"}};
  for (const auto& v : verdicts(result))
    table.rows.push_back({v.statement + (v.where.empty() ? Text() : " " + muted("(" + v.where + ")")), v.published,
                          muted(v.quantity) + line_break() + v.computed, outcome_tag(v.outcome), v.why});
  PageTable paths{.head = {"path of a planet, centres fixed", "stiffness, N/µm", "compliance share of the ring mesh",
                           "of the sun mesh", "of the planet bearing"},
                  .style = PageTable::Style::numbers};
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto p = path_stiffness(result, i);
    auto& row = paths.rows.emplace_back(std::vector<Text>{result.rings[i].name, to_text(p.total / 1e6, 4)});
    for (const double part : {p.ring_part, p.sun_part, p.bearing_part})
      row.emplace_back(fmt::format("{:.1f} %", 100 * part));
  }
  section.blocks =
      source_blocks(*result.reference) + table +
      paragraph("A ring affects load sharing only through its share in the compliance of a planet's path:") + paths;
  return section;
}

}  // namespace annulus::app
