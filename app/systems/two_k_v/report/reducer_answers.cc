#include "app/systems/two_k_v/report/reducer_report_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/systems/shared/element_words.h"
#include "core/units.h"

namespace annulus::app {

namespace {

/// What is computed under the name references use; nothing when unknown.
std::optional<double> reducer_quantity(const TwoKVResult& result, const TwoKVCase& c, const std::string& name) {
  if (name == "frequency_1_Hz" && c.vibration) return c.vibration->first_frequency();
  if (name == "torsional_stiffness_Nm_per_rad" && c.vibration) return c.vibration->torsion.mean();
  for (const auto& q : result.plan.quantities)
    if (q.key == name) return q.value;
  return std::nullopt;
}

std::string percent_off(double computed, double published) {
  return fmt::format("{:+.2f} %", 100 * (computed / published - 1));
}

/// What an agreement with the published first frequency proves; nothing when none is published.
std::optional<Text> agreement_text(const TwoKVResult& result) {
  const auto& v = *result.own.vibration;
  const double f = v.first_frequency();
  double widest = 0;
  std::vector<Text> published;
  if (result.reference)
    for (const auto& value : result.reference->values) {
      if (value.quantity != "frequency_1_Hz") continue;
      published.emplace_back(to_text(value.value) + " Hz published: " + percent_off(f, value.value));
      widest = std::max(widest, std::abs(f / value.value - 1));
    }
  if (published.empty()) return std::nullopt;
  // Of f1, relative, from the assumed inputs alone.
  constexpr double known_to = 0.2;
  int assumed = 0;
  double squares = 0;
  for (const auto& input : v.inputs) {
    if (!result.scene.assumed.contains(input.key)) continue;
    ++assumed;
    squares += input.sensitivity * input.sensitivity;
  }
  const double uncertainty = known_to * std::sqrt(squares);
  return joined(published, "; ") +
         fmt::format(
             ". {} of the {} inputs of the first frequency are assumed. If each is known to {:.0f} %, the frequency is "
             "known to ±{:.0f} % (root of the sum of squares). ",
             assumed, v.inputs.size(), 100 * known_to, 100 * uncertainty) +
         bold(widest < uncertainty ? "The differences are smaller. The agreement shows that the assumed inputs are "
                                     "possible. It confirms neither these inputs nor the model."
                                   : "The differences are larger. The assumed inputs alone do not explain them.");
}

/// The assumed input that moves the first frequency most, and the input that does so of all.
Text strongest_inputs(const TwoKVResult& result) {
  const auto& v = *result.own.vibration;
  const auto is_assumed = [&](const auto& input) { return result.scene.assumed.contains(input.key); };
  Text text;
  const auto assumed = std::find_if(v.inputs.begin(), v.inputs.end(), is_assumed);
  if (assumed != v.inputs.end()) {
    text += " The assumed input with the largest effect is " + code(assumed->key);
    if (!assumed->reaching.empty() && assumed->reaching.back())
      text += fmt::format(": {} times its value alone would give {} Hz", to_text(*assumed->reaching.back(), 4),
                          to_text(v.targets.back()));
    text += ".";
  }
  const auto& strongest = v.inputs.front();
  if (!is_assumed(strongest))
    text += phrase(" Of all inputs {} has the largest effect ({:+.3f}).", code(strongest.key), strongest.sensitivity);
  return text;
}

/// "input on crank bearings" for "input on crank_bearing".
std::string mode_words(const std::string& name) {
  const auto at = name.find(" on ");
  return at == std::string::npos ? name : name.substr(0, at) + " on " + element_group(name.substr(at + 4));
}

/// Whether a computed value agrees with the published one.
Text agreement(double computed, const Reference::Value& published) {
  constexpr double rounding = 1e-4;  // below, the numbers are equal
  Text text = std::abs(computed / published.value - 1) <= published.within ? tag(Text::Look::agrees, "agrees")
                                                                           : tag(Text::Look::disagrees, "disagrees");
  if (published.within >= rounding) text += " " + muted("within " + to_text(100 * published.within) + " %");
  return text;
}

}  // namespace

Blocks reducer_verdict(const TwoKVResult& result) {
  using shown_units::stiffness;
  if (!result.own.vibration)
    return verdict_box(paragraph(fmt::format("Mean stiffness of a sun mesh {}, of an arc mesh {}.",
                                             text_in_unit(result.own.tables.sun.mean_stiffness().value, stiffness),
                                             text_in_unit(result.own.tables.arc.mean_stiffness().value, stiffness))));
  const auto& v = *result.own.vibration;
  const auto& e = v.estimate;
  Text first = "First natural frequency: " + bold(fmt::format("{:.2f} Hz", v.first_frequency()));
  if (result.computed) {
    const double computed = result.computed->vibration->first_frequency();
    first += phrase(", with computed mesh stiffness {} ({})", bold(fmt::format("{:.2f} Hz", computed)),
                    percent_off(computed, v.first_frequency()));
  }
  first += fmt::format(
      ". It is the mode “{}”. Estimate from the inertia of the input times the ratio squared ({} kg m²) and the "
      "torsional stiffness ({} N m/rad): {:.1f} Hz. With the inertias of all bodies that turn with the input: {:.1f} "
      "Hz. The whole train vibrates as one body against its bearings.",
      mode_words(v.names[first_elastic_mode(v)]), to_text(e.input_inertia, 4), to_text(e.stiffness, 4),
      e.input_frequency, e.train_frequency);
  Blocks blocks = paragraph(first);
  if (const auto text = agreement_text(result)) blocks += paragraph(*text + " " + link("More", "comparison"));
  blocks += paragraph(phrase(
      "Torsional stiffness from the output: {}, wind-up under the load {} arc seconds, lost motion {} arc seconds.",
      bold(to_text(v.torsion.mean() * units::arc_minute, 4) + " N m/arc minute"),
      to_text(v.lost.wind_up / units::arc_second, 4), to_text(v.lost.total() / units::arc_second, 3)));
  for (const auto& [name, shown] : shown_cases(result)) {
    if (!shown->motion) continue;
    const auto& m = *shown->motion;
    blocks += paragraph(
        phrase("Output error under load, {}: {} arc seconds peak to peak{}{}", name, bold(error_text(m)),
               m.output_moves()
                   ? fmt::format(", {} without inertia.", to_text(m.static_error_peak_to_peak / units::arc_second, 4))
                   : ", within rounding.",
               m.steady ? "" : " No periodic steady state was reached; the result holds for the window only."));
  }
  return verdict_box(blocks);
}

Section reducer_comparison(const TwoKVResult& result) {
  Section section{"comparison", "Comparison with the source"};
  if (!result.reference || !result.own.vibration) return section;
  PageTable table{.head = {"published statement", "published"}};
  for (const auto& [name, shown] : shown_cases(result)) table.head.emplace_back(name);
  table.head.emplace_back("");
  for (const auto& value : result.reference->values) {
    std::vector<Text> row = {value.statement + (value.where.empty() ? Text() : " " + muted("(" + value.where + ")")),
                             to_text(value.value)};
    Text verdict = tag(Text::Look::undecided, "not computed here");
    for (const auto& [name, shown] : shown_cases(result)) {
      const auto computed = reducer_quantity(result, *shown, value.quantity);
      row.emplace_back(computed ? fmt::format("{} ({})", to_text(*computed, 5), percent_off(*computed, value.value))
                                : "–");
      if (computed && shown == &result.own) verdict = agreement(*computed, value);
    }
    row.push_back(verdict);
    table.rows.push_back(std::move(row));
  }
  section.blocks = source_blocks(*result.reference) + table;
  if (const auto text = agreement_text(result)) section.blocks += paragraph(*text + strongest_inputs(result));
  return section;
}

}  // namespace annulus::app
