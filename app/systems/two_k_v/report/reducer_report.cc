#include "app/systems/two_k_v/report/reducer_report_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

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

/// Uncertainty of f1, relative, from the assumed inputs alone: each known to `known` only, root of the sum of squares.
struct AssumedPart {
  int assumed = 0, of = 0;
  double uncertainty = 0;
};
constexpr double known_to = 0.2;

AssumedPart assumed_part(const TwoKVResult& result) {
  AssumedPart part;
  double squares = 0;
  for (const auto& input : result.own.vibration->inputs) {
    ++part.of;
    if (!result.scene.assumed.contains(input.key)) continue;
    ++part.assumed;
    squares += input.sensitivity * input.sensitivity;
  }
  part.uncertainty = known_to * std::sqrt(squares);
  return part;
}

const Reference::Value* published_frequency(const TwoKVResult& result, std::size_t which) {
  if (!result.reference) return nullptr;
  for (const auto& value : result.reference->values)
    if (value.quantity == "frequency_1_Hz" && which-- == 0) return &value;
  return nullptr;
}

/// What an agreement with the published first frequency proves; nothing when none is published.
std::optional<Text> agreement_text(const TwoKVResult& result) {
  if (!published_frequency(result, 0)) return std::nullopt;
  const double f = result.own.vibration->first_frequency();
  const auto part = assumed_part(result);
  double widest = 0;
  std::vector<Text> published;
  for (std::size_t i = 0; const auto* value = published_frequency(result, i); ++i) {
    published.emplace_back(to_text(value->value) + " Hz published: " + percent_off(f, value->value));
    widest = std::max(widest, std::abs(f / value->value - 1));
  }
  return joined(published, "; ") +
         fmt::format(
             ". {} of the {} inputs the first frequency depends on are assumed; if each were known to {:.0f} %, "
             "the frequency would be known to ±{:.0f} % (root of the sum of squares). ",
             part.assumed, part.of, 100 * known_to, 100 * part.uncertainty) +
         bold(
             widest < part.uncertainty
                 ? "The differences are smaller than that: the agreement shows that the chosen inputs are possible, it "
                   "confirms neither them nor the model."
                 : "The differences are larger than that: model and published values disagree beyond the assumed "
                   "inputs.");
}

/// The assumed input that moves the first frequency most, and the input that does so of all.
Text strongest_inputs(const TwoKVResult& result) {
  const auto& v = *result.own.vibration;
  const auto is_assumed = [&](const auto& input) { return result.scene.assumed.contains(input.key); };
  Text text;
  const auto assumed = std::find_if(v.inputs.begin(), v.inputs.end(), is_assumed);
  if (assumed != v.inputs.end()) {
    text += " The strongest assumed input is " + code(assumed->key);
    if (!assumed->reaching.empty() && assumed->reaching.back())
      text += fmt::format(": {} times its value alone would give {} Hz", to_text(*assumed->reaching.back(), 4),
                          to_text(v.targets.back()));
    text += ".";
  }
  const auto& strongest = v.inputs.front();
  if (!is_assumed(strongest))
    text += phrase(" Of all inputs {} weighs most ({:+.3f}).", code(strongest.key), strongest.sensitivity);
  return text;
}

Blocks reducer_verdict(const TwoKVResult& result) {
  if (!result.own.vibration)
    return verdict_box(paragraph(fmt::format("Mean stiffness of a sun mesh {} N/µm, of an arc mesh {} N/µm.",
                                             to_text(result.own.tables.sun.mean_stiffness().value / 1e6, 4),
                                             to_text(result.own.tables.arc.mean_stiffness().value / 1e6, 4))));
  const auto& v = *result.own.vibration;
  const auto& e = v.estimate;
  Text first = "First natural frequency: " + bold(fmt::format("{:.2f} Hz", v.first_frequency()));
  if (result.computed) {
    const double computed = result.computed->vibration->first_frequency();
    first += phrase(", with computed mesh stiffness {} ({})", bold(fmt::format("{:.2f} Hz", computed)),
                    percent_off(computed, v.first_frequency()));
  }
  first += fmt::format(
      ". It is the mode “{}”. The input's inertia times the ratio squared, {} kg m², on the torsional stiffness of {} "
      "N m/rad alone makes {:.1f} Hz; with all bodies that turn with it {:.1f} Hz: the whole train swings as one "
      "against its bearings.",
      mode_words(v.names[first_elastic_mode(v)]), to_text(e.input_inertia, 4), to_text(e.stiffness, 4),
      e.input_frequency, e.train_frequency);
  Blocks blocks = paragraph(first);
  if (const auto text = agreement_text(result)) blocks += paragraph(*text + " " + link("More", "comparison"));
  blocks += paragraph(phrase(
      "Torsional stiffness from the output: {}, wind-up under the load {} arc seconds, lost motion {} arc seconds.",
      bold(to_text(v.torsion.mean() * units::arc_minute, 4) + " N m/arc minute"),
      to_text(v.lost.wind_up / units::arc_second, 4), to_text(v.lost.total() / units::arc_second, 3)));
  for (const auto& shown : shown_cases(result)) {
    if (!shown.result->motion) continue;
    const auto& m = *shown.result->motion;
    blocks += paragraph(
        phrase("Output error under load, {}: {} arc seconds peak to peak{}{}", shown.name, bold(error_text(m)),
               m.output_moves()
                   ? fmt::format(", {} without inertia.", to_text(m.static_error_peak_to_peak / units::arc_second, 4))
                   : ": nothing beyond rounding.",
               m.steady ? "" : " No periodic steady state was reached; the figure holds for the window only."));
  }
  return verdict_box(blocks);
}

