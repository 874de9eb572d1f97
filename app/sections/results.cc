#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <cmath>

#include "app/model/definitions.h"
#include "app/model/gear_system.h"
#include "app/sections/report_parts.h"
#include "core/text_columns.h"

namespace annulus::app {

namespace {

/// The declared results that at least one variant has, each in one unit that suits all variants.
std::vector<FigureSpec> known_results(const SystemRun& run, const std::vector<VariantFigures>& variants) {
  std::vector<FigureSpec> list;
  for (const auto& spec : system_kind(run.scene.stage.kind).figures()) {
    std::vector<double> values;
    for (const auto& v : variants)
      if (const auto* entry = v.figures.find(spec.key)) values.push_back(entry->figure.value);
    if (!values.empty()) list.push_back(in_readable_unit(spec, values));
  }
  return list;
}

std::string result_text(const FigureSpec& spec, const VariantFigures& variant) {
  const auto* entry = variant.figures.find(spec.key);
  if (!entry || std::isnan(entry->figure.value)) return "–";
  if (spec.key == "steady") return entry->figure.value != 0 ? "yes" : "no";
  const auto& figure = entry->figure;
  // A share of the time that no digit shows is not none.
  constexpr double least_share = 1e-4;
  if (spec.term == "contact_loss" && figure.value > 0 && figure.value < least_share) return "< 0.01";
  const auto text = std::isfinite(figure.error) && figure.error > 0 ? measured(figure, spec.scale)
                                                                    : to_text(spec.scale * figure.value, spec.digits);
  // Of the window alone that was evaluated.
  const bool of_motion = spec.effort != FigureEffort::tables && spec.term != "natural_frequency";
  const auto* steady = variant.figures.find("steady");
  return text + (of_motion && steady && steady->figure.value == 0 ? " †" : "");
}

/// A loss of contact that there is not.
bool says_nothing(const FigureSpec& spec, const std::vector<VariantFigures>& variants) {
  return spec.term == "contact_loss" &&
         std::none_of(variants.begin(), variants.end(), [&](const auto& v) { return v.figures.value(spec.key) > 0; });
}

/// Those of a short table; all where none is declared as such.
std::vector<FigureSpec> most_important(std::vector<FigureSpec> specs, const std::vector<VariantFigures>& variants) {
  if (std::none_of(specs.begin(), specs.end(), [](const FigureSpec& spec) { return spec.headline; })) return specs;
  std::erase_if(specs, [&](const FigureSpec& spec) { return !spec.headline || says_nothing(spec, variants); });
  return specs;
}

bool has_spread(const FigureSpec& spec, const std::vector<VariantFigures>& variants) {
  return std::any_of(variants.begin(), variants.end(), [&](const auto& v) {
    const auto* entry = v.figures.find(spec.key);
    return entry && entry->spread;
  });
}

std::string spread_of(const FigureSpec& spec, const VariantFigures& variant) {
  const auto* entry = variant.figures.find(spec.key);
  return entry && entry->spread ? spread_text(*entry->spread, spec.scale) : "–";
}

std::string definition_anchor(const std::string& term) { return "definition-" + term; }

/// " K_γ K_V" with the indices below the line; nothing for no symbol.
Text with_symbol(const std::string& symbol) {
  Text text;
  std::vector<std::string> words;
  boost::algorithm::split(words, symbol, boost::algorithm::is_any_of(" "));
  for (const auto& word : words) {
    if (word.empty()) continue;
    const auto at = word.find('_');
    text += " " + word.substr(0, at);
    if (at != std::string::npos) text += subscript(word.substr(at + 1));
  }
  return text;
}

/// "Load sharing of the sun meshes K_γ", linked to its definition.
Text result_title(const FigureSpec& spec) {
  const Text title = (spec.term.empty() ? Text(spec.title) : link(spec.title, definition_anchor(spec.term))) +
                     with_symbol(spec.symbol);
  return spec.unit.empty() ? title : title + ", " + spec.unit;
}

std::vector<std::string> column_names(const std::vector<VariantFigures>& variants) {
  std::vector<std::string> names;
  names.reserve(variants.size());
  for (const auto& v : variants)
    names.push_back(!v.name.empty() ? v.name : variants.size() == 1 ? "value" : "as in the scene");
  return names;
}

std::string part_text(double share) {
  if (!std::isfinite(share)) return "not known";
  return share == 0 ? "–" : share < 1e-4 ? "< 0.01 %" : fmt::format("{:.2g} %", 100 * share);
}

}  // namespace

Blocks error_parts(const std::vector<FigureSpec>& specs, const std::vector<VariantFigures>& variants) {
  PageTable table{.head = {"", "value ± error", "discretisation", "local contact", "condensation",
                           "table interpolation", "time integration", "model choice"},
                  .style = PageTable::Style::numbers};
  for (const auto& variant : variants) {
    if (variants.size() > 1)
      table.rows.push_back({column_names(variants)[static_cast<std::size_t>(&variant - variants.data())]});
    for (const auto& spec : specs) {
      const auto* entry = variant.figures.find(spec.key);
      if (!entry || entry->parts.total() == 0 || entry->figure.value == 0 || spec.key == "steady") continue;
      auto& row = table.rows.emplace_back(std::vector<Text>{result_title(spec), result_text(spec, variant)});
      for (const auto& [name, part] : error_part_names) {
        const double share = std::abs(entry->parts.*part / entry->figure.value);
        row.emplace_back(part_text(share));
      }
    }
  }
  if (std::all_of(table.rows.begin(), table.rows.end(), [](const auto& row) { return row.size() == 1; })) return {};
  return heading("Parts of the error bars", "error-bars") +
         details(
             "Parts of the errors, in % of the value",
             table +
                 paragraph(
                     "Discretisation: difference between two levels of mesh refinement. Local contact: "
                     "change of the flank pressure with twice as many pressure elements. Condensation: "
                     "asymmetry of the compliance between tooth pairs. Model choice: plane strain for a face "
                     "of finite width, or formulas for teeth. Solid elements (model = \"solid\") need no "
                     "plane strain. Results of the lumped model: all stiffnesses of a mesh, or their ripple, "
                     "are raised by their error estimate. The larger of the two changes counts, summed over "
                     "all meshes. Table interpolation: change with either half of the positions of the tables. Time "
                     "integration: sampling, steady state and integrator. The error is the sum of its parts. "
                     "It is not known when one of its parts is not known. Prescribed stiffness is exact."));
}

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

std::string measured(const Figure& figure, double scale) {
  return measured(scale * figure.value, scale * figure.error);
}

std::string measured_in_unit(const Figure& figure, const ShownUnit& declared) {
  const auto shown = readable_unit(declared, {figure.value});
  return measured(figure, shown.scale) + " " + shown.unit;
}

std::string text_in_unit(double value, const ShownUnit& declared, int digits) {
  const auto shown = readable_unit(declared, {value});
  return to_text(shown.scale * value, digits) + " " + shown.unit;
}

std::string spread_text(const Spread& spread, double scale) {
  const double low = scale * spread.low, median = scale * spread.median, high = scale * spread.high;
  if (!std::isfinite(low + high)) return "not known";
  const double size = std::max(std::abs(low), std::abs(high)), distance = high - low;
  constexpr double rounding = 1e-5;
  if (!(distance > rounding * size)) return to_text(median, 5);
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(distance))), 0, 9);
  return fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", median, decimals, low, decimals, high, decimals);
}

std::string small_text(double x) { return std::isfinite(x) ? fmt::format("{:.1e}", x) : "–"; }

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + ", " + unit;
}

namespace {

PageTable results_table(const std::vector<FigureSpec>& specs, const std::vector<VariantFigures>& variants,
                        const std::vector<ResultGroup>& groups) {
  PageTable table{.head = {"result"}, .style = PageTable::Style::numbers};
  for (const auto& name : column_names(variants)) table.head.emplace_back(name);
  const auto group_of = [&](const FigureSpec& spec) {
    return std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return spec.key.starts_with(g.prefix); });
  };
  for (auto group = groups.begin(); group != groups.end(); ++group) {
    const auto before = table.rows.size();
    for (const auto& spec : specs) {
      if (group_of(spec) != group) continue;
      const bool spread = has_spread(spec, variants);
      if (spread) {
        auto& row = table.rows.emplace_back(1, result_title(spec) + spread_words);
        for (const auto& variant : variants) row.emplace_back(bold(spread_of(spec, variant)));
      }
      auto& row =
          table.rows.emplace_back(1, spread ? muted("the same" + std::string(nominal_words)) : result_title(spec));
      for (const auto& variant : variants)
        row.emplace_back(spread ? muted(result_text(spec, variant)) : Text(result_text(spec, variant)));
    }
    if (table.rows.size() > before && !group->heading.empty())
      table.rows.insert(table.rows.begin() + static_cast<std::ptrdiff_t>(before), std::vector<Text>{group->heading});
  }
  return table;
}