Section reducer_figures(const TwoKVResult& result) {
  Section section{"figures", "Key figures"};
  if (!result.own.vibration) return section;
  PageTable table = labelled_rows({"sun mesh stiffness, mean, N/µm", "arc mesh stiffness, mean, N/µm",
                                   "first frequency, Hz", "second frequency, Hz", "torsional stiffness, N m/rad",
                                   "output error, peak to peak, arc seconds", "dynamic factor, largest"});
  for (const auto& shown : shown_cases(result)) {
    const auto& c = *shown.result;
    const auto& modes = c.vibration->modes.modes;
    const std::size_t mode = first_elastic_mode(*c.vibration);
    add_column(
        table, shown.name,
        {to_text(c.tables.sun.mean_stiffness().value / 1e6, 4), to_text(c.tables.arc.mean_stiffness().value / 1e6, 4),
         fmt::format("{:.2f}", modes[mode].frequency), fmt::format("{:.2f}", modes.at(mode + 1).frequency),
         to_text(c.vibration->torsion.mean(), 5), c.motion ? error_text(*c.motion) : "–",
         c.motion ? to_text(std::max(c.motion->dynamic_factor(false), c.motion->dynamic_factor(true)), 5) : "–"});
  }
  section.blocks = table;
  return section;
}

/// Whether a computed value agrees with the published one.
Text agreement(double computed, const Reference::Value& published) {
  constexpr double rounding = 1e-4;  // below, the numbers are equal
  Text text = std::abs(computed / published.value - 1) <= published.within ? tag(Text::Look::agrees, "agrees")
                                                                           : tag(Text::Look::disagrees, "disagrees");
  if (published.within >= rounding) text += " " + muted("within " + to_text(100 * published.within) + " %");
  return text;
}

Section reducer_comparison(const TwoKVResult& result) {
  Section section{"comparison", "Comparison with the source"};
  if (!result.reference || !result.own.vibration) return section;
  PageTable table{.head = {"published statement", "published"}};
  for (const auto& shown : shown_cases(result)) table.head.emplace_back(shown.name);
  table.head.emplace_back("");
  for (const auto& value : result.reference->values) {
    std::vector<Text> row = {value.statement + (value.where.empty() ? Text() : " " + muted("(" + value.where + ")")),
                             to_text(value.value)};
    Text verdict = tag(Text::Look::undecided, "not computed here");
    for (const auto& shown : shown_cases(result)) {
      const auto computed = reducer_quantity(result, *shown.result, value.quantity);
      row.emplace_back(computed ? fmt::format("{} ({})", to_text(*computed, 5), percent_off(*computed, value.value))
                                : "–");
      if (computed && shown.result == &result.own) verdict = agreement(*computed, value);
    }
    row.push_back(verdict);
    table.rows.push_back(std::move(row));
  }
  section.blocks = source_blocks(*result.reference) + table;
  if (const auto text = agreement_text(result)) section.blocks += paragraph(*text + strongest_inputs(result));
  return section;
}

Section reducer_quality(const TwoKVResult& result) {
  std::vector<std::pair<std::string, const MeshResult*>> meshes;
  for (const auto& shown : shown_cases(result))
    meshes.emplace_back("sun mesh, " + shown.name, &shown.result->tables.sun);
  return {"quality", "Checks and cost", mesh_checks(meshes) + cost_blocks(result)};
}

}  // namespace

Legend case_legend(const TwoKVResult& result) {
  Legend legend;
  for (const auto& shown : shown_cases(result)) legend.emplace_back(shown.name, shown.colour);
  return legend;
}

std::vector<ShownCase> shown_cases(const TwoKVResult& result) {
  if (!result.computed) return {{"as in the scene", &result.own, 0}};
  return {{"stiffness as given", &result.own, 0}, {"computed stiffness", &*result.computed, 2}};
}

std::string element_words(const std::string& group) {
  static const std::map<std::string, std::string> words = {
      {"sun_planet", "sun meshes"},         {"arc_pins", "arc meshes"},
      {"crank_arc", "arc gear bearings"},   {"crank_bearing", "crank bearings"},
      {"input_shaft", "input shaft"},       {"planet_shaft", "crank shafts"},
      {"input_support", "input's support"}, {"output_support", "output's support"}};
  const auto found = words.find(group);
  return found == words.end() ? group : found->second;
}

std::string mode_words(const std::string& name) {
  const auto at = name.find(" on ");
  return at == std::string::npos ? name : name.substr(0, at) + " on " + element_words(name.substr(at + 4));
}

Page reducer_report(const TwoKVResult& result) {
  const auto& scene = result.scene;
  const auto& shown = result.computed ? *result.computed : result.own;
  return scene_page(
      scene,
      fmt::format("ratio {}, {} N m at {} r/min of the output", to_text(two_k_v_kinematics(scene).ratio(), 6),
                  to_text(scene.output.torque, 5), to_text(scene.output.speed / units::rpm, 5)),
      reducer_verdict(result),
      {{drawings_section(result), reducer_figures(result), reducer_comparison(result), frequencies_section(result),
        first_frequency_section(result), torsion_section(result), reducer_motion_section(result),
        reducer_meshes_section(result), fields_section({{"Sun mesh", &shown.tables.sun}})},
       study_sections(scene, result.studies),
       {model_section(result.plan), inputs_section(result.plan), reducer_quality(result)}});
}

}  // namespace annulus::app