std::string sampled_words(const StudyResults& studies) {
  if (!studies.monte_carlo) return {};
  const auto& samples = *studies.monte_carlo;
  return fmt::format("Median and quantiles are those of {} samples{}; the nominal inputs are those of the scene.",
                     samples.samples,
                     samples.by_default ? ", drawn because the scene does not state the phases of its errors" : "");
}

}  // namespace

Section key_results(const SystemRun& run, const std::vector<ResultGroup>& groups, const Text& conditions) {
  const auto variants = run.variants();
  const auto specs = known_results(run, variants);
  const auto table = results_table(most_important(specs, variants), variants, groups),
             all = results_table(specs, variants, groups);
  if (all.rows.empty()) return {"figures", "Key results"};
  return {"figures", "Key results",
          paragraph(conditions +
                    "± is the estimated numerical error; it does not contain the uncertainty of the "
                    "inputs. " +
                    sampled_words(run.studies)) +
              table + details("All results", all) + error_parts(specs, variants)};
}
Section definitions_section(const SystemRun& run) {
  const auto specs = known_results(run, run.variants());
  Blocks blocks;
  for (const auto& d : definitions()) {
    const bool used = d.key == "nominal_force" || d.key == "error_bar" || d.key == "spread" ||
                      std::any_of(specs.begin(), specs.end(), [&](const auto& spec) { return spec.term == d.key; });
    if (!used) continue;
    blocks += Heading{d.title + with_symbol(d.symbol), definition_anchor(d.key)} + paragraph(code(d.formula)) +
              paragraph(d.text);
  }
  return {"definitions", "Definitions", details("Definitions of the results", blocks)};
}

std::string key_results_text(const SystemRun& run) {
  const auto variants = run.variants();
  const auto specs = most_important(known_results(run, variants), variants);
  const auto title_of = [&](const FigureSpec& spec) {
    return with_unit(spec.title, spec.unit) + (has_spread(spec, variants) ? spread_words : "");
  };
  std::size_t width = 0;
  for (const auto& spec : specs) width = std::max(width, characters(title_of(spec)));
  std::string text;
  const auto line = [&](const std::string& title, auto cells) {
    text += fmt::format("{:<{}}", title, width);
    for (std::size_t i = 0; i < variants.size(); ++i) text += fmt::format(" {:>22}", cells(i));
    text += "\n";
  };
  if (variants.size() > 1) line("", [names = column_names(variants)](std::size_t i) { return names[i]; });
  for (const auto& spec : specs) {
    const bool spread = has_spread(spec, variants);
    if (spread) line(title_of(spec), [&](std::size_t i) { return spread_of(spec, variants[i]); });
    line(spread ? std::string("   the same") + nominal_words : title_of(spec),
         [&](std::size_t i) { return result_text(spec, variants[i]); });
  }
  return text;
}

}  // namespace annulus::app
